"""Corrections of the map without jumps: a controller that steers by the pose never sees the vehicle leap."""

from math import hypot

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2


def toward(current: Pose2, target: Pose2, distance: float, turn: float) -> Pose2:
    """Pose ``current`` moved towards ``target`` by at most ``distance`` [m] and ``turn`` [rad]."""
    dx, dy, dt = target[0] - current[0], target[1] - current[1], wrap(target[2] - current[2])
    share = min(1.0, distance / max(hypot(dx, dy), 1e-12), turn / max(abs(dt), 1e-12))
    return Pose2(current[0] + share * dx, current[1] + share * dy, wrap(current[2] + share * dt))
