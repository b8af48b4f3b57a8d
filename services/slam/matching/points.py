"""The ends of a sweep's beams, for methods that match to grids."""

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from services.slam.reading import Reading
from uvf.maths.planar import IDENTITY, Pose2, compose, inverse

Floats = NDArray[np.float64]

FARTHEST, WIDEST = 5.0, 1.5  # m, rad between two readings: more is no motion, the odometry has leapt


def points_of(reading: Reading, reach: float, most: int) -> Floats:
    """(n, 2) m, base frame: of the beams that came back from within ``reach`` [m], thinned evenly to no more than ``most``.

    None of a reading that has another number of ranges than of beams.
    """
    if reading.ranges.shape != reading.beams.bearings.shape:
        return np.zeros((0, 2))
    used = np.flatnonzero(reading.returned & (np.nan_to_num(reading.ranges) < reach))
    used = used[:: -(-len(used) // most)] if len(used) else used
    points: Floats = reading.beams.directions[used] * reading.ranges[used, None] + np.array(reading.beams.origin)
    return points


def step_between(odom_from_last: Pose2, odom_from_base: Pose2) -> Pose2:
    """last_from_base; none where the odometry tells what no vehicle does."""
    if not all(isfinite(v) for v in (*odom_from_last, *odom_from_base)):
        return IDENTITY
    step = compose(inverse(odom_from_last), odom_from_base)
    return step if abs(step.x) + abs(step.y) < FARTHEST and abs(step.yaw) < WIDEST else IDENTITY
