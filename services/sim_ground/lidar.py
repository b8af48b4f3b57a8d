"""The 2-D lidar: a fan of rays in the scanner's own plane, however the vehicle stands."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.body import BodyState
from uvf.maths.raycast3 import Body, Rays, Scene, cast
from uvf.maths.rotations import from_euler, matrix
from uvf.runtime.vehicle_file import Lidar, Mount

Floats = NDArray[np.float64]


class Fan:
    """Rays at angles about a mount's z axis, from its x axis, counter-clockwise. angles: (n,) rad."""

    def __init__(self, mount: Mount, angles: Floats) -> None:
        level = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(len(angles))))
        self._directions = level @ matrix(from_euler(*mount.rpy)).T
        self._origin = np.array(mount.xyz)

    def cast(self, scene: Scene, others: Sequence[Body], body: BodyState, reach: float) -> Floats:
        """(n,) m to what each ray meets first, inf where that is nothing within ``reach`` [m]; the own body is not met."""
        world_from_body = matrix(body.world_from_body)
        rays = Rays(body.position + world_from_body @ self._origin, self._directions @ world_from_body.T)
        return cast(scene, others, rays, reach)


class LidarModel:
    """One scanner. ``scan`` gives (beams,) ranges [m], counter-clockwise from ``angle_min``, 0 = no return."""

    def __init__(self, lidar: Lidar, scene: Scene, rng: np.random.Generator) -> None:
        self._lidar = lidar
        self._scene = scene
        self._rng = rng
        self._bias = float(rng.spawn(1)[0].normal(0.0, lidar.bias))
        self._fan = Fan(lidar.mount, lidar.angle_min + lidar.angle_increment * np.arange(lidar.beams, dtype=np.float64))
        self._reach = lidar.range_max + abs(self._bias) + 10.0 * lidar.noise  # what noise may bring within range is cast too

    def scan(self, body: BodyState, others: Sequence[Body]) -> Floats:
        """body: the vehicle's own; others: what moves about it."""
        true = self._fan.cast(self._scene, others, body, self._reach)
        measured = true + self._bias + self._rng.normal(0.0, self._lidar.noise, true.shape)
        seen = (measured >= self._lidar.range_min) & (measured <= self._lidar.range_max)
        return np.where(seen, measured, 0.0)
