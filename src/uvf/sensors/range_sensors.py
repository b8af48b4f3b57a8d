"""Lidars, sonars and range finders of all vehicles: rays among what stands in the world and what moves about the vehicle."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uvf.maths.raycast import MovingBody, Rays, Scene, cast
from uvf.maths.rotations import from_euler, matrices, matrix
from uvf.models.vehicle.sensors import Lidar, Mount, RangeFinder, Sonar
from uvf.sensors.body_track import BodyTrack, PosedBody
from uvf.sensors.errors import Channel, Errors

Floats = NDArray[np.float64]

SPACING = np.radians(1.5)  # at most, between a sonar's rays: a leg of 3 cm is met within 1.1 m


class RayFan:
    """Rays about a mount's z axis, at ``angles`` (n,) [rad] counter-clockwise from its x axis."""

    def __init__(self, mount: Mount, angles: Floats) -> None:
        level = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(len(angles))))
        self._directions = level @ matrix(from_euler(*mount.rpy)).T
        self._origin = np.array(mount.xyz)

    def cast(self, scene: Scene, others: Sequence[MovingBody], body: PosedBody, reach: float) -> Floats:
        """Distances (n,) [m] to what each ray meets first, inf where that is nothing within ``reach`` [m]; the body itself is not met."""
        world_from_body = matrix(body.world_from_body)
        rays = Rays(body.position + world_from_body @ self._origin, self._directions @ world_from_body.T)
        return cast(scene, others, rays, reach)

    def cast_on_the_move(self, scene: Scene, others: Sequence[MovingBody], poses: tuple[Floats, Floats], reach: float) -> Floats:
        """Distances (n,) [m], as ``cast``, with a pose of the body for each ray: positions (n, 3) [m] and attitudes wxyz (n, 4), world."""
        positions, attitudes = poses
        world_from_body = matrices(attitudes)
        directions = np.einsum("nij,nj->ni", world_from_body, self._directions)
        return cast(scene, others, Rays(positions + world_from_body @ self._origin, directions), reach)


class LidarModel:
    """One simulated lidar, in its own plane however the vehicle is tilted."""

    def __init__(self, lidar: Lidar, scene: Scene, rng: np.random.Generator) -> None:
        self._lidar = lidar
        self._scene = scene
        self._rng = rng
        self._bias = float(rng.spawn(1)[0].normal(0.0, lidar.bias))
        self._fan = RayFan(lidar.mount, lidar.angle_min + lidar.angle_increment * np.arange(lidar.beams, dtype=np.float64))
        self._reach = lidar.range_max + abs(self._bias) + 10.0 * lidar.noise  # what noise may bring within range is cast too
        moments = np.linspace(-lidar.sweep_time, 0.0, lidar.beams)
        self._moments = moments[::-1] if lidar.clockwise else moments
        """s from the end of the sweep, of each beam."""
        self.track = BodyTrack(lidar.sweep_time)
        """Of the body; who calls ``sweep`` keeps it."""

    def scan(self, body: PosedBody, others: Sequence[MovingBody]) -> Floats:
        """Ranges (beams,) [m], counter-clockwise from ``angle_min``, 0 = no return. others: what moves about the body."""
        return self._measured(self._fan.cast(self._scene, others, body, self._reach))

    def sweep(self, t: float, others: Sequence[MovingBody]) -> Floats:
        """Ranges (beams,) [m] of a sweep that ends at ``t`` [s], each beam from where the body was; 0 = no return.

        others: what moves about the body, where it is at the end of the sweep.
        """
        poses = self.track.at(t + self._moments)
        return self._measured(self._fan.cast_on_the_move(self._scene, others, poses, self._reach))

    def _measured(self, true: Floats) -> Floats:
        measured = true + self._bias + self._rng.normal(0.0, self._lidar.noise, true.shape)
        seen = (measured >= self._lidar.range_min) & (measured <= self._lidar.range_max)
        return np.where(seen, measured, 0.0)


class RangeModel:
    """A simulated sonar, which measures the nearest thing that a fan of rays in its cone meets, or a range finder: one ray."""

    def __init__(self, sensor: Sonar | RangeFinder, scene: Scene, rng: np.random.Generator) -> None:
        self._sensor = sensor
        self._scene = scene
        self._errors = Channel(Errors(noise=sensor.noise), 1, rng)
        self._fan = RayFan(sensor.mount, _angles(sensor))
        self._reach = sensor.range_max + 10.0 * sensor.noise

    def range(self, body: PosedBody, others: Sequence[MovingBody]) -> float:
        """Measured range [m], 0 = no return. body: the vehicle's own; others: what moves about it."""
        sensor = self._sensor
        true = self._fan.cast(self._scene, others, body, self._reach).min()
        measured = float(self._errors.read(np.array((true,)), 0.0)[0])
        return measured if sensor.range_min <= measured <= sensor.range_max else 0.0


def _angles(sensor: Sonar | RangeFinder) -> Floats:
    if isinstance(sensor, RangeFinder):
        return np.zeros(1)
    rays = int(np.ceil(sensor.fov / SPACING)) + 1
    return np.linspace(-sensor.fov / 2, sensor.fov / 2, rays)
