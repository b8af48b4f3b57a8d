"""Ways for aircraft past obstacles and within fences: RRT and RRT* with Dubins curves that climb, loiter patterns, missions."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.planning.flight.airspace import Airspace as Airspace
    from uvf.planning.flight.airspace import Prism as Prism
    from uvf.planning.flight.airspace import box as box
    from uvf.planning.flight.airspace import cylinder as cylinder
    from uvf.planning.flight.loiter import LoiterPattern as LoiterPattern
    from uvf.planning.flight.loiter import plan_loiter as plan_loiter
    from uvf.planning.flight.mission import FlownTurns as FlownTurns
    from uvf.planning.flight.mission import flight_items as flight_items
    from uvf.planning.flight.planner import DubinsAirplanePath as DubinsAirplanePath
    from uvf.planning.flight.planner import FlightLimits as FlightLimits
    from uvf.planning.flight.planner import rrt_flight as rrt_flight
    from uvf.planning.flight.planner import rrt_star_flight as rrt_star_flight

OFFERED = {
    "Airspace": "uvf.planning.flight.airspace:Airspace",
    "Prism": "uvf.planning.flight.airspace:Prism",
    "box": "uvf.planning.flight.airspace:box",
    "cylinder": "uvf.planning.flight.airspace:cylinder",
    "LoiterPattern": "uvf.planning.flight.loiter:LoiterPattern",
    "plan_loiter": "uvf.planning.flight.loiter:plan_loiter",
    "FlownTurns": "uvf.planning.flight.mission:FlownTurns",
    "flight_items": "uvf.planning.flight.mission:flight_items",
    "FlightLimits": "uvf.planning.flight.planner:FlightLimits",
    "DubinsAirplanePath": "uvf.planning.flight.planner:DubinsAirplanePath",
    "rrt_flight": "uvf.planning.flight.planner:rrt_flight",
    "rrt_star_flight": "uvf.planning.flight.planner:rrt_star_flight",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
