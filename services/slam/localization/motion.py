"""Motion of particles by odometry: Thrun, Burgard & Fox, "Probabilistic Robotics" (2005), table 5.6."""

from dataclasses import dataclass
from math import atan2, hypot, pi

import numpy as np
from numpy.typing import NDArray

from uvf.maths.planar import Pose2
from uvf.maths.planar_arrays import composed
from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]

ON_THE_SPOT = 0.005  # m, below which the direction of a step is not known


@dataclass(frozen=True)
class OdometryNoise:
    """Variances of a step's parts: alpha1 to alpha4 of the table, and what is always there.

    turn_by_turn: rad^2 per rad^2 turned; turn_by_way: rad^2 per m^2 driven; way_by_way: m^2 per m^2; way_by_turn: m^2 per rad^2.
    way, turn: 1 sigma of a step that is none [m, rad].
    """

    turn_by_turn: float = 0.03
    turn_by_way: float = 0.03
    way_by_way: float = 0.03
    way_by_turn: float = 0.002
    way: float = 0.003
    turn: float = 0.002

    def times(self, factor: float) -> "OdometryNoise":
        """Of an odometry whose sigmas are so many times as large."""
        parts = (self.turn_by_turn, self.turn_by_way, self.way_by_way, self.way_by_turn)
        return OdometryNoise(*(factor**2 * v for v in parts), *(factor * v for v in (self.way, self.turn)))


def sample_motion(poses: Floats, step: Pose2, noise: OdometryNoise, rng: np.random.Generator) -> Floats:
    """Poses (n, 3) after a step of the odometry, each by a turn, a way and a second turn of its own.

    A short step has hardly a direction: no more counts as its two turns than the vehicle has turned.
    """
    way = hypot(step.x, step.y)
    first = atan2(step.y, step.x) if way > ON_THE_SPOT else 0.0
    backwards = abs(first) > pi / 2
    if backwards:
        first, way = wrap(first + pi), -way
    second = wrap(step.yaw - first)
    turned = min(first**2, step.yaw**2), min(second**2, step.yaw**2)
    n = len(poses)
    turn_1 = first + _sigma(noise.turn, noise.turn_by_turn * turned[0], noise.turn_by_way * way**2) * rng.standard_normal(n)
    ways = way + _sigma(noise.way, noise.way_by_way * way**2, noise.way_by_turn * sum(turned)) * rng.standard_normal(n)
    turn_2 = second + _sigma(noise.turn, noise.turn_by_turn * turned[1], noise.turn_by_way * way**2) * rng.standard_normal(n)
    aside = noise.way * rng.standard_normal(n)
    return composed(poses, np.column_stack((ways * np.cos(turn_1), ways * np.sin(turn_1) + aside, turn_1 + turn_2)))


def _sigma(least: float, *variances: float) -> float:
    return float(np.sqrt(least**2 + sum(variances)))
