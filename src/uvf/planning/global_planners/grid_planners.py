"""Dijkstra, A*, jump points and Theta* as global planners: from cell to cell, then from the very start to the very goal."""

from enum import Enum

import numpy as np
from numpy.typing import NDArray

from uvf.planning.costmap.costmap import Costmap
from uvf.planning.global_planners.lines import is_line_free
from uvf.planning.global_planners.planner import GlobalPath, GlobalPlannerSettings, PathQuery, Refusal
from uvf.planning.global_planners.planning_grid import NO_WAY, Ends, PlanningGrid, poses_along
from uvf.planning.search.grid_search import GridPath, GridSearch

Floats = NDArray[np.float64]


class GridMethod(Enum):
    """How a grid is searched."""

    DIJKSTRA = "dijkstra"
    ASTAR = "astar"
    JUMP_POINTS = "jump_points"
    THETA_STAR = "theta_star"


class GridPlanner:
    """The cheapest path over eight neighbours, or any-angle; jump points count every passable cell alike."""

    def __init__(self, costs: Costmap, settings: GlobalPlannerSettings, method: GridMethod) -> None:
        """Raises ValueError for a costmap without cells."""
        self._grid, self._method = PlanningGrid(costs, settings), method
        self._search = GridSearch(costs.values, self._grid.factors)

    def plan(self, query: PathQuery) -> GlobalPath:
        """The path from start to goal."""
        ends = self._grid.ends(query)
        if isinstance(ends, GlobalPath):
            return ends
        found = self._found(ends)
        if found is None:
            return GlobalPath(None, Refusal.NO_VALID_PATH, NO_WAY)
        return over_cells(self._grid, ends, found.cells)

    def _found(self, ends: Ends) -> GridPath | None:
        start, goal = (self._grid.cell(end) for end in ends)
        if self._method is GridMethod.DIJKSTRA:
            return self._search.dijkstra(start, goal)
        if self._method is GridMethod.ASTAR:
            return self._search.astar(start, goal)
        if self._method is GridMethod.JUMP_POINTS:
            return self._search.jump_points(start, goal)
        return self._search.theta_star(start, goal)


def over_cells(grid: PlanningGrid, ends: Ends, cells: NDArray[np.int64]) -> GlobalPath:
    """The path over the centres of cells (n, 2), from the very start to the very goal.

    The centre of the first and of the last cell is left out where the line from the end to the next one is free.
    """
    start, goal = (grid.in_cells(end) for end in ends)
    centres = grid.centres(cells)
    middle = list[tuple[float, float]]()
    if len(centres) > 1:
        middle = [(float(x), float(y)) for x, y in centres]
        if is_line_free(grid.distance, start, middle[1]):
            middle.pop(0)
        if is_line_free(grid.distance, middle[-2] if len(middle) > 1 else start, goal):
            middle.pop()
    return over_points(grid, ends, np.array(middle).reshape(-1, 2))


def over_points(grid: PlanningGrid, ends: Ends, middle: Floats) -> GlobalPath:
    """The path of straight lines from the start over points (n, 2) x, y [cells] to the goal."""
    points = np.vstack((ends[0][:2], grid.in_metres(middle), ends[1][:2]))
    return GlobalPath(poses_along(points, ends[1][2], grid.costs.resolution))
