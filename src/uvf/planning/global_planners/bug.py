"""Bug 1 and Bug 2: straight for the goal, and round each obstacle in the way, with no map but what is beside the vehicle.

Lumelsky & Stepanov, "Path-planning strategies for a point mobile automaton moving amidst unknown obstacles of arbitrary shape",
Algorithmica 2 (1987). Here on cells, with four directions; both come to the goal wherever it can be come to, and end where it cannot.
"""

from enum import Enum

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.costmap.costmap import Cell, Costmap
from uvf.planning.global_planners.boundary import Side, direction_of, is_free, next_side, straight, with_cell
from uvf.planning.global_planners.grid_planners import over_points
from uvf.planning.global_planners.planner import GlobalPath, GlobalPlannerSettings, PathQuery, Refusal
from uvf.planning.global_planners.planning_grid import PlanningGrid

Cells = NDArray[np.int64]
Mask = NDArray[np.bool_]

ROOM = 4096  # cells at first
SHUT = "no way leads to the goal: following the obstacle's boundary led back to where it was met"


class BugMethod(Enum):
    """When an obstacle is left."""

    BUG1 = "bug1"
    BUG2 = "bug2"


@compiled
def bug1(free: Mask, start: Cell, goal: Cell) -> tuple[Cells, bool]:
    """The cells (n, 2) that Bug 1 visits, and whether the last one is the goal.

    Each obstacle is gone round once, then left where it was nearest to the goal; the goal is shut in if the line from there is blocked by
    the same boundary. (No part of that boundary lies nearer, and between it and the goal there would have to be one.)
    """
    cells, n = np.empty((ROOM, 2), dtype=np.int64), 0
    cells, n = with_cell(cells, n, start[0], start[1])
    row, column = start
    while True:
        line = straight((row, column), goal)
        met = -1
        for k in range(1, line.shape[0]):
            if not is_free(free, line[k, 0], line[k, 1]):
                met = k
                break
            row, column = int(line[k, 0]), int(line[k, 1])
            cells, n = with_cell(cells, n, row, column)
        if met < 0:
            return cells[:n], True
        side = (row, column, direction_of(int(line[met, 0]) - row, int(line[met, 1]) - column))
        cells, n, leave, same = _round(free, side, goal, (cells, n))
        row, column = leave
        if row == goal[0] and column == goal[1]:
            return cells[:n], True
        if same:
            return cells[:n], False


@compiled
def _round(free: Mask, met: Side, goal: Cell, visited: tuple[Cells, int]) -> tuple[Cells, int, Cell, bool]:
    """Follows a boundary from side ``met`` once round and on to its nearest cell to the goal, by the shorter way.

    The cells visited and their count, that cell, and whether the line from there to the goal is blocked by this boundary.
    """
    cells, n = visited
    first = n - 1
    best, near, leave = (met[0] - goal[0]) ** 2 + (met[1] - goal[1]) ** 2, first, (met[0], met[1])
    side = met
    while True:
        side, passed_row, passed_column = next_side(free, side)
        if passed_row >= 0:
            cells, n = with_cell(cells, n, passed_row, passed_column)
        cells, n = with_cell(cells, n, side[0], side[1])
        if side[0] == goal[0] and side[1] == goal[1]:
            return cells, n, goal, False
        away = (side[0] - goal[0]) ** 2 + (side[1] - goal[1]) ** 2
        if away < best:
            best, near, leave = away, n - 1, (side[0], side[1])
        if side == met:
            break
    last = n - 1
    if near - first <= last - near:
        for k in range(first + 1, near + 1):
            cells, n = with_cell(cells, n, int(cells[k, 0]), int(cells[k, 1]))
    else:
        for k in range(last - 1, near - 1, -1):
            cells, n = with_cell(cells, n, int(cells[k, 0]), int(cells[k, 1]))
    return cells, n, leave, _is_blocked(free, met, leave, goal)


@compiled
def _is_blocked(free: Mask, met: Side, leave: Cell, goal: Cell) -> bool:
    """Whether the line from ``leave`` to the goal begins with a side of the boundary that ``met`` is of."""
    line = straight(leave, goal)
    if is_free(free, line[1, 0], line[1, 1]):
        return False
    wanted = direction_of(int(line[1, 0]) - leave[0], int(line[1, 1]) - leave[1])
    side = met
    while True:
        if side[0] == leave[0] and side[1] == leave[1] and side[2] == wanted:
            return True
        side, _, _ = next_side(free, side)
        if side == met:
            return False


@compiled
def bug2(free: Mask, start: Cell, goal: Cell) -> tuple[Cells, bool]:
    """The cells (n, 2) that Bug 2 visits, and whether the last one is the goal.

    An obstacle is left where its boundary meets the line from start to goal nearer to the goal than before; the goal is shut in if the
    boundary leads back to where it was met. (Where the goal is not shut in, the line leaves the obstacle farther on, by this boundary.)
    """
    line = straight(start, goal)
    on_line = np.full(free.shape, -1, dtype=np.int64)
    for k in range(line.shape[0]):
        on_line[line[k, 0], line[k, 1]] = k
    cells, n, at = np.empty((ROOM, 2), dtype=np.int64), 0, 0
    cells, n = with_cell(cells, n, start[0], start[1])
    while at < line.shape[0] - 1:
        row, column = int(line[at, 0]), int(line[at, 1])
        if is_free(free, line[at + 1, 0], line[at + 1, 1]):
            at += 1
            cells, n = with_cell(cells, n, int(line[at, 0]), int(line[at, 1]))
            continue
        met = (row, column, direction_of(int(line[at + 1, 0]) - row, int(line[at + 1, 1]) - column))
        side, found = met, -1
        while found < 0:
            side, passed_row, passed_column = next_side(free, side)
            if passed_row >= 0:
                cells, n = with_cell(cells, n, passed_row, passed_column)
                if on_line[passed_row, passed_column] > at:
                    found = on_line[passed_row, passed_column]
                    break
            cells, n = with_cell(cells, n, side[0], side[1])
            if on_line[side[0], side[1]] > at:
                found = on_line[side[0], side[1]]
            elif side == met:
                return cells[:n], False
        at = found
    return cells[:n], True


class BugPlanner:
    """The way that a vehicle without a map would go: long, but sure."""

    def __init__(self, costs: Costmap, settings: GlobalPlannerSettings, method: BugMethod) -> None:
        """Raises ValueError for a costmap without cells."""
        self._grid, self._method = PlanningGrid(costs, settings), method

    def plan(self, query: PathQuery) -> GlobalPath:
        """The way from start to goal with all its detours; whether the goal can be reached it finds out by itself."""
        ends = self._grid.ends(query, joined=False)
        if isinstance(ends, GlobalPath):
            return ends
        walk = bug1 if self._method is BugMethod.BUG1 else bug2
        cells, reached = walk(self._grid.free, self._grid.cell(ends[0]), self._grid.cell(ends[1]))
        if not reached:
            return GlobalPath(None, Refusal.NO_VALID_PATH, SHUT)
        return over_points(self._grid, ends, self._grid.centres(cells[1:-1]))
