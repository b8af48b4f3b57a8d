"""The 2-D lidar: level rays at the scanner's height against the world's outlines and the other vehicles."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.planar import Pose2, compose
from uvf.maths.raycast import cast
from uvf.runtime.vehicle_file import Lidar
from uvf.runtime.world_geometry import Slice

Floats = NDArray[np.float64]


class LidarModel:
    """One scanner. ``scan`` gives (beams,) ranges [m], counter-clockwise from ``angle_min``, 0 = no return."""

    def __init__(self, lidar: Lidar, world: Slice, rng: np.random.Generator) -> None:
        self._lidar = lidar
        self._world = world
        self._rng = rng
        self._bias = float(rng.spawn(1)[0].normal(0.0, lidar.bias))
        beams = np.arange(lidar.beams, dtype=np.float64)
        self._angles: Floats = lidar.mount.rpy[2] + lidar.angle_min + lidar.angle_increment * beams

    def scan(self, body: Pose2, others: Floats) -> Floats:
        """body: pose of base_link, world; others: (n, 3) x, y, radius [m] of vehicles that stand in the way."""
        x, y, _ = self._lidar.mount.xyz
        origin = np.array(compose(body, Pose2(x, y, 0.0))[:2])
        circles = np.vstack((self._world.circles, others))
        true = cast(origin, body.yaw + self._angles, self._world.boxes, circles)
        measured = true + self._bias + self._rng.normal(0.0, self._lidar.noise, true.shape)
        seen = (measured >= self._lidar.range_min) & (measured <= self._lidar.range_max)
        return np.where(seen, measured, 0.0)
