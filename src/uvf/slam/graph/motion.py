"""How the vehicle has moved since the last sweep, by its odometry."""

from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2, compose

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class MotionNoise:
    """1 sigma of a step of odometry: m and rad at once, per m driven and per rad turned."""

    position: tuple[float, float, float] = (0.005, 0.1, 0.03)
    heading: tuple[float, float, float] = (0.003, 0.02, 0.15)

    def sigmas(self, step: Pose2) -> tuple[float, float]:
        """m, rad."""
        way = np.array((1.0, hypot(step[0], step[1]), abs(step[2])))
        return float(way @ self.position), float(way @ self.heading)

    def information(self, step: Pose2) -> Floats:
        """(3, 3) of (x, y, yaw)."""
        position, heading = self.sigmas(step)
        return np.diag((position**-2, position**-2, heading**-2))


UNKNOWN = MotionNoise((0.25, 0.1, 0.03), (0.25, 0.02, 0.15))
"""Of a step that the odometry has not told."""


@dataclass(frozen=True)
class OdometryMotion:
    """From where the vehicle was (map_from_base), by the odometry; disputed: something tells that this is wrong."""

    before: Pose2
    step: Pose2
    noise: MotionNoise
    disputed: bool = False

    @property
    def guess(self) -> Pose2:
        return compose(self.before, self.step)

    @property
    def sigmas(self) -> tuple[float, float]:
        """m, rad."""
        return self.noise.sigmas(self.step)

    @property
    def information(self) -> Floats:
        """(3, 3) of (x, y, yaw)."""
        return self.noise.information(self.step)

    @property
    def told(self) -> bool:
        """Whether there is an odometry to be held to."""
        return self.noise is not UNKNOWN and not self.disputed
