"""A sonar: rays in a fan; the nearest thing that one of them meets answers for the whole cone."""

from collections.abc import Sequence

import numpy as np

from services.sim_ground.body import BodyState
from services.sim_ground.lidar import Fan
from uvf.maths.raycast3 import Body, Scene
from uvf.maths.sensing import Channel, Errors
from uvf.runtime.vehicle_file import Sonar

SPACING = np.radians(1.5)  # at most, between rays: a leg of 3 cm is met within 1.1 m


class SonarModel:
    def __init__(self, sonar: Sonar, scene: Scene, rng: np.random.Generator) -> None:
        self._sonar = sonar
        self._scene = scene
        self._errors = Channel(Errors(noise=sonar.noise), 1, rng)
        rays = int(np.ceil(sonar.fov / SPACING)) + 1
        self._fan = Fan(sonar.mount, np.linspace(-sonar.fov / 2, sonar.fov / 2, rays))
        self._reach = sonar.range_max + 10.0 * sonar.noise

    def range(self, body: BodyState, others: Sequence[Body]) -> float:
        """m, 0 = no return. body: the vehicle's own; others: what moves about it."""
        sonar = self._sonar
        true = self._fan.cast(self._scene, others, body, self._reach).min()
        measured = float(self._errors.read(np.array((true,)), 0.0)[0])
        return measured if sonar.range_min <= measured <= sonar.range_max else 0.0
