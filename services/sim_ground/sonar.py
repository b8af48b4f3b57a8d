"""A sonar: level rays in a fan at its height; the nearest thing that one of them meets answers for the whole cone."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.planar import Pose2, compose
from uvf.maths.raycast import cast
from uvf.maths.sensing import Channel, Errors
from uvf.runtime.vehicle_file import Sonar
from uvf.runtime.world_geometry import Slice

Floats = NDArray[np.float64]
SPACING = np.radians(1.5)  # at most, between rays: a leg of 3 cm is met within 1.1 m


class SonarModel:
    def __init__(self, sonar: Sonar, world: Slice, rng: np.random.Generator) -> None:
        self._sonar = sonar
        self._world = world
        self._errors = Channel(Errors(noise=sonar.noise), 1, rng)
        rays = int(np.ceil(sonar.fov / SPACING)) + 1
        self._angles: Floats = sonar.mount.rpy[2] + np.linspace(-sonar.fov / 2, sonar.fov / 2, rays)

    def range(self, body: Pose2, others: Floats) -> float:
        """m, 0 = no return. body: pose of base_link, world; others: (n, 3) x, y, radius [m] of vehicles that stand in the way."""
        sonar = self._sonar
        origin = np.array(compose(body, Pose2(sonar.mount.xyz[0], sonar.mount.xyz[1], 0.0))[:2])
        circles = np.vstack((self._world.circles, others))
        true = cast(origin, body.yaw + self._angles, self._world.boxes, circles).min()
        measured = float(self._errors.read(np.array((true,)), 0.0)[0])
        return measured if sonar.range_min <= measured <= sonar.range_max else 0.0
