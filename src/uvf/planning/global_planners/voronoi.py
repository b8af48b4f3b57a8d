"""Paths as far from obstacles as can be: over the generalised Voronoi diagram of the map.

O'Dunlaing & Yap, "A retraction method for planning the motion of a disc", Journal of Algorithms 6 (1985).
"""

from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from uvf.maths.compiled import compiled
from uvf.planning.costmap.costmap import Cell, Costmap
from uvf.planning.costmap.inflation import LETHAL
from uvf.planning.global_planners.grid_planners import over_cells
from uvf.planning.global_planners.planner import GlobalPath, GlobalPlannerSettings, PathQuery, Refusal
from uvf.planning.global_planners.planning_grid import NO_WAY, PlanningGrid
from uvf.planning.global_planners.thinning import skeleton
from uvf.planning.search.grid_search import GridSearch

Cells = NDArray[np.int64]
Mask = NDArray[np.bool_]

AROUND = ((0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))


class VoronoiPlanner:
    """From the start to the nearest place on the diagram, over the diagram by A*, and from there to the goal."""

    def __init__(self, costs: Costmap, settings: GlobalPlannerSettings) -> None:
        """Raises ValueError for a costmap without cells."""
        self._grid = PlanningGrid(costs, settings)

    @cached_property
    def diagram(self) -> Mask:
        """(rows, columns) cells of the diagram."""
        return skeleton(self._grid.free)

    def plan(self, query: PathQuery) -> GlobalPath:
        """The path from start to goal; straight there where the goal is nearer than the diagram."""
        ends = self._grid.ends(query)
        if isinstance(ends, GlobalPath):
            return ends
        start, goal = (self._grid.cell(end) for end in ends)
        wanted = self.diagram.copy()
        for end, other in ((start, goal), (goal, start)):
            way = way_onto(self._grid.free, self.diagram, end, other)
            wanted[way[:, 0], way[:, 1]] = True
        # A cell to either side, so that steps along a diagonal line need not follow its stairs.
        wanted = ndimage.binary_dilation(wanted) & self._grid.free
        found = GridSearch(np.where(wanted, self._grid.costs.values, LETHAL).astype(np.uint8), self._grid.factors).astar(start, goal)
        if found is None:
            return GlobalPath(None, Refusal.NO_VALID_PATH, NO_WAY)
        return over_cells(self._grid, ends, found.cells)


@compiled
def way_onto(free: Mask, wanted: Mask, start: Cell, other: Cell) -> Cells:
    """Cells (n, 2) from the nearest one that is wanted, or is ``other``, back to ``start``; by breadth, with eight neighbours.

    (0, 2) where there is none.
    """
    rows, columns = free.shape
    parent = np.full(free.size, -1, dtype=np.int32)
    queue = np.empty(free.size, dtype=np.int32)
    queue[0] = start[0] * columns + start[1]
    parent[queue[0]] = queue[0]
    done, count, last = 0, 1, -1
    while done < count and last < 0:
        row, column = queue[done] // columns, queue[done] % columns
        if wanted[row, column] or (row == other[0] and column == other[1]):
            last = queue[done]
        for dr, dc in AROUND:
            r, c = row + dr, column + dc
            if not (0 <= r < rows and 0 <= c < columns) or not (free[r, c] and free[row, c] and free[r, column]):
                continue
            if parent[r * columns + c] < 0:
                parent[r * columns + c] = queue[done]
                queue[count] = r * columns + c
                count += 1
        done += 1
    n = 0
    while last >= 0:
        queue[n] = last
        n += 1
        last = parent[last] if parent[last] != last else -1
    way = np.empty((n, 2), dtype=np.int64)
    for k in range(n):
        way[k, 0], way[k, 1] = queue[k] // columns, queue[k] % columns
    return way
