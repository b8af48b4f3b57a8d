"""The ground under aircraft: the terrain and the tops of all that stands still in the world, z = 0 where there is nothing."""

import numpy as np

from uvf.maths.bvh import build
from uvf.maths.raycast import Rays, Scene, cast
from uvf.maths.rotations import Floats
from uvf.maths.solids import joined

CLEAR = 1.0  # m above an aircraft's centre of gravity, where roofs begin
WIDE = 1.0  # m, about a point; terrain falls by less
HIGHEST = 1e5  # m
DOWN = np.array(((0.0, 0.0, -1.0),))


class GroundSurface:
    """The ground below an aircraft along the vertical, so that it stands in a hangar as well as on its roof."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        bounds = scene.tree.bounds
        self._area: Floats = bounds[0, (0, 1, 3, 4)] if len(bounds) else np.array((np.inf, np.inf, -np.inf, -np.inf))

    def under(self, position: Floats) -> float:
        """Height [m, world] of the surface below an aircraft at ``position`` (3,) [m, world]."""
        return self._below(position[0], position[1], position[2] + CLEAR)

    def top(self, x: float, y: float) -> float:
        """Height [m, world] of the uppermost surface with room for an aircraft at x, y [m, world]: not the top of a wall or mast."""
        here = self._below(x, y, HIGHEST)
        beside = min(self._below(x + dx, y + dy, HIGHEST) for dx, dy in ((WIDE, 0.0), (0.0, WIDE), (-WIDE, 0.0), (0.0, -WIDE)))
        return here if here - beside <= WIDE else beside

    def _below(self, x: float, y: float, z: float) -> float:
        x_min, y_min, x_max, y_max = self._area
        if z <= 0.0 or not (x_min <= x <= x_max and y_min <= y <= y_max):
            return 0.0
        return float(z - cast(self.scene, [], Rays(np.array((x, y, z)), DOWN), np.inf)[0])


LEVEL = GroundSurface(Scene(build(joined([])), 0.0))
"""z = 0 everywhere."""
