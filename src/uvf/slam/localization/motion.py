"""Motion of particles by odometry: Thrun, Burgard & Fox, "Probabilistic Robotics" (2005), table 5.6."""

from dataclasses import dataclass
from math import atan2, hypot, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2

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
        """Noise of an odometry whose sigmas are ``factor`` [-] times as large."""
        parts = (self.turn_by_turn, self.turn_by_way, self.way_by_way, self.way_by_turn)
        return OdometryNoise(*(factor**2 * v for v in parts), *(factor * v for v in (self.way, self.turn)))


def sample_motion(poses: Floats, step: Pose2, noise: OdometryNoise, rng: np.random.Generator) -> Floats:
    """Poses (n, 3) [m, m, rad] after a step of the odometry, each by a turn, a way and a second turn of its own.

    A short step has hardly a direction: no more counts as its two turns than the vehicle has turned.
    """
    way = hypot(step.x, step.y)
    first = atan2(step.y, step.x) if way > ON_THE_SPOT else 0.0
    backwards = abs(first) > pi / 2
    if backwards:
        first, way = wrap(first + pi), -way
    second = wrap(step.yaw - first)
    turned = min(first**2, step.yaw**2), min(second**2, step.yaw**2)
    sigmas = (
        _sigma(noise.turn, noise.turn_by_turn * turned[0], noise.turn_by_way * way**2),
        _sigma(noise.way, noise.way_by_way * way**2, noise.way_by_turn * sum(turned)),
        _sigma(noise.turn, noise.turn_by_turn * turned[1], noise.turn_by_way * way**2),
        noise.way,
    )
    return _moved(poses, (first, way, second), sigmas, rng.standard_normal((len(poses), 4)))


@compiled
def _moved(poses: Floats, parts: tuple[float, float, float], sigmas: tuple[float, float, float, float], normals: Floats) -> Floats:
    """sigmas: of the first turn [rad], the way [m], the second turn [rad] and aside [m]; normals: (n, 4)."""
    out = np.empty_like(poses)
    for i in range(poses.shape[0]):
        first = parts[0] + sigmas[0] * normals[i, 0]
        way, aside = parts[1] + sigmas[1] * normals[i, 1], sigmas[3] * normals[i, 3]
        x, y = way * np.cos(first), way * np.sin(first) + aside
        c, s = np.cos(poses[i, 2]), np.sin(poses[i, 2])
        turn = first + parts[2] + sigmas[2] * normals[i, 2]
        out[i, 0], out[i, 1] = poses[i, 0] + c * x - s * y, poses[i, 1] + s * x + c * y
        out[i, 2] = (poses[i, 2] + turn + np.pi) % (2.0 * np.pi) - np.pi
    return out


def _sigma(least: float, *variances: float) -> float:
    return sqrt(least**2 + sum(variances))
