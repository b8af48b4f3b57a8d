"""Hybrid-A* as a global planner: ends that touch obstacles are moved where the query allows it, refusals get their kind."""

import numpy as np

from uvf.maths.curves.segments import Triple
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.costmap.headings import heading_bin
from uvf.planning.global_planners.planner import GlobalPath, GlobalPlannerSettings, PathQuery, Refusal
from uvf.planning.global_planners.planning_grid import PlanningGrid
from uvf.planning.search.hybrid_astar import GIVEN_UP, TOUCHES, HybridAStar
from uvf.planning.search.motion_primitives import SteeredVehicle


class HybridPlanner:
    """Paths that a vehicle with a turning radius can drive, its whole outline free on the way."""

    def __init__(self, costs: Costmap, settings: GlobalPlannerSettings, reverses: bool) -> None:
        """``reverses``: curves of Reeds and Shepp, else of Dubins. Raises ValueError for a costmap without cells, or with too many."""
        self._grid = PlanningGrid(costs, settings)
        self._search = HybridAStar(costs, self._grid.factors, SteeredVehicle(settings.minimum_turning_radius, reverses))

    def plan(self, query: PathQuery) -> GlobalPath:
        """The path from start to goal; it ends within the goal's cell and 1/64 of a turn where no curve leads to it exactly."""
        ends = self._grid.ends(query)
        if isinstance(ends, GlobalPath):
            return ends
        start, goal = ends
        found = self._search.plan(start, goal)
        if found.reason == TOUCHES.format("start"):
            start = self._moved(start, query.start, query.tolerance)
            found = self._search.plan(start, goal)
        if found.reason == TOUCHES.format("goal"):
            found = self._search.plan(start, self._moved(goal, query.goal, query.tolerance))
        if found.path is None:
            kinds = {
                GIVEN_UP: Refusal.TIMED_OUT,
                TOUCHES.format("start"): Refusal.START_OCCUPIED,
                TOUCHES.format("goal"): Refusal.GOAL_OCCUPIED,
            }
            return GlobalPath(None, kinds.get(found.reason, Refusal.NO_VALID_PATH), found.reason)
        return GlobalPath(found.path)

    def _moved(self, end: Triple, asked: Triple, within: float) -> Triple:
        """The nearest place to ``asked`` where the outline is free in its heading, within so many metres; else ``end`` as it is."""
        shut = (self._grid.costs.blocked >> np.uint64(heading_bin(end[2]))) & np.uint64(1)
        free = (self._grid.parts == self._grid.parts[self._grid.cell(end)]) & (shut == 0)
        return (self._grid.nearest(free, asked, within) if within > 0.0 else None) or end
