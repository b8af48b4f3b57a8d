"""The rigid motion that lays one trajectory onto another."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]


def aligned(a: Floats, b: Floats) -> Pose2:
    """Pose a_from_b [m, m, rad] that lays the points ``b`` (n, 2) [m] on ``a`` (n, 2) [m] by least squares.

    The yaw is 0 where the points do not tell it.

    Umeyama, "Least-squares estimation of transformation parameters between two point patterns" (1991), in the plane and
    without scale: the sums of dot and cross products of the centred points give cosine and sine.
    """
    mean_a, mean_b = a.mean(axis=0), b.mean(axis=0)
    p, q = a - mean_a, b - mean_b
    yaw = float(np.arctan2((q[:, 0] * p[:, 1] - q[:, 1] * p[:, 0]).sum(), (p * q).sum()))
    c, s = np.cos(yaw), np.sin(yaw)
    x, y = mean_a - np.array(((c, -s), (s, c))) @ mean_b
    return Pose2(float(x), float(y), yaw)
