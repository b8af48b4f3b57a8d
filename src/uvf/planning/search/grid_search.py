"""Searches over a cost grid: Dijkstra, A*, jump points and Theta*, with a record that is kept from query to query.

Eight neighbours; a step costs its length [cells] times the mean factor of both cells; corners are not cut. The grid is kept flat with
a border of one impassable cell, so that no kernel asks where the map ends.
"""

from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import NDArray

from uvf.planning.search.best_first import expand, trace
from uvf.planning.search.jump_points import between, jump_point_search
from uvf.planning.search.open_list import make_heap, make_record
from uvf.planning.search.theta_star import pull_taut, theta_star

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float64]
Cells = NDArray[np.int64]
Cell = tuple[int, int]

LAST_RUN = 2**31 - 1
"""Number of the last run whose stamps fit; the record is cleared after it."""


@dataclass(frozen=True)
class GridPath:
    """A path (n, 2) of cells (row, column) from start to goal, its cost [cells], and how many cells were expanded for it."""

    cells: Cells
    cost: float
    expanded: int


class CostToGo:
    """The cheapest paths from one cell to all others."""

    def __init__(self, cost: Floats, parent: NDArray[np.int32], columns: int) -> None:
        self.cost = cost
        """(rows, columns) cost of the way there [cells], inf where none leads."""
        self._parent, self._columns = parent, columns

    def to(self, goal: Cell) -> Cells:
        """Path (n, 2) of cells from the start to ``goal``; only for a goal that ``cost`` says can be reached."""
        _check_cell("goal", goal, self.cost.shape)
        return _cells(trace(self._parent, _index(goal, self._columns)), self._columns)


class GridSearch:
    """Answers queries on one grid of values (rows, columns).

    factors: (256,) cost factor [-] of each value, 1 or more, negative = impassable. Not for several threads at once: queries share
    one record. A start or goal outside of the grid raises ValueError, one on an impassable cell has no path.
    """

    def __init__(self, values: Bytes, factors: Floats) -> None:
        if values.ndim != 2 or values.size == 0 or values.dtype != np.uint8:
            raise ValueError(f"values: a grid (rows, columns) of bytes is needed, this is {values.shape} of {values.dtype}")
        if factors.shape != (256,) or not np.isfinite(factors).all() or ((factors >= 0.0) & (factors < 1.0)).any():
            raise ValueError("factors: 256 finite numbers are needed, each 1 or more, or negative for an impassable value")
        impassable = np.flatnonzero(factors < 0.0)
        if not len(impassable):
            raise ValueError("factors: one value at least must be impassable (negative): the map's border has it")
        self.shape: tuple[int, int] = (values.shape[0], values.shape[1])
        self._factors = np.ascontiguousarray(factors, dtype=np.float64)
        self._columns = values.shape[1] + 2
        self._grid = np.pad(values, 1, constant_values=impassable[0]).ravel()
        self._free: NDArray[np.bool_] | None = None
        self._record, self._heap, self._run = make_record(self._grid.size), make_heap(), 0

    def astar(self, start: Cell, goal: Cell) -> GridPath | None:
        """Cheapest path by A* with the octile distance (Hart, Nilsson, Raphael 1968); None if there is none."""
        return self._best_first(start, goal, 1.0)

    def dijkstra(self, start: Cell, goal: Cell) -> GridPath | None:
        """Cheapest path by Dijkstra's search (1959), which expands in all directions; None if there is none."""
        return self._best_first(start, goal, 0.0)

    def jump_points(self, start: Cell, goal: Cell) -> GridPath | None:
        """Shortest path by jump point search, every passable cell at factor 1; None if there is none."""
        ends = self._ends(start, goal)
        if ends is None:
            return None
        if self._free is None:
            self._free = self._factors[self._grid] >= 0.0
        expanded, self._heap = jump_point_search(self._free, self._columns, ends, (self._next_run(), self._record, self._heap))
        if not self._closed(ends[1]):
            return None
        path = between(trace(self._record.parent, ends[1]), self._columns)
        return GridPath(_cells(path, self._columns), float(self._record.g[ends[1]]), expanded)

    def theta_star(self, start: Cell, goal: Cell) -> GridPath | None:
        """Any-angle path by lazy Theta*, pulled taut; its cells are its ends and corners. None if there is none."""
        ends = self._ends(start, goal)
        if ends is None:
            return None
        run = (self._next_run(), self._record, self._heap)
        expanded, self._heap = theta_star(self._grid, self._columns, self._factors, ends, run)
        if not self._closed(ends[1]):
            return None
        corners, cost = pull_taut(self._grid, self._columns, self._factors, trace(self._record.parent, ends[1]))
        return GridPath(_cells(corners, self._columns), cost, expanded)

    def cost_to_go(self, start: Cell) -> CostToGo:
        """The cheapest paths from ``start`` to every cell; from an impassable cell none leads anywhere."""
        _check_cell("start", start, self.shape)
        at = _index(start, self._columns)
        if self._factors[self._grid[at]] < 0.0:
            return CostToGo(np.full(self.shape, inf), np.full(self._grid.size, -1, dtype=np.int32), self._columns)
        self._expand((at, -1), 0.0)
        field = np.where(self._record.stamp == 2 * self._run + 1, self._record.g, inf).reshape(-1, self._columns)
        return CostToGo(np.ascontiguousarray(field[1:-1, 1:-1]), self._record.parent.copy(), self._columns)

    def _best_first(self, start: Cell, goal: Cell, weight: float) -> GridPath | None:
        ends = self._ends(start, goal)
        if ends is None:
            return None
        expanded = self._expand(ends, weight)
        if not self._closed(ends[1]):
            return None
        path = trace(self._record.parent, ends[1])
        return GridPath(_cells(path, self._columns), float(self._record.g[ends[1]]), expanded)

    def _expand(self, ends: tuple[int, int], weight: float) -> int:
        run = (weight, self._next_run(), self._record, self._heap)
        expanded, self._heap = expand(self._grid, self._columns, self._factors, ends, run)
        return expanded

    def _ends(self, start: Cell, goal: Cell) -> tuple[int, int] | None:
        _check_cell("start", start, self.shape)
        _check_cell("goal", goal, self.shape)
        ends = _index(start, self._columns), _index(goal, self._columns)
        return ends if all(self._factors[self._grid[i]] >= 0.0 for i in ends) else None

    def _next_run(self) -> int:
        if self._run >= LAST_RUN:
            self._record.stamp[:] = 0
            self._run = 0
        self._run += 1
        return self._run

    def _closed(self, i: int) -> bool:
        return bool(self._record.stamp[i] == 2 * self._run + 1)


def _index(cell: Cell, columns: int) -> int:
    """Flat index, with the border."""
    return (cell[0] + 1) * columns + cell[1] + 1


def _cells(indices: Cells, columns: int) -> Cells:
    """(n, 2) rows and columns, without the border."""
    return np.column_stack((indices // columns - 1, indices % columns - 1))


def _check_cell(what: str, cell: Cell, shape: tuple[int, int]) -> None:
    rows, columns = shape
    if not (0 <= cell[0] < rows and 0 <= cell[1] < columns):
        raise ValueError(
            f"{what}: cell (row {cell[0]}, column {cell[1]}) is outside the map of {rows} rows and {columns} columns; "
            "check its frame (map) and unit (m)"
        )
