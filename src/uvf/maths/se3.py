"""Rigid motion in space, SE(3): a transform is a rotation (quaternion wxyz, unit) and a translation [m].

Names cancel: ``map_from_base = compose(map_from_odom, odom_from_base)``.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths import rotations
from uvf.maths.rotations import matrix, multiply, rotate, to_euler
from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]

NEARLY_PARALLEL = 0.9995
"""Cosine of half the angle from which on the sine that SLERP divides by is too small (3.6 degrees of turn)."""


class Transform(NamedTuple):
    """Transform ``a_from_b``: rotation (4,) wxyz and translation (3,) [m], the origin of b in a."""

    rotation: Floats
    translation: Floats


IDENTITY = Transform(rotations.IDENTITY, np.zeros(3))


def compose(a_from_b: Transform, b_from_c: Transform) -> Transform:
    """Transform ``a_from_c``: ``b_from_c`` seen from frame a."""
    return Transform(
        multiply(a_from_b.rotation, b_from_c.rotation),
        a_from_b.translation + rotate(a_from_b.rotation, b_from_c.translation),
    )


def inverse(a_from_b: Transform) -> Transform:
    """Transform ``b_from_a`` of a transform ``a_from_b``."""
    b_from_a = rotations.inverse(a_from_b.rotation)
    return Transform(b_from_a, -rotate(b_from_a, a_from_b.translation))


def apply(a_from_b: Transform, points_b: Floats) -> Floats:
    """Points (n, 3) [m] of frame b in frame a."""
    points_a: Floats = points_b @ matrix(a_from_b.rotation).T + a_from_b.translation
    return points_a


def planar(a_from_b: Transform) -> Pose2:
    """Pose in the plane of a transform seen from above: x, y and yaw."""
    x, y, _ = a_from_b.translation
    return Pose2(float(x), float(y), to_euler(a_from_b.rotation)[2])


def from_above(a_from_b: Transform, points_b: Floats) -> Floats:
    """Points (n, 2) [m] of b's plane z = 0 as seen in a from above; also of a frame that hangs upside down."""
    points_a: Floats = points_b @ matrix(a_from_b.rotation)[:2, :2].T + a_from_b.translation[:2]
    return points_a


def homogeneous(a_from_b: Transform) -> Floats:
    """Homogeneous matrix (4, 4) of a transform."""
    m = np.eye(4)
    m[:3, :3] = matrix(a_from_b.rotation)
    m[:3, 3] = a_from_b.translation
    return m


def slerp(p: Floats, q: Floats, fraction: float) -> Floats:
    """Unit quaternion (4,) between p (4,) at ``fraction`` 0 and q (4,) at ``fraction`` 1 [-], at constant turn rate.

    Spherical linear interpolation by the shorter way (Shoemake 1985).
    """
    cosine = float(p @ q)
    if cosine < 0.0:  # q and -q are the same rotation, but only one of them is near
        q, cosine = -q, -cosine
    if cosine > NEARLY_PARALLEL:
        mixed = (1.0 - fraction) * p + fraction * q
    else:
        angle = np.arccos(cosine)
        mixed = (np.sin((1.0 - fraction) * angle) * p + np.sin(fraction * angle) * q) / np.sin(angle)
    unit: Floats = mixed / np.linalg.norm(mixed)
    return unit


def interpolate(p: Transform, q: Transform, fraction: float) -> Transform:
    """Transform between p (``fraction`` 0) and q (``fraction`` 1 [-]): the translation in a straight line, the rotation by SLERP."""
    translation = p.translation + fraction * (q.translation - p.translation)
    return Transform(slerp(p.rotation, q.rotation, fraction), translation)
