"""The ground under the vehicle: it stands there, whatever the map says, and has to be able to drive off."""

from dataclasses import replace
from math import ceil, floor, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from uvf.planning.costmap.costmap import FAR, Cell, Costmap, Frame
from uvf.planning.costmap.inflation import INSCRIBED, MAX_NON_OBSTACLE, Inflation, cost_factors, inflated

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Window = tuple[slice, slice]

LEAVING = MAX_NON_OBSTACLE
"""Value of a cell that is too near to an obstacle, when the vehicle has to leave it; inflation gives no cell this value."""
LEAVING_COST = 30.0
"""Factor on the cost of ground within the inscribed radius of an obstacle, when it has to be left."""
WAY_OUT = 0.3  # m about the vehicle within which it may leave such ground


def standing_radius(circumscribed: float, sensor_offset: float, resolution: float) -> float:
    """Radius [m] of the ground that the vehicle covers as it turns, with the lidar's own cell on a map of ``resolution`` [m].

    circumscribed: of its footprint [m]; sensor_offset: from its centre to the lidar that draws the map [m].
    """
    return max(circumscribed, sensor_offset + sqrt(2.0) * resolution)


def ground_below(costs: Costmap, start: Cell, radius: float) -> tuple[Window, Mask]:
    """A window (rows, columns) about a cell, and the mask of those of its cells that lie within ``radius`` [m] of it."""
    reach = radius / costs.resolution
    window = around(start, ceil(reach) + 1)
    row, column = (np.arange(size)[part] - at for size, part, at in zip(costs.values.shape, window, start, strict=True))
    covered: Mask = np.hypot(row[:, None], column) <= reach
    return window, covered


def around(cell: Cell, n: int) -> Window:
    """The window of ``n`` cells on every side of a cell, as far as the map has them; the cell may lie beside it."""
    row, column = (slice(max(i - n, 0), max(i + n + 1, 0)) for i in cell)
    return row, column


def with_own_ground(costs: Costmap, start: Cell, radius: float, inflation: Inflation) -> Costmap:
    """The costmap with the unknown ground within ``radius`` [m] of ``start`` taken for free: the vehicle covers it.

    A lidar ahead of the vehicle's centre, or one that does not look backwards, never sees that ground before the vehicle moves.
    (Nav2: ``footprint_clearing_enabled``.)
    """
    if not costs.holds(start):
        return costs
    window, covered = ground_below(costs, start, radius)
    own = costs.unknown[window] & covered
    if not own.any():
        return costs
    values, unknown = costs.values.copy(), costs.unknown.copy()
    inscribed = costs.footprint.inscribed_radius + costs.resolution / 2
    scale = (inflation.inflation_radius, inflation.cost_scaling_factor)
    values[window][own] = inflated(np.ascontiguousarray(costs.distance[window]), costs.resolution, inscribed, scale)[own]
    unknown[window][own] = False
    return replace(costs, values=values, unknown=unknown)


def with_way_out(costs: Costmap, start: Cell, reach: float) -> Costmap:
    """The costmap with expensive but passable cells within ``reach`` [m] of a start that is too near to an obstacle."""
    if not costs.holds(start) or costs.values[start] < INSCRIBED:
        return costs
    window = around(start, ceil(reach / costs.resolution))
    values = costs.values.copy()
    near = (values[window] == INSCRIBED) & (costs.distance[window] >= 1.0) & ~costs.unknown[window]
    values[window][near] = LEAVING
    values[start] = LEAVING
    return replace(costs, values=values)


def leaving_factors(multiplier: float, unknown: float) -> Floats:
    """(256,) factors [-] by value as ``cost_factors`` has them, with ground that has to be left."""
    factors = cost_factors(multiplier, unknown)
    factors[LEAVING] = LEAVING_COST
    return factors


def leads_away(costs: Costmap, start: Cell, radius: float) -> bool:
    """Whether passable cells lead from ``start`` to beyond the ground within ``radius`` [m] of it."""
    if not costs.holds(start):
        return False
    window, covered = ground_below(costs, start, radius)
    parts, _ = ndimage.label(costs.values[window] < INSCRIBED)
    mine = parts[start[0] - window[0].start, start[1] - window[1].start]
    return bool(mine) and bool((parts[~covered] == mine).any())


def widened(cells: NDArray[np.int8], frame: Frame, radius: float, place: tuple[float, float]) -> tuple[NDArray[np.int8], Frame] | None:
    """An occupancy grid and its frame, widened by unknown cells to hold a disc of ``radius`` [m] at ``place`` [m, map frame].

    None where that disc does not even touch the map: there is nothing to plan on from there.
    """
    resolution, (x, y) = frame
    reach = ceil(radius / resolution)
    gaps = []
    for offset, size in ((place[1] - y, cells.shape[0]), (place[0] - x, cells.shape[1])):
        at = floor(min(max(offset / resolution, -FAR), FAR))
        if not -reach <= at < size + reach:
            return None
        gaps.append((max(reach - at, 0), max(at + reach + 1 - size, 0)))
    wider = np.pad(cells, gaps, constant_values=-1)
    return wider, (resolution, (x - gaps[1][0] * resolution, y - gaps[0][0] * resolution))
