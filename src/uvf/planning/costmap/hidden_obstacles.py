"""Obstacles that the lidar does not see, for it looks over them or below them: each sensor clears only what it has marked itself."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2, transform
from uvf.planning.costmap.bumps import Bump
from uvf.planning.costmap.obstacle_layer import BeamObservation, ObstacleLayer
from uvf.planning.costmap.range_sights import GroundSight

Floats = NDArray[np.float64]

REMEMBERED = 20.0
"""Times the lifetime of what is seen that a touch is remembered: the vehicle finds out no other way."""
ALIKE = 0.15  # m between what a sonar and the lidar say for it to be the same thing


class HiddenObstacles:
    """One vehicle's, in the frame and by the age of the layer of its lidar."""

    def __init__(self, size: float, resolution: float, lifetime: float) -> None:
        """Of each layer, as in ``ObstacleLayer``."""
        self._shape = size, resolution, lifetime
        self._layers: dict[str, ObstacleLayer] = {}
        self.touched: Floats = np.zeros((0, 2))
        """(n, 2) m."""
        self._touched_at: Floats = np.zeros(0)

    def see(self, sensor: str, when: tuple[float, float], pose: Pose2, sight: GroundSight) -> None:
        """Takes what a sensor saw from a pose; when: (time [s], age)."""
        layer = self._layers.setdefault(sensor, ObstacleLayer(*self._shape))
        layer.recentre((pose[0], pose[1]))
        (x, y), *_ = transform(pose, np.array((sight.eye,))).tolist()
        starts, ends = transform(pose, sight.starts), transform(pose, sight.ends)
        layer.observe(BeamObservation(*when, (x, y), ends, sight.hits, starts))

    def bump(self, age: float, bump: Bump) -> None:
        """Remembers where the vehicle was touched."""
        self.touched = np.concatenate((self.touched, transform(bump.pose, bump.points)))
        self._touched_at = np.concatenate((self._touched_at, np.full(len(bump.points), age)))

    def points(self, age: float, centre: tuple[float, float], reach: float) -> Floats:
        """(n, 2) m of all that is still remembered at ``age`` within ``reach`` [m] of ``centre`` along both axes."""
        kept = self._touched_at >= age - REMEMBERED * self._shape[2]
        self.touched, self._touched_at = self.touched[kept], self._touched_at[kept]
        near = self.touched[(np.abs(self.touched - np.array(centre)) <= reach).all(axis=1)]
        for layer in self._layers.values():
            layer.forget(age)
        return np.concatenate((near, *(layer.lethal_near(centre, reach) for layer in self._layers.values())))

    def clear(self, beyond: float, centre: tuple[float, float]) -> None:
        """Forgets what was seen, not what was touched, farther than ``beyond`` [m] from ``centre`` [m]."""
        for layer in self._layers.values():
            layer.clear(beyond, centre)


def unexplained(sight: GroundSight, seen: Floats) -> GroundSight:
    """A sonar's arc, without its marks where points (n, 2) [m, base frame] that the lidar sees lie on it: that is what it has heard."""
    if not (sight.hits.any() and len(seen)):
        return sight
    away, arc = seen - np.array(sight.eye), sight.ends - np.array(sight.eye)
    distance, middle = float(np.hypot(*arc[0])), arc.mean(axis=0)
    off = np.abs(np.arctan2(middle[0] * away[:, 1] - middle[1] * away[:, 0], away @ middle))
    half = np.abs(np.arctan2(middle[0] * arc[0, 1] - middle[1] * arc[0, 0], arc[0] @ middle))
    heard = (off <= half) & (np.abs(np.hypot(*away.T) - distance) <= ALIKE)
    return sight._replace(hits=np.zeros_like(sight.hits)) if heard.any() else sight
