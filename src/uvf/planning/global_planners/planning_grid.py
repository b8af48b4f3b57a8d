"""A costmap as global planners see it: where the vehicle's centre may be, what is joined, how far the next obstacle is, and both ends."""

from functools import cached_property
from math import ceil

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from uvf.maths.curves.segments import Triple
from uvf.maths.grids import distance_field
from uvf.planning.costmap.costmap import Cell, Costmap
from uvf.planning.costmap.inflation import cost_factors
from uvf.planning.global_planners.planner import GlobalPath, GlobalPlannerSettings, PathQuery, Refusal

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Ends = tuple[Triple, Triple]

OUTSIDE = {"start": Refusal.START_OUTSIDE_MAP, "goal": Refusal.GOAL_OUTSIDE_MAP}
OCCUPIED = {"start": Refusal.START_OCCUPIED, "goal": Refusal.GOAL_OCCUPIED}
NO_WAY = "no way leads to the goal"


class PlanningGrid:
    """``costs``; ``factors`` (256,) of their values, negative = impassable; ``free`` (rows, columns) where the centre may be."""

    def __init__(self, costs: Costmap, settings: GlobalPlannerSettings) -> None:
        """Raises ValueError for a costmap without cells."""
        if costs.values.ndim != 2 or not costs.values.size:
            raise ValueError(f"costs: a map of shape {costs.values.shape}; it takes (rows, columns), at least one of each")
        self.costs, self.factors = costs, cost_factors(settings.cost_travel_multiplier, settings.unknown_cost)
        self.free: Mask = np.ascontiguousarray(self.factors[costs.values] >= 0.0)

    @cached_property
    def distance(self) -> Floats:
        """(rows, columns) cells, from centre to centre of the nearest impassable cell; what lies beyond the map is impassable."""
        return np.ascontiguousarray(distance_field(np.pad(~self.free, 1, constant_values=True))[1:-1, 1:-1])

    @cached_property
    def parts(self) -> NDArray[np.int32]:
        """(rows, columns) number of the part that a cell belongs to, 0 impassable. Corners are not cut, so that four neighbours join."""
        return np.asarray(ndimage.label(self.free)[0], dtype=np.int32)

    def ends(self, query: PathQuery, joined: bool = True) -> Ends | GlobalPath:
        """Where a path is to begin and end, moved as far as the query allows; or the refusal.

        joined: whether the goal must be known to be joined with the start.
        """
        start = self._end("start", query.start, self._beside(query), query.tolerance)
        if isinstance(start, GlobalPath):
            return start
        wanted = self.parts == self.parts[self.cell(start)] if joined or query.tolerance > 0.0 else self.free
        goal = self._end("goal", query.goal, wanted, query.tolerance)
        return goal if isinstance(goal, GlobalPath) else (start, goal)

    def cell(self, at: Triple) -> Cell:
        """Row and column of a pose."""
        return self.costs.cell(at[0], at[1])

    def in_cells(self, at: Triple) -> tuple[float, float]:
        """x, y [cells, from the lower corner of cell [0, 0]] of a pose."""
        (x0, y0), resolution = self.costs.origin, self.costs.resolution
        return (at[0] - x0) / resolution, (at[1] - y0) / resolution

    def in_metres(self, points: Floats) -> Floats:
        """Points (n, 2) [m, map frame] of points x, y [cells]."""
        out: Floats = points * self.costs.resolution + np.array(self.costs.origin)
        return out

    def centres(self, cells: NDArray[np.int64]) -> Floats:
        """Points (n, 2) x, y [cells] of the centres of cells (n, 2), given as row and column."""
        return np.asarray(cells[:, ::-1] + 0.5, dtype=np.float64)

    def nearest(self, wanted: Mask, at: Triple, within: float) -> Triple | None:
        """The pose at the centre of the nearest cell that ``wanted`` (rows, columns) has, within so many metres; None if there is none."""
        x, y = self.in_cells(at)
        reach = within / self.costs.resolution
        rows, columns = wanted.shape
        low = [min(max(ceil(v - reach) - 1, 0), size) for v, size in ((y, rows), (x, columns))]
        high = [min(max(ceil(v + reach) + 1, 0), size) for v, size in ((y, rows), (x, columns))]
        cells = np.argwhere(wanted[low[0] : high[0], low[1] : high[1]]) + np.array(low)
        away: Floats = np.hypot(cells[:, 1] + 0.5 - x, cells[:, 0] + 0.5 - y)
        if not len(cells) or away.min() > reach:
            return None
        px, py = self.costs.points(cells[[int(np.argmin(away))]])[0].tolist()
        return px, py, at[2]

    def _beside(self, query: PathQuery) -> Mask:
        """Cells to which a start may be moved: those joined with the goal, where the goal is free."""
        there = self.cell(query.goal)
        if query.tolerance > 0.0 and self.costs.holds(there) and self.free[there] and not self._is_free(query.start):
            beside: Mask = self.parts == self.parts[there]
            return beside
        return self.free

    def _is_free(self, at: Triple) -> bool:
        cell = self.cell(at)
        return self.costs.holds(cell) and bool(self.free[cell])

    def _end(self, what: str, at: Triple, wanted: Mask, tolerance: float) -> Triple | GlobalPath:
        cell = self.cell(at)
        inside = self.costs.holds(cell)
        if inside and wanted[cell]:
            return float(at[0]), float(at[1]), float(at[2])
        moved = self.nearest(wanted, at, tolerance) if tolerance > 0.0 else None
        if moved is not None:
            return moved
        beyond = f", nor any place within {tolerance:g} m that can be reached" if tolerance > 0.0 else ""
        if not inside:
            return GlobalPath(None, OUTSIDE[what], f"the {what} lies outside the map{beyond}")
        if not self.free[cell]:
            kind = "on unknown ground" if self.costs.unknown[cell] else "in an obstacle or too near to one"
            return GlobalPath(None, OCCUPIED[what], f"the {what} lies {kind}{beyond}")
        return GlobalPath(None, Refusal.NO_VALID_PATH, NO_WAY + beyond)


def poses_along(points: Floats, yaw: float, spacing: float) -> Floats:
    """Poses (m, 3) along a polyline (n, 2) [m], no more than ``spacing`` [m] apart, its corners kept; the last one has ``yaw`` [rad]."""
    step = np.diff(points, axis=0)
    size: Floats = np.hypot(step[:, 0], step[:, 1])
    points = np.vstack((points[:1], points[1:][size > 0.0]))
    if len(points) == 1:
        return np.array([(*points[0], yaw)])
    step, size = np.diff(points, axis=0), size[size > 0.0]
    parts = np.maximum(np.ceil(size / spacing - 1e-9), 1.0).astype(np.int64)
    share = (np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)) / np.repeat(parts, parts)
    out = np.empty((len(share) + 1, 3))
    out[:-1, :2] = np.repeat(points[:-1], parts, axis=0) + share[:, None] * np.repeat(step, parts, axis=0)
    out[:-1, 2] = np.repeat(np.arctan2(step[:, 1], step[:, 0]), parts)
    out[-1] = *points[-1], yaw
    return out
