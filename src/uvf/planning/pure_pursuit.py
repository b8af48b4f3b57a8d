"""Follows a path with a differential drive: regulated pure pursuit, turning on the spot where it must."""

from dataclasses import dataclass
from math import atan2, hypot, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]

TURN_FROM, TURN_TO = 0.9, 0.3
"""rad: turns on the spot from the larger bearing of the path until the smaller one."""
HEADING_TOLERANCE = 0.05  # rad
FAR_SIGHT, SIGHT_TIME = 0.25, 0.4  # m, s: how far ahead on the path it looks, and more with speed
NEAR_SIGHT, SIGHT_BY_ROOM = 0.1, 2.0  # m, 1: the same beside obstacles, by the room that is left
TURN_GAIN = 3.0  # 1/s


@dataclass(frozen=True)
class SpeedLimits:
    """Speed limits, deceleration and goal tolerance of path tracking."""

    linear: float  # m/s
    angular: float  # rad/s
    deceleration: float  # m/s^2, towards the goal
    tolerance: float  # m, distance at which the end is reached


class PathTracker:
    """Pure pursuit (Coulter 1992) with the speed regulated by curvature and the way left (Macenski 2023)."""

    def __init__(self, pace: SpeedLimits) -> None:
        self.pace = pace
        self._turning = False
        self._speed = 0.0

    def follow(self, pose: Pose2, path: Floats, final_heading: float | None, room: float) -> tuple[float, float]:
        """Velocity (linear [m/s], angular [rad/s]) at ``pose`` along ``path`` (n, 2) [m] in the same frame; zero at its end.

        final_heading: [rad], to turn to at the end, None = any; room: [m] to spare beside the nearest obstacle, with little of it the
        path's corners are not cut.
        """
        if len(path) == 0:
            return self._go(0.0, 0.0)
        left = hypot(path[-1, 0] - pose[0], path[-1, 1] - pose[1])
        if left <= self.pace.tolerance:
            error = 0.0 if final_heading is None else wrap(final_heading - pose[2])
            return self._go(0.0, self._turn(error) if abs(error) > HEADING_TOLERANCE else 0.0)
        reach = min(FAR_SIGHT + SIGHT_TIME * self._speed, NEAR_SIGHT + SIGHT_BY_ROOM * max(room, 0.0))
        target = _ahead(pose, path, reach)
        bearing = wrap(atan2(target[1] - pose[1], target[0] - pose[0]) - pose[2])
        if abs(bearing) > TURN_FROM or (self._turning and abs(bearing) > TURN_TO):
            self._turning = True
            return self._go(0.0, self._turn(bearing))
        self._turning = False
        return self._go(*self._pursue(bearing, hypot(target[0] - pose[0], target[1] - pose[1]), left))

    def _pursue(self, bearing: float, distance: float, left: float) -> tuple[float, float]:
        curvature = 2.0 * sin(bearing) / max(distance, 0.05)
        speed = min(self.pace.linear, sqrt(2.0 * self.pace.deceleration * left) + 0.02)
        speed = min(speed, self.pace.angular / max(abs(curvature), 1e-9)) * max(1.0 - 0.7 * abs(bearing) / TURN_FROM, 0.2)
        return speed, speed * curvature

    def _turn(self, error: float) -> float:
        return min(max(TURN_GAIN * error, -self.pace.angular), self.pace.angular)

    def _go(self, linear: float, angular: float) -> tuple[float, float]:
        self._speed = linear
        return linear, angular


def _ahead(pose: Pose2, path: Floats, distance: float) -> tuple[float, float]:
    """The path's point ``distance`` [m] along it from the place nearest to the vehicle."""
    nearest = int(np.argmin((path[:, 0] - pose[0]) ** 2 + (path[:, 1] - pose[1]) ** 2))
    for i in range(nearest, len(path)):
        if hypot(path[i, 0] - pose[0], path[i, 1] - pose[1]) >= distance:
            return float(path[i, 0]), float(path[i, 1])
    return float(path[-1, 0]), float(path[-1, 1])
