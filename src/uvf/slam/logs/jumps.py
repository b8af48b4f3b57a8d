"""Steps of the odometry that no vehicle has driven: the counter was set back, or the robot's program began anew."""

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.maths.se2_arrays import steps
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

FASTEST, FARTHEST = 10.0, 2.0
"""m/s and m: a step is a leap when it is longer than FASTEST times its time and FARTHEST more."""
QUICKEST, WIDEST = 2 * np.pi, 1.0
"""rad/s and rad: the same of turns."""


def without_jumps(times: Floats, odom_from_base: Floats) -> tuple[Floats, NDArray[np.int64]]:
    """Poses (n, 3) as if the vehicle had stood still where its odometry jumped, and the indices (k,) of those reached by a jump.

    What else the vehicle did, nobody knows. times: (n,) [s], never falling; odom_from_base: (n, 3) [m, m, rad].
    """
    moved = steps(odom_from_base)
    leapt = np.flatnonzero(~_driven(moved.T, np.diff(times)))
    if not len(leapt):
        return odom_from_base, leapt
    moved[leapt] = IDENTITY
    poses = [Pose2(*odom_from_base[0].tolist())]
    for step in moved.tolist():
        poses.append(compose(poses[-1], Pose2(*step)))
    return np.array(poses), leapt + 1


def step_between(last: Reading, now: Reading) -> Pose2 | None:
    """Motion last_from_now by the odometry; None where it is a jump or not finite."""
    if not all(isfinite(v) for v in (*last.odom_from_base, *now.odom_from_base)):
        return None
    step = compose(inverse(last.odom_from_base), now.odom_from_base)
    return step if _driven(np.array(step), np.array(max(now.t - last.t, 0.0))) else None


def _driven(moved: Floats, periods: Floats) -> NDArray[np.bool_]:
    """(n,) whether a vehicle can have made steps (3, n) [m, m, rad] in so many seconds (n,)."""
    near = np.hypot(moved[0], moved[1]) <= FARTHEST + FASTEST * periods
    slow = np.abs(moved[2]) <= WIDEST + QUICKEST * periods
    driven: NDArray[np.bool_] = near & slow
    return driven
