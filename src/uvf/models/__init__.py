"""Vehicles, worlds and missions as data: their files, geometry, checks and import from other simulators."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.models.mission.file import load_mission as load_mission
    from uvf.models.scenario import load_scenario as load_scenario
    from uvf.models.vehicle.file import load_vehicle as load_vehicle
    from uvf.models.vehicle.flight_params import AirParams as AirParams
    from uvf.models.world.file import load_world as load_world
    from uvf.models.world.map_file import GridMap as GridMap
    from uvf.models.world.map_file import load_map as load_map
    from uvf.models.yaml_data import BadInput as BadInput

OFFERED = {
    "load_vehicle": "uvf.models.vehicle.file:load_vehicle",
    "load_world": "uvf.models.world.file:load_world",
    "load_mission": "uvf.models.mission.file:load_mission",
    "load_scenario": "uvf.models.scenario:load_scenario",
    "load_map": "uvf.models.world.map_file:load_map",
    "GridMap": "uvf.models.world.map_file:GridMap",
    "BadInput": "uvf.models.yaml_data:BadInput",
    "AirParams": "uvf.models.vehicle.flight_params:AirParams",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
