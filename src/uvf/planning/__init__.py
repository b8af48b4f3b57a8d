"""Planning for ground vehicles on occupancy grids: costmaps, search, smoothing, path tracking, collision checks, exploration."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.planning.costmap.costmap import Costmap as Costmap
    from uvf.planning.costmap.costmap import make_costmap as make_costmap
    from uvf.planning.costmap.footprint import RobotFootprint as RobotFootprint
    from uvf.planning.costmap.inflation import Inflation as Inflation
    from uvf.planning.costmap.inflation import cost_factors as cost_factors
    from uvf.planning.exploration import Explorer as Explorer
    from uvf.planning.global_planner import GlobalPlanner as GlobalPlanner
    from uvf.planning.global_planner import PlannedBody as PlannedBody
    from uvf.planning.global_planners.planner import GlobalPlannerSettings as GlobalPlannerSettings
    from uvf.planning.global_planners.planner import PathQuery as PathQuery
    from uvf.planning.global_planners.planners import make_global_planner as make_global_planner
    from uvf.planning.search.grid_search import GridSearch as GridSearch

OFFERED = {
    "GridSearch": "uvf.planning.search.grid_search:GridSearch",
    "make_costmap": "uvf.planning.costmap.costmap:make_costmap",
    "Costmap": "uvf.planning.costmap.costmap:Costmap",
    "cost_factors": "uvf.planning.costmap.inflation:cost_factors",
    "Inflation": "uvf.planning.costmap.inflation:Inflation",
    "RobotFootprint": "uvf.planning.costmap.footprint:RobotFootprint",
    "GlobalPlanner": "uvf.planning.global_planner:GlobalPlanner",
    "PlannedBody": "uvf.planning.global_planner:PlannedBody",
    "make_global_planner": "uvf.planning.global_planners.planners:make_global_planner",
    "PathQuery": "uvf.planning.global_planners.planner:PathQuery",
    "GlobalPlannerSettings": "uvf.planning.global_planners.planner:GlobalPlannerSettings",
    "Explorer": "uvf.planning.exploration:Explorer",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
