"""Covariance of poses in the plane that follow one another."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]


def turned(yaw: float) -> Floats:
    """Matrix (3, 3) that turns (x, y, yaw) of a frame by ``yaw`` [rad]: a_from_b for vectors."""
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))


def followed(covariance: Floats, a_from_b: Pose2, b_from_c: Pose2, step: Floats) -> Floats:
    """Covariance (3, 3) of a_from_c, from that of a_from_b (3, 3) and that of b_from_c (``step`` (3, 3), along the axes of b).

    First order: Smith, Self & Cheeseman, "Estimating Uncertain Spatial Relationships in Robotics" (1990), compounding.
    """
    turn = turned(a_from_b.yaw)
    x, y, _ = turn @ (b_from_c[0], b_from_c[1], 0.0)
    lever = np.array(((1.0, 0.0, -y), (0.0, 1.0, x), (0.0, 0.0, 1.0)))
    out: Floats = lever @ covariance @ lever.T + turn @ step @ turn.T
    return out
