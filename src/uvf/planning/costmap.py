"""Costs of being at each cell of a map: how near the obstacles are, and where a vehicle's centre may not be."""

from dataclasses import dataclass
from math import floor

import numpy as np
from numpy.typing import NDArray

from uvf.maths.grids import distance_field

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Cell = tuple[int, int]

OCCUPIED, FREE = 60, 40  # per cent: at least, at most
IMPASSABLE = -1.0
FAR = 1e9
"""Cells; no map reaches so far, and farther places are counted as lying there."""

Frame = tuple[float, tuple[float, float]]
"""Resolution [m] and (x, y) [m, map frame] of the lower left corner of cell [0, 0]."""


@dataclass(frozen=True)
class RobotFootprint:
    """The vehicle's radius, and how paths are kept from obstacles beyond it."""

    radius: float  # m, to the nearest obstacle: nearer is impassable
    inflation_radius: float  # m, nearer costs more
    cost_scaling_factor: float  # factor on the cost of a way right at ``radius``, above 1


@dataclass(frozen=True)
class Costmap:
    """A map prepared for planning; arrays are (rows, columns), points [m] in the map frame."""

    resolution: float
    origin: tuple[float, float]
    free: Mask
    unknown: Mask
    clearance: Floats
    """m to the nearest occupied cell's edge."""
    cost: Floats
    """Per cell driven through, 1 at ease and more near obstacles; ``IMPASSABLE`` where the centre may not be."""

    def cell(self, x: float, y: float) -> Cell:
        """Cell (row, column) of a point [m, map frame], which must be finite; may lie outside."""
        return self._index(y - self.origin[1]), self._index(x - self.origin[0])

    def _index(self, distance: float) -> int:
        return floor(min(max(distance / self.resolution, -FAR), FAR))

    def holds(self, cell: Cell) -> bool:
        """Whether a cell (row, column) lies on the map."""
        rows, columns = self.cost.shape
        return bool(0 <= cell[0] < rows and 0 <= cell[1] < columns)

    def points(self, cells: NDArray[np.int64]) -> Floats:
        """Centres (n, 2) [m, map frame] of the cells (n, 2), given as row and column."""
        out: Floats = (cells[:, ::-1] + 0.5) * self.resolution + np.array(self.origin)
        return out


def make_costmap(cells: NDArray[np.int8], frame: Frame, body: RobotFootprint, unknown_cost: float = IMPASSABLE) -> Costmap:
    """The costmap of an occupancy grid.

    cells: (rows, columns), -1 unknown, 0..100 per cent; unknown_cost: factor [-] on the cost of unknown ground, negative = impassable.
    """
    resolution, origin = frame
    occupied, unknown = cells >= OCCUPIED, cells < 0
    free = ~unknown & (cells <= FREE)
    clearance = (distance_field(occupied) - 0.5) * resolution
    nearness = np.clip((body.inflation_radius - clearance) / max(body.inflation_radius - body.radius, resolution), 0.0, 1.0)
    cost = 1.0 + (body.cost_scaling_factor - 1.0) * nearness**2
    cost[unknown] *= unknown_cost
    cost[(clearance < body.radius) | ~(free | unknown)] = IMPASSABLE
    cost[cost < 0.0] = IMPASSABLE
    return Costmap(resolution, origin, free, unknown, clearance, cost)


def with_way_out(costs: Costmap, start: Cell, reach: float) -> Costmap:
    """The costmap with expensive but passable cells within ``reach`` [m] of a start that is too near to an obstacle."""
    if not costs.holds(start) or costs.cost[start] >= 0.0:
        return costs
    n = int(np.ceil(reach / costs.resolution))
    rows, columns = (slice(max(i - n, 0), i + n + 1) for i in start)
    cost = costs.cost.copy()
    window = cost[rows, columns]
    escape = (window < 0.0) & (costs.clearance[rows, columns] > 0.0) & ~costs.unknown[rows, columns]
    window[escape] = ESCAPE_COST
    cost[start] = ESCAPE_COST
    return Costmap(costs.resolution, costs.origin, costs.free, costs.unknown, costs.clearance, cost)


ESCAPE_COST = 30.0
"""Of a cell within the vehicle's radius of an obstacle, when it has to be left."""
