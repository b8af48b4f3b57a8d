"""Costs of being at each cell of a map: how near the obstacles are, and where a vehicle's centre may not be."""

from dataclasses import dataclass, replace
from math import ceil, floor, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

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
    sensor_offset: float = 0.0  # m from the centre to the lidar that draws the map

    def standing(self, resolution: float) -> float:
        """Radius [m] of the ground that the vehicle covers as it turns, with the lidar's own cell on a map of ``resolution`` [m]."""
        return max(self.radius, self.sensor_offset + sqrt(2.0) * resolution)


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
    cost = _inflated(clearance, resolution, body)
    cost[unknown] *= unknown_cost
    cost[(clearance < body.radius) | ~(free | unknown)] = IMPASSABLE
    cost[cost < 0.0] = IMPASSABLE
    return Costmap(resolution, origin, free, unknown, clearance, cost)


def _inflated(clearance: Floats, resolution: float, body: RobotFootprint) -> Floats:
    """Cost of free ground by its clearance [m], also where that is less than the vehicle needs."""
    nearness = np.clip((body.inflation_radius - clearance) / max(body.inflation_radius - body.radius, resolution), 0.0, 1.0)
    cost: Floats = 1.0 + (body.cost_scaling_factor - 1.0) * nearness**2
    return cost


def with_own_ground(costs: Costmap, start: Cell, body: RobotFootprint) -> Costmap:
    """The costmap with the unknown ground that the vehicle covers at ``start`` taken for free: it stands there.

    A lidar ahead of the vehicle's centre, or one that does not look backwards, never sees that ground before the vehicle moves.
    (Nav2: ``footprint_clearing_enabled``.)
    """
    if not costs.holds(start):
        return costs
    window, covered = ground_below(costs, start, body)
    own = costs.unknown[window] & (costs.cost[window] < 0.0) & covered
    if not own.any():
        return costs
    cost, unknown, clearance = costs.cost.copy(), costs.unknown.copy(), costs.clearance[window]
    price = np.where(clearance < body.radius, IMPASSABLE, _inflated(clearance, costs.resolution, body))
    cost[window][own] = price[own]
    unknown[window][own] = False
    return replace(costs, cost=cost, unknown=unknown)


def leads_away(costs: Costmap, start: Cell, body: RobotFootprint) -> bool:
    """Whether passable cells lead from ``start`` to beyond the ground that the vehicle covers there."""
    if not costs.holds(start):
        return False
    window, covered = ground_below(costs, start, body)
    parts, _ = ndimage.label(costs.cost[window] >= 0.0)
    mine = parts[start[0] - window[0].start, start[1] - window[1].start]
    return bool(mine) and bool((parts[~covered] == mine).any())


def ground_below(costs: Costmap, start: Cell, body: RobotFootprint) -> tuple[tuple[slice, slice], Mask]:
    """A window (rows, columns) about a cell, and the mask of those of its cells that the vehicle covers there as it turns."""
    reach = body.standing(costs.resolution) / costs.resolution
    window = _around(start, ceil(reach) + 1)
    row, column = (np.arange(size)[part] - at for size, part, at in zip(costs.cost.shape, window, start, strict=True))
    covered: Mask = np.hypot(row[:, None], column) <= reach
    return window, covered


def widened(
    cells: NDArray[np.int8], frame: Frame, body: RobotFootprint, place: tuple[float, float]
) -> tuple[NDArray[np.int8], Frame] | None:
    """An occupancy grid and its frame, widened by unknown cells to hold the vehicle at ``place`` [m, map frame].

    None where the vehicle does not even touch the map: there is nothing to plan on from there.
    """
    resolution, (x, y) = frame
    reach = ceil(body.standing(resolution) / resolution)
    gaps = []
    for offset, size in ((place[1] - y, cells.shape[0]), (place[0] - x, cells.shape[1])):
        at = floor(min(max(offset / resolution, -FAR), FAR))
        if not -reach <= at < size + reach:
            return None
        gaps.append((max(reach - at, 0), max(at + reach + 1 - size, 0)))
    wider = np.pad(cells, gaps, constant_values=-1)
    return wider, (resolution, (x - gaps[1][0] * resolution, y - gaps[0][0] * resolution))


def _around(cell: Cell, n: int) -> tuple[slice, slice]:
    """The window of ``n`` cells on every side of a cell, as far as the map has them."""
    row, column = (slice(max(i - n, 0), i + n + 1) for i in cell)
    return row, column


def with_way_out(costs: Costmap, start: Cell, reach: float) -> Costmap:
    """The costmap with expensive but passable cells within ``reach`` [m] of a start that is too near to an obstacle."""
    if not costs.holds(start) or costs.cost[start] >= 0.0:
        return costs
    window = _around(start, ceil(reach / costs.resolution))
    cost = costs.cost.copy()
    cost[window][(cost[window] < 0.0) & (costs.clearance[window] > 0.0) & ~costs.unknown[window]] = ESCAPE_COST
    cost[start] = ESCAPE_COST
    return replace(costs, cost=cost)


ESCAPE_COST = 30.0
"""Of a cell within the vehicle's radius of an obstacle, when it has to be left."""
