"""A sweep that took its time, as it would have been seen at once."""

from collections.abc import Callable
from math import ceil

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2
from uvf.maths.se2_arrays import composed, inverted
from uvf.slam.reading import Beams, Reading

Floats = NDArray[np.float64]

SPACING = 0.025  # s, at most, between the moments at which the odometry is asked where the base was


def moments(first: float, duration: float) -> Floats:
    """Times (m,) [s], evenly spaced over ``duration`` [s] from the first beam, measured at ``first`` [s], to the last."""
    return np.linspace(first, first + duration, ceil(duration / SPACING - 1e-9) + 1)


def straightened(ranges: Floats, beams: Beams, first: float, odom_from_base: Callable[[Floats], Floats]) -> Reading:
    """Deskewed reading of ranges (n,) [m] whose first beam was measured at ``first`` [s].

    odom_from_base: gives the poses (m, 3) at times (m,) [s].
    """
    times = moments(first, beams.duration)
    poses = odom_from_base(times)
    reading = Reading(float(times[-1]), ranges, beams, Pose2(*poses[-1].tolist()))
    return deskewed(reading, composed(inverted(poses[-1]), poses))


def deskewed(reading: Reading, last_from_base: Floats) -> Reading:
    """Reading with the same points as if they had all been seen from the lidar's place at the last beam.

    last_from_base: (m, 3) where the base was at m moments, evenly from the first beam to the last, seen from where it was then.
    The limits of its ranges are wider by as much as the lidar has moved; what is no return is infinite, what says nothing NaN.
    """
    beams, n = reading.beams, len(reading.ranges)
    if beams.duration == 0.0 or n < 2:
        return reading
    share = np.linspace(0.0, 1.0, n), np.linspace(0.0, 1.0, len(last_from_base))
    x, y, yaw = last_from_base.T
    poses = np.column_stack([np.interp(*share, column) for column in (x, y, np.unwrap(yaw))])
    ranges, returned, origin = reading.ranges, reading.returned, np.array((*beams.origin, 0.0))
    lengths = np.where(returned, ranges, beams.range_max)
    seen = np.column_stack((beams.directions * lengths[:, None], np.zeros(n))) + origin
    from_lidar = (composed(poses, seen) - origin)[:, :2]
    free = (ranges == 0.0) | (ranges >= beams.range_max)
    straight = np.where(returned, np.hypot(*from_lidar.T), np.where(free, np.inf, np.nan))
    bearings = np.unwrap(np.arctan2(from_lidar[:, 1], from_lidar[:, 0]))
    moved = float(np.hypot(*(composed(poses, origin) - origin)[:, :2].T).max())
    at_once = Beams(beams.origin, bearings, max(beams.range_min - moved, 0.0), beams.range_max + moved)
    return Reading(reading.t, straight, at_once, reading.odom_from_base)
