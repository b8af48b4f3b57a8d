"""The global planners by their names."""

from collections.abc import Callable
from functools import partial

from uvf.models.yaml_data import nearest
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.global_planners.bug import BugMethod, BugPlanner
from uvf.planning.global_planners.grid_planners import GridMethod, GridPlanner
from uvf.planning.global_planners.hybrid_planner import HybridPlanner
from uvf.planning.global_planners.planner import GlobalPathPlanner, GlobalPlannerSettings
from uvf.planning.global_planners.potential_field import PotentialFieldPlanner
from uvf.planning.global_planners.sampling_planners import RoadmapPlanner, TreeMethod, TreePlanner
from uvf.planning.global_planners.visibility_graph import VisibilityGraphPlanner
from uvf.planning.global_planners.voronoi import VoronoiPlanner

GlobalPlannerMaker = Callable[[Costmap, GlobalPlannerSettings], GlobalPathPlanner]

PLANNERS: dict[str, GlobalPlannerMaker] = {
    "astar": partial(GridPlanner, method=GridMethod.ASTAR),
    "dijkstra": partial(GridPlanner, method=GridMethod.DIJKSTRA),
    "jump_points": partial(GridPlanner, method=GridMethod.JUMP_POINTS),
    "theta_star": partial(GridPlanner, method=GridMethod.THETA_STAR),
    "hybrid_astar_dubins": partial(HybridPlanner, reverses=False),
    "hybrid_astar_reeds_shepp": partial(HybridPlanner, reverses=True),
    "rrt": partial(TreePlanner, method=TreeMethod.RRT),
    "rrt_star": partial(TreePlanner, method=TreeMethod.RRT_STAR),
    "rrt_connect": partial(TreePlanner, method=TreeMethod.RRT_CONNECT),
    "prm": RoadmapPlanner,
    "visibility_graph": VisibilityGraphPlanner,
    "voronoi": VoronoiPlanner,
    "potential_field": PotentialFieldPlanner,
    "bug1": partial(BugPlanner, method=BugMethod.BUG1),
    "bug2": partial(BugPlanner, method=BugMethod.BUG2),
}
"""Makers from a costmap and settings; the first one is the default."""


def make_global_planner(name: str, costs: Costmap, settings: GlobalPlannerSettings | None = None) -> GlobalPathPlanner:
    """The global planner of a name, on one costmap. Raises ValueError for an unknown name, and a costmap without cells."""
    if name not in PLANNERS:
        raise ValueError(f"global planner: there is no '{name}'; {nearest(name, PLANNERS)}")
    return PLANNERS[name](costs, settings or GlobalPlannerSettings())
