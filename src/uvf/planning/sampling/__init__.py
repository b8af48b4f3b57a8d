"""Sampling planners for points, cars and what only drives forwards: RRT, RRT*, RRT-Connect, PRM and PRM* over a field of clearances."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.planning.sampling.clearance import clearance_field as clearance_field
    from uvf.planning.sampling.clearance import disc as disc
    from uvf.planning.sampling.clearance import discs as discs
    from uvf.planning.sampling.clearance import rectangle as rectangle
    from uvf.planning.sampling.planners import rrt as rrt
    from uvf.planning.sampling.planners import rrt_connect as rrt_connect
    from uvf.planning.sampling.planners import rrt_star as rrt_star
    from uvf.planning.sampling.problem import Budget as Budget
    from uvf.planning.sampling.problem import Ground as Ground
    from uvf.planning.sampling.roadmap import Roadmap as Roadmap
    from uvf.planning.sampling.shortening import shortened as shortened
    from uvf.planning.sampling.spaces import dubins as dubins
    from uvf.planning.sampling.spaces import plane as plane
    from uvf.planning.sampling.spaces import reeds_shepp as reeds_shepp

OFFERED = {
    "clearance_field": "uvf.planning.sampling.clearance:clearance_field",
    "disc": "uvf.planning.sampling.clearance:disc",
    "discs": "uvf.planning.sampling.clearance:discs",
    "rectangle": "uvf.planning.sampling.clearance:rectangle",
    "Ground": "uvf.planning.sampling.problem:Ground",
    "Budget": "uvf.planning.sampling.problem:Budget",
    "plane": "uvf.planning.sampling.spaces:plane",
    "dubins": "uvf.planning.sampling.spaces:dubins",
    "reeds_shepp": "uvf.planning.sampling.spaces:reeds_shepp",
    "rrt": "uvf.planning.sampling.planners:rrt",
    "rrt_star": "uvf.planning.sampling.planners:rrt_star",
    "rrt_connect": "uvf.planning.sampling.planners:rrt_connect",
    "Roadmap": "uvf.planning.sampling.roadmap:Roadmap",
    "shortened": "uvf.planning.sampling.shortening:shortened",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
