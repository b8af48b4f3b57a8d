"""RRT, RRT*, RRT-Connect and PRM as global planners of the vehicle's centre, over the same impassable cells as all others."""

from enum import Enum
from functools import lru_cache

import numpy as np

from uvf.planning.costmap.costmap import Costmap
from uvf.planning.global_planners.planner import GlobalPath, GlobalPlannerSettings, PathQuery, Refusal
from uvf.planning.global_planners.planning_grid import Ends, PlanningGrid, poses_along
from uvf.planning.sampling.clearance import ClearanceField, clearance_field, disc
from uvf.planning.sampling.planners import rrt, rrt_connect, rrt_star
from uvf.planning.sampling.problem import Budget, Ground, SamplingPlan
from uvf.planning.sampling.roadmap import Roadmap
from uvf.planning.sampling.shortening import shortened
from uvf.planning.sampling.spaces import plane

ITERATIONS = 50_000
"""Of RRT and RRT-Connect, which end with the first path."""
STAR_ITERATIONS = 5_000
"""Of RRT*, which makes use of all."""
NODES = 3_000
"""Of a roadmap."""
CUTS = 200
"""Tries to cut a path short."""


class TreeMethod(Enum):
    """Which tree grows."""

    RRT = "rrt"
    RRT_STAR = "rrt_star"
    RRT_CONNECT = "rrt_connect"


def ground_of(grid: PlanningGrid) -> Ground:
    """Where the vehicle's centre may be, as a field of clearances for a body without extent."""
    resolution, (x, y) = grid.costs.resolution, grid.costs.origin
    values = ((grid.distance - 0.5) * resolution).astype(np.float32)
    return Ground(ClearanceField(values, resolution, x, y), disc(0.0))


GROW = {TreeMethod.RRT: rrt, TreeMethod.RRT_STAR: rrt_star, TreeMethod.RRT_CONNECT: rrt_connect}


@lru_cache(maxsize=len(TreeMethod))
def _compile(method: TreeMethod) -> None:
    """Answers a small query once, so that compiling takes nothing of the time of the first real one."""
    ground = Ground(clearance_field(np.zeros((8, 8), dtype=np.bool_), 1.0), disc(0.0))
    found = GROW[method](ground, plane(), ((0.5, 0.5, 0.0), (7.5, 7.5, 0.0)), Budget(20), 0)
    if found.path is not None:
        shortened(ground, plane(), found.path, 1, 0)


class TreePlanner:
    """The way that a random tree finds, cut short; RRT's as it was found."""

    def __init__(self, costs: Costmap, settings: GlobalPlannerSettings, method: TreeMethod) -> None:
        """Raises ValueError for a costmap without cells."""
        self._grid, self._method = PlanningGrid(costs, settings), method
        self._ground = ground_of(self._grid)
        _compile(method)

    def plan(self, query: PathQuery) -> GlobalPath:
        """The path from start to goal."""
        ends = self._grid.ends(query)
        if isinstance(ends, GlobalPath):
            return ends
        iterations = STAR_ITERATIONS if self._method is TreeMethod.RRT_STAR else ITERATIONS
        found = GROW[self._method](self._ground, plane(), ends, Budget(iterations, query.seconds), query.seed)
        return answer(self._grid, self._ground, ends, found, 0 if self._method is TreeMethod.RRT else CUTS, query.seed)


class RoadmapPlanner:
    """PRM*: the shortest way over a roadmap, which is made at the first query of a seed and kept; it is then cut short."""

    def __init__(self, costs: Costmap, settings: GlobalPlannerSettings) -> None:
        """Raises ValueError for a costmap without cells."""
        self._grid = PlanningGrid(costs, settings)
        self._ground = ground_of(self._grid)
        self._roadmap: tuple[int, Roadmap] | None = None

    def plan(self, query: PathQuery) -> GlobalPath:
        """The path from start to goal; making the roadmap is not ended when time runs out."""
        ends = self._grid.ends(query)
        if isinstance(ends, GlobalPath):
            return ends
        if self._roadmap is None or self._roadmap[0] != query.seed:
            self._roadmap = query.seed, Roadmap(self._ground, plane(), NODES, query.seed)
        return answer(self._grid, self._ground, ends, self._roadmap[1].plan(*ends), CUTS, query.seed)


def answer(grid: PlanningGrid, ground: Ground, ends: Ends, found: SamplingPlan, cuts: int, seed: int) -> GlobalPath:
    """What a sampling planner has found, after so many tries to cut it short."""
    if found.path is None:
        return GlobalPath(None, Refusal.TIMED_OUT, found.reason)
    path = shortened(ground, plane(), found.path, cuts, seed)
    corners = np.vstack((ends[0][:2], path.pieces[:, :2], ends[1][:2]))
    return GlobalPath(poses_along(corners, ends[1][2], grid.costs.resolution))
