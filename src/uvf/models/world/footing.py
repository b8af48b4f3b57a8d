"""How one stands at a point of a world, and how much room there is; what that needs of the world is worked out once."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.footprint import Footprint, footprint
from uvf.maths.se2 import Pose2, transform
from uvf.maths.solids import chosen, joined
from uvf.models.shapes.scene import primitives
from uvf.models.world.drivable import drivable
from uvf.models.world.file import WorldFile
from uvf.models.world.geometry import GRAZE, empty_plan, things
from uvf.models.world.terrain import relief

Floats = NDArray[np.float64]
COARSE = 0.1  # m, cells in which the ground under one point is looked for


class GroundContact(NamedTuple):
    """Room [m] to the nearest obstacle, and height [m, world] and slope, as a gradient [-], of the ground there."""

    room: float
    height: float
    slope: float


class Footing:
    """Looks up ground height and free room in a world. What moves by script counts where it is at the beginning.

    What one drives on is no obstacle.
    """

    def __init__(self, world: WorldFile) -> None:
        """Raises BadInput for a mesh or a terrain that cannot be read."""
        every = joined([primitives(thing) for thing in things(world)])
        self._plan, self._relief = empty_plan(world, COARSE), relief(world)
        self._ground = drivable(every, *self._plan.axes(), self._relief)
        self._bulk = chosen(every, ~self._ground.surface)

    def at(self, x: float, y: float, height: float = 0.2) -> GroundContact:
        """Ground contact of a vehicle of ``height`` [m] at (x, y) [m, world]."""
        floor, slope = self._floor(x, y)
        return GroundContact(self.room(x, y, (floor + GRAZE, floor + height)), floor, slope)

    def is_free(self, pose: Pose2, outline: Floats, height: float = 0.2) -> bool:
        """Whether a vehicle stands in nothing at a pose [m, rad, world]; outline: (n, 2) [m, about its place] convex, anticlockwise."""
        floor, _ = self._floor(pose.x, pose.y)
        return not overlaps(transform(pose, outline), footprint(self._bulk, floor + GRAZE, floor + height))

    def room(self, x: float, y: float, heights: tuple[float, float]) -> float:
        """Distance [m] from (x, y) [m, world] to the nearest thing between two heights [m, world]; 0 inside one, inf when there is none."""
        return distance(footprint(self._bulk, *heights), x, y)

    def _floor(self, x: float, y: float) -> tuple[float, float]:
        if self._relief is not None:
            height, slope = self._relief.at(np.array(x), np.array(y))
        row, column = self._plan.cell(x, y)
        rows, columns = self._plan.cells.shape
        if 0 <= row < rows and 0 <= column < columns:
            return float(self._ground.height[row, column]), float(self._ground.slope[row, column])
        return (0.0, 0.0) if self._relief is None else (float(height), float(slope))


def distance(shadows: Footprint, x: float, y: float) -> float:
    """Distance [m] from (x, y) [m] to the nearest shadow; 0 inside one, inf when there is none."""
    nearest = [max(float(np.hypot(x - cx, y - cy)) - radius, 0.0) for cx, cy, radius in shadows.discs]
    return min([*nearest, *(_to_outline(outline, np.array((x, y))) for outline in shadows.outlines)], default=np.inf)


def overlaps(outline: Floats, shadows: Footprint) -> bool:
    """Whether a convex outline (n, 2) [m], anticlockwise, and any shadow have more than an edge in common (separating axes)."""
    low, high = outline.min(axis=0), outline.max(axis=0)
    for other in shadows.outlines:
        if (other.min(axis=0) < high).all() and (other.max(axis=0) > low).all() and not (_parts(outline, other) or _parts(other, outline)):
            return True
    return any(_to_outline(outline, np.array((x, y))) < radius for x, y, radius in shadows.discs)


def _parts(outline: Floats, other: Floats) -> bool:
    """Whether a side of the outline has all of the other one beyond it."""
    sides = np.roll(outline, -1, axis=0) - outline
    outward = np.column_stack((sides[:, 1], -sides[:, 0]))
    edges = (outward * outline).sum(axis=1)
    return bool(((other @ outward.T).min(axis=0) >= edges - 1e-9).any())


def _to_outline(outline: Floats, point: Floats) -> float:
    """[m] From a point to a convex outline (k, 2), anticlockwise."""
    sides = np.roll(outline, -1, axis=0) - outline
    away = point - outline
    if len(outline) > 2 and (sides[:, 0] * away[:, 1] - sides[:, 1] * away[:, 0] >= 0).all():
        return 0.0
    share = np.clip((away * sides).sum(axis=1) / np.maximum((sides * sides).sum(axis=1), 1e-18), 0.0, 1.0)
    return float(np.linalg.norm(away - share[:, np.newaxis] * sides, axis=1).min())
