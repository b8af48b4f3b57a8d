"""Steps of the odometry that no vehicle has driven: the counter was set back, or the robot's program began anew."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.planar import IDENTITY, Pose2, compose
from uvf.maths.planar_arrays import steps

Floats = NDArray[np.float64]

FASTEST, FARTHEST = 10.0, 2.0
"""m/s and m: a step is a leap when it is longer than FASTEST times its time and FARTHEST more."""
QUICKEST, WIDEST = 2 * np.pi, 1.0
"""rad/s and rad: the same of turns."""


def leaps(stamps: Floats, odom_from_base: Floats) -> NDArray[np.int64]:
    """Indices of the poses (n, 3) that are reached by a leap from the one before. stamps: (n,) s, perhaps out of order."""
    moved, period = steps(odom_from_base), np.abs(np.diff(stamps))
    far = np.hypot(moved[:, 0], moved[:, 1]) > FARTHEST + FASTEST * period
    return np.flatnonzero(far | (np.abs(moved[:, 2]) > WIDEST + QUICKEST * period)) + 1


def without_leaps(stamps: Floats, odom_from_base: Floats) -> Floats:
    """The poses as if the vehicle had stood still while its odometry leapt: what else it did, nobody knows."""
    found = leaps(stamps, odom_from_base)
    if not len(found):
        return odom_from_base
    moved = steps(odom_from_base)
    moved[found - 1] = IDENTITY
    poses = [Pose2(*odom_from_base[0].tolist())]
    for step in moved.tolist():
        poses.append(compose(poses[-1], Pose2(*step)))
    return np.array(poses)
