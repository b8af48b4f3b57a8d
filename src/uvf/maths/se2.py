"""Rigid motion in the plane, SE(2): a pose is x [m], y [m], yaw [rad].

Names cancel: ``map_from_base = compose(map_from_odom, odom_from_base)``.
"""

from math import cos, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]


class Pose2(NamedTuple):
    """A pose in the plane: x [m], y [m], yaw [rad]."""

    x: float
    y: float
    yaw: float


IDENTITY = Pose2(0.0, 0.0, 0.0)


def compose(a_from_b: Pose2, b_from_c: Pose2) -> Pose2:
    """Pose ``a_from_c``: ``b_from_c`` seen from frame a; the yaw is wrapped."""
    x, y, heading = a_from_b
    c, s = cos(heading), sin(heading)
    return Pose2(x + c * b_from_c[0] - s * b_from_c[1], y + s * b_from_c[0] + c * b_from_c[1], wrap(heading + b_from_c[2]))


def inverse(a_from_b: Pose2) -> Pose2:
    """Pose ``b_from_a`` of a pose ``a_from_b``."""
    x, y, heading = a_from_b
    c, s = cos(heading), sin(heading)
    return Pose2(-c * x - s * y, s * x - c * y, wrap(-heading))


def transform(a_from_b: Pose2, points_b: Floats) -> Floats:
    """Points (n, 2) [m] of frame b in frame a."""
    c, s = cos(a_from_b[2]), sin(a_from_b[2])
    points_a: Floats = points_b @ np.array(((c, s), (-s, c))) + np.array(a_from_b[:2])
    return points_a


def interpolate(p: Pose2, q: Pose2, fraction: float) -> Pose2:
    """Pose between p (``fraction`` 0) and q (``fraction`` 1 [-]), straight in x and y, the heading by the shorter way."""
    x, y = p[0] + fraction * (q[0] - p[0]), p[1] + fraction * (q[1] - p[1])
    return Pose2(x, y, wrap(p[2] + fraction * wrap(q[2] - p[2])))


class PoseHistory:
    """The last poses of a moving body by time, to look up where it was when a sensor took its reading."""

    def __init__(self, length: int) -> None:
        self._length = length
        self._times: list[float] = []
        self._poses: list[Pose2] = []

    def add(self, t: float, pose: Pose2) -> None:
        """Adds the pose at ``t`` [s]; times must rise, and one that does not is left out."""
        if self._times and t <= self._times[-1]:
            return
        self._times.append(t)
        self._poses.append(pose)
        if len(self._times) > 2 * self._length:
            del self._times[: -self._length], self._poses[: -self._length]

    @property
    def newest(self) -> tuple[float, Pose2] | None:
        """Time [s] and pose of the last one added; None before the first."""
        return (self._times[-1], self._poses[-1]) if self._times else None

    def at(self, t: float) -> Pose2 | None:
        """Pose at ``t`` [s], interpolated, or None when that is before the first or after the last one known."""
        if not self._times or not self._times[0] <= t <= self._times[-1]:
            return None
        i = max(int(np.searchsorted(self._times, t)), 1) if len(self._times) > 1 else 0
        if i == 0:
            return self._poses[0]
        t0, t1 = self._times[i - 1], self._times[i]
        return interpolate(self._poses[i - 1], self._poses[i], (t - t0) / (t1 - t0))
