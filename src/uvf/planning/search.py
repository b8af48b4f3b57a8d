"""Cheapest ways over a cost grid: A* to one goal, Dijkstra's field to everywhere.

Eight neighbours; a step costs its length times the mean cost of both cells; corners are not cut.
"""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Cells = NDArray[np.int64]
Cell = tuple[int, int]

Numbers = TypeVar("Numbers", Floats, Cells)

ROOM = 4096
"""Of a heap at first. Few cells wait at a time, but up to eight times as many as there are could."""
DIAGONAL = float(np.sqrt(2.0))


@compiled
def _push(keys: Floats, items: Cells, size: int, key: float, item: int) -> int:
    """Puts an item into a binary heap of the smallest key; the new size."""
    i = size
    while i > 0 and keys[(i - 1) // 2] > key:
        keys[i], items[i] = keys[(i - 1) // 2], items[(i - 1) // 2]
        i = (i - 1) // 2
    keys[i], items[i] = key, item
    return size + 1


@compiled
def _pop(keys: Floats, items: Cells, size: int) -> int:
    """Takes the top off; the new size. The caller has read the top before."""
    size -= 1
    key, item = keys[size], items[size]
    i = 0
    while 2 * i + 1 < size:
        child = 2 * i + 1
        if child + 1 < size and keys[child + 1] < keys[child]:
            child += 1
        if keys[child] >= key:
            break
        keys[i], items[i] = keys[child], items[child]
        i = child
    keys[i], items[i] = key, item
    return size


@compiled
def _grown(values: Numbers, size: int) -> Numbers:
    """The same with as much room again."""
    out = np.empty(2 * values.size, dtype=values.dtype)
    out[:size] = values[:size]
    return out


@compiled
def _octile(r: int, c: int, goal_r: int, goal_c: int) -> float:
    """Length [cells] of the shortest eight-neighbour way over free ground."""
    dr, dc = abs(r - goal_r), abs(c - goal_c)
    way: float = max(dr, dc) + (DIAGONAL - 1.0) * min(dr, dc)
    return way


@compiled
def _expand(cost: Floats, start: tuple[int, int], goal: tuple[int, int]) -> tuple[Floats, Cells]:
    """(way's cost from start, flat index of the cell before), both by cell; a goal of row -1 expands everything.

    A* with f = g + octile distance (costs are >= 1, so it never overestimates; Hart, Nilsson, Raphael 1968).
    """
    rows, columns = cost.shape
    g = np.full((rows, columns), np.inf)
    before = np.full(rows * columns, -1, dtype=np.int64)
    done = np.zeros((rows, columns), dtype=np.bool_)
    keys, items = np.empty(ROOM), np.empty(ROOM, dtype=np.int64)
    size = _push(keys, items, 0, 0.0, start[0] * columns + start[1])
    g[start] = 0.0
    while size > 0:
        top = items[0]
        size = _pop(keys, items, size)
        r, c = top // columns, top % columns
        if done[r, c]:
            continue
        done[r, c] = True
        if r == goal[0] and c == goal[1]:
            break
        if size + 8 > keys.size:
            keys, items = _grown(keys, size), _grown(items, size)
        for dr in range(-1, 2):
            for dc in range(-1, 2):
                nr, nc = r + dr, c + dc
                if (dr == 0 and dc == 0) or nr < 0 or nc < 0 or nr >= rows or nc >= columns:
                    continue
                if cost[nr, nc] < 0.0 or done[nr, nc]:
                    continue
                if dr != 0 and dc != 0 and (cost[r, nc] < 0.0 or cost[nr, c] < 0.0):
                    continue
                length = DIAGONAL if dr != 0 and dc != 0 else 1.0
                way = g[r, c] + length * 0.5 * (cost[r, c] + cost[nr, nc])
                if way < g[nr, nc]:
                    g[nr, nc] = way
                    before[nr * columns + nc] = top
                    estimate = _octile(nr, nc, goal[0], goal[1]) if goal[0] >= 0 else 0.0
                    size = _push(keys, items, size, way + estimate, nr * columns + nc)
    return g, before


@compiled
def _trace(before: Cells, columns: int, goal: tuple[int, int]) -> Cells:
    """(n, 2) cells from the start to ``goal``."""
    n, i = 1, goal[0] * columns + goal[1]
    while before[i] >= 0:
        i = before[i]
        n += 1
    path = np.empty((n, 2), dtype=np.int64)
    i = goal[0] * columns + goal[1]
    for k in range(n - 1, -1, -1):
        path[k, 0], path[k, 1] = i // columns, i % columns
        i = before[i]
    return path


class CostToGo:
    """The cheapest paths from one cell to all others of a cost grid (negative = impassable). Raises ValueError for a cell outside it."""

    def __init__(self, cost: Floats, start: Cell) -> None:
        _check_cell("start", start, cost)
        self.cost, self._before = _expand(cost, start, (-1, -1))
        """(rows, columns) cost of the way there [cells], inf where none leads."""

    def to(self, goal: Cell) -> Cells:
        """Path (n, 2) of cells from the start to ``goal``; only for a goal that ``cost`` says can be reached."""
        _check_cell("goal", goal, self.cost)
        return _trace(self._before, self.cost.shape[1], goal)


def astar(cost: Floats, start: Cell, goal: Cell) -> tuple[Cells, float] | None:
    """Path (n, 2) of cells from start to goal and its cost [cells] over a grid (rows, columns) of costs >= 1; None if no path leads there.

    start, goal: (row, column), as ``Costmap.cell`` makes them of metres. A cell outside the grid raises ValueError: most often the
    wrong frame or unit, which None would hide. ``Costmap.holds`` says beforehand whether a cell lies on the map.
    """
    _check_cell("start", start, cost)
    _check_cell("goal", goal, cost)
    if cost[goal] < 0.0:
        return None
    g, before = _expand(cost, start, goal)
    return (_trace(before, cost.shape[1], goal), float(g[goal])) if np.isfinite(g[goal]) else None


def _check_cell(what: str, cell: Cell, cost: Floats) -> None:
    rows, columns = cost.shape
    if not (0 <= cell[0] < rows and 0 <= cell[1] < columns):
        raise ValueError(
            f"{what}: cell (row {cell[0]}, column {cell[1]}) is outside the map of {rows} rows and {columns} columns; "
            "check its frame (map) and unit (m)"
        )
