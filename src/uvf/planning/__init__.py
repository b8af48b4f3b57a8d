"""Planning for ground vehicles on occupancy grids: costmaps, search, smoothing, path tracking, collision checks, exploration."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.planning.costmap import Costmap as Costmap
    from uvf.planning.costmap import RobotFootprint as RobotFootprint
    from uvf.planning.costmap import make_costmap as make_costmap
    from uvf.planning.exploration import Explorer as Explorer
    from uvf.planning.navigator import GlobalPlanner as GlobalPlanner
    from uvf.planning.pure_pursuit import PathTracker as PathTracker
    from uvf.planning.search import CostToGo as CostToGo
    from uvf.planning.search import astar as astar

OFFERED = {
    "astar": "uvf.planning.search:astar",
    "CostToGo": "uvf.planning.search:CostToGo",
    "make_costmap": "uvf.planning.costmap:make_costmap",
    "Costmap": "uvf.planning.costmap:Costmap",
    "RobotFootprint": "uvf.planning.costmap:RobotFootprint",
    "GlobalPlanner": "uvf.planning.navigator:GlobalPlanner",
    "PathTracker": "uvf.planning.pure_pursuit:PathTracker",
    "Explorer": "uvf.planning.exploration:Explorer",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
