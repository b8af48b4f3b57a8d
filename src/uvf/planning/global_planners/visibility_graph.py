"""The shortest path among obstacles: A* over the visibility graph of their convex corners.

Lozano-Perez & Wesley, "An algorithm for planning collision-free paths among polyhedral obstacles", CACM 22 (1979). Only tangents count:
a shortest path bends round a corner and nowhere else. Edges are looked for when a corner is expanded, so that no graph is kept.
"""

import time
from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.global_planners.grid_planners import over_points
from uvf.planning.global_planners.lines import is_line_free
from uvf.planning.global_planners.planner import GlobalPath, GlobalPlannerSettings, PathQuery, Refusal
from uvf.planning.global_planners.planning_grid import NO_WAY, PlanningGrid
from uvf.planning.search.open_list import Heap, make_heap, pop, push, with_room

Floats = NDArray[np.float64]
Indices = NDArray[np.int32]
Mask = NDArray[np.bool_]

ASIDE = 1e-4
"""Cells, by which a path keeps off a corner along both axes."""
SLACK = 4.0 * ASIDE
"""Cells, by which a line may seem to cut a corner as corners lie ``ASIDE`` of their place."""
BENT = 1e-2
"""Sine of an angle that is none, for the same reason."""
CHUNK = 16
"""Corners expanded between looks at the clock."""
TOO_LONG = "no way was found in {:g} s over {} corners; one exists: give more seconds"


class CornerGraph(NamedTuple):
    """``points`` (n, 2) x, y [cells]; ``inward`` (n, 2) signs of the direction in which a corner's obstacle lies; ``cost`` (n,) [cells];
    ``parent`` (n,); ``closed`` (n,); ``size`` (1,) entries of the heap. Start and goal come last, in this order, with ``inward`` 0."""

    points: Floats
    inward: Floats
    cost: Floats
    parent: Indices
    closed: Mask
    size: NDArray[np.int64]


def corners(free: Mask) -> tuple[Floats, Floats]:
    """Convex corners of what is not free (rows, columns): points (n, 2) x, y [cells] just off them, and signs (n, 2) towards them."""
    quarters = np.stack([~free[r : r + free.shape[0] - 1, c : c + free.shape[1] - 1] for r in (0, 1) for c in (0, 1)])
    points, inward = [np.empty((0, 2))], [np.empty((0, 2))]
    alone = quarters.sum(axis=0) == 1
    for quarter, (sign_y, sign_x) in enumerate(((-1, -1), (-1, 1), (1, -1), (1, 1))):
        at = np.argwhere(alone & quarters[quarter])[:, ::-1] + 1.0
        points.append(at - np.array((sign_x, sign_y)) * ASIDE)
        inward.append(np.broadcast_to(np.array((sign_x, sign_y), dtype=np.float64), at.shape))
    return np.vstack(points), np.vstack(inward)


@compiled
def _cuts(inward: Floats, i: int, dx: float, dy: float) -> bool:
    """Whether a line (dx, dy) [cells] through corner ``i`` leads into its obstacle, either way."""
    along, across = dx * inward[i, 0], dy * inward[i, 1]
    return bool((along > SLACK and across > SLACK) or (along < -SLACK and across < -SLACK))


@compiled
def _bends_away(graph: CornerGraph, top: int, dx: float, dy: float) -> bool:
    """Whether a path that goes on from ``top`` by (dx, dy) bends away from the corner's obstacle: it could be cut short."""
    before = graph.parent[top]
    if before < 0:
        return False
    fx, fy = graph.points[top, 0] - graph.points[before, 0], graph.points[top, 1] - graph.points[before, 1]
    turn = fx * dy - fy * dx
    side = fx * graph.inward[top, 1] - fy * graph.inward[top, 0]
    return bool(abs(turn) > BENT * hypot(fx, fy) * hypot(dx, dy) and turn * side < 0.0)


@compiled
def expand_corners(distance: Floats, graph: CornerGraph, heap: Heap, most: int) -> tuple[bool, Heap]:
    """Expands up to ``most`` corners; whether the search is over (goal closed or nothing open), and the heap."""
    n = graph.cost.size
    goal = n - 1
    gx, gy = graph.points[goal, 0], graph.points[goal, 1]
    while most > 0:
        if graph.size[0] == 0:
            return True, heap
        top = int(heap.items[0])
        graph.size[0] = pop(heap, graph.size[0])
        if graph.closed[top]:
            continue
        graph.closed[top] = True
        if top == goal:
            return True, heap
        most -= 1
        x, y = graph.points[top, 0], graph.points[top, 1]
        for i in range(n - 1, -1, -1):
            if graph.closed[i]:
                continue
            dx, dy = graph.points[i, 0] - x, graph.points[i, 1] - y
            way = graph.cost[top] + hypot(dx, dy)
            left = hypot(gx - graph.points[i, 0], gy - graph.points[i, 1])
            if way >= graph.cost[i] or way + left >= graph.cost[goal]:
                continue
            if _cuts(graph.inward, top, dx, dy) or _cuts(graph.inward, i, dx, dy) or _bends_away(graph, top, dx, dy):
                continue
            if not is_line_free(distance, (x, y), (graph.points[i, 0], graph.points[i, 1])):
                continue
            graph.cost[i], graph.parent[i] = way, top
            heap = with_room(heap, graph.size[0], 1)
            graph.size[0] = push(heap, graph.size[0], way + left, i)
    return False, heap


class VisibilityGraphPlanner:
    """Shortest paths, which touch obstacles' corners but for a hair; costs below the impassable do not count."""

    def __init__(self, costs: Costmap, settings: GlobalPlannerSettings) -> None:
        """Raises ValueError for a costmap without cells."""
        self._grid = PlanningGrid(costs, settings)
        self._points, self._inward = corners(self._grid.free)

    def plan(self, query: PathQuery) -> GlobalPath:
        """The shortest path from start to goal."""
        until = time.perf_counter() + query.seconds
        ends = self._grid.ends(query)
        if isinstance(ends, GlobalPath):
            return ends
        parts = self._grid.parts
        inside = self._points.astype(np.int64)
        near = np.flatnonzero(parts[inside[:, 1], inside[:, 0]] == parts[self._grid.cell(ends[0])])
        graph = _graph(self._points[near], self._inward[near], [self._grid.in_cells(end) for end in ends])
        heap = make_heap()
        graph.size[0] = push(heap, 0, hypot(*(graph.points[-1] - graph.points[-2])), len(graph.cost) - 2)
        over = False
        while not over:
            if time.perf_counter() > until:
                return GlobalPath(None, Refusal.TIMED_OUT, TOO_LONG.format(query.seconds, len(near)))
            over, heap = expand_corners(self._grid.distance, graph, heap, CHUNK)
        if not graph.closed[-1]:
            return GlobalPath(None, Refusal.NO_VALID_PATH, NO_WAY)
        way, i = [], int(graph.parent[-1])
        while graph.parent[i] >= 0:
            way.append(i)
            i = int(graph.parent[i])
        return over_points(self._grid, ends, graph.points[way[::-1]])


def _graph(points: Floats, inward: Floats, ends: list[tuple[float, float]]) -> CornerGraph:
    n = len(points) + 2
    cost = np.full(n, np.inf)
    cost[-2] = 0.0
    return CornerGraph(
        np.ascontiguousarray(np.vstack((points, ends))),
        np.ascontiguousarray(np.vstack((inward, np.zeros((2, 2))))),
        cost,
        np.full(n, -1, dtype=np.int32),
        np.zeros(n, dtype=np.bool_),
        np.zeros(1, dtype=np.int64),
    )
