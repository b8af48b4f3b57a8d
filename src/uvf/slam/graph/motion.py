"""How the vehicle has moved since the last sweep, by its odometry."""

from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2, compose

Floats = NDArray[np.float64]


Sigmas = tuple[float, float]
"""1 sigma of position [m] and heading [rad]."""

ALLOWANCE, LEAST_OFF = 3.0, (2e-3, 3e-4)
"""Times what an odometry says of a step, and m and rad at least, that it is off."""


@dataclass(frozen=True)
class MotionNoise:
    """1 sigma of a step of odometry: position [m] and heading [rad], each at once, per m driven and per rad turned."""

    position: tuple[float, float, float] = (0.005, 0.1, 0.03)
    heading: tuple[float, float, float] = (0.003, 0.02, 0.15)

    def sigmas(self, step: Pose2) -> Sigmas:
        """Of a step."""
        way = np.array((1.0, hypot(step[0], step[1]), abs(step[2])))
        return float(way @ self.position), float(way @ self.heading)

    def information(self, step: Pose2, claimed: Sigmas | None = None) -> Floats:
        """Information (3, 3) of (x, y, yaw) of a step [1/m^2, 1/rad^2].

        claimed: as the odometry has it; that counts with some allowance where it is the smaller one.
        """
        position, heading = self.sigmas(step)
        if claimed is not None:
            position, heading = (
                min(usual, max(ALLOWANCE * said, least)) for usual, said, least in zip((position, heading), claimed, LEAST_OFF, strict=True)
            )
        return np.diag((position**-2, position**-2, heading**-2))


UNKNOWN = MotionNoise((0.25, 0.1, 0.03), (0.25, 0.02, 0.15))
"""Of a step that the odometry has not told."""


@dataclass(frozen=True)
class OdometryMotion:
    """A step of odometry from the pose ``before`` (map_from_base).

    disputed: something tells that the step is wrong; claimed: how far off it is as the odometry has it, None where it does not say.
    """

    before: Pose2
    step: Pose2
    noise: MotionNoise
    disputed: bool = False
    claimed: Sigmas | None = None

    @property
    def guess(self) -> Pose2:
        """Pose map_from_base after the step."""
        return compose(self.before, self.step)

    @property
    def sigmas(self) -> Sigmas:
        """Of the step."""
        return self.noise.sigmas(self.step)

    @property
    def information(self) -> Floats:
        """Information (3, 3) of (x, y, yaw) of the step [1/m^2, 1/rad^2]."""
        return self.noise.information(self.step)

    @property
    def told(self) -> bool:
        """Whether there is an odometry to rely on."""
        return self.noise is not UNKNOWN and not self.disputed
