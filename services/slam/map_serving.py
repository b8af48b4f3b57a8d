"""What each ground vehicle's map server serves, and from which files: what the mission says under ``maps:``."""

from collections.abc import Iterator
from pathlib import Path

from services.slam.map_server import MapServer
from uvf.maths.se2 import Pose2, compose
from uvf.models.mission.file import Maps
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.world.map_file import GridMap, load_map, save_map
from uvf.models.yaml_data import BadInput, FileLocation
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.state.saved_maps import find_map, known_path, map_path
from uvf.slam.localization.known_map import is_session, known_map
from uvf.slam.maps.masks import KeepOut, SpeedLimit


def map_servers(site: Scenario) -> list[ServiceInstance]:
    """One map server for each ground vehicle; without ``maps:`` it has no layers, but saves the map that the vehicle draws.

    Raises BadInput for a file that is no map, or maps for an aircraft.
    """
    place = FileLocation(str(site.mission_path)).at("vehicles")
    for member in site.of_kind("fixed_wing"):
        if member.entry.maps is not None:
            raise BadInput(f"{place.at(member.name, 'maps')}: an aircraft does not drive by maps; leave it out")
    return [_host(member, member.entry.maps or Maps(), site.mission_path.parent) for member in site.of_kind("ground")]


def _host(member: MissionVehicle, maps: Maps, folder: Path) -> ServiceInstance:
    assert member.file.ground is not None
    layers = dict(_layers(maps, folder, member.file.ground.max_linear))
    return ServiceInstance(MapServer, lambda: MapServer(layers, _save), member.name)


def _layers(maps: Maps, folder: Path, full_speed: float) -> Iterator[tuple[str, GridMap]]:
    if maps.known is not None:
        path = known_path(maps.known, folder)
        yield "known", known_map(path, Pose2(*maps.known_at)).grid if is_session(path) else _placed(maps, path)
    if maps.keepout is not None:
        yield "keepout", KeepOut(find_map(maps.keepout, folder)).layer()
    if maps.speed is not None:
        mask = find_map(maps.speed, folder)
        yield "speed", SpeedLimit(mask, maps.speed_unit, maps.speed_base, maps.speed_multiplier).layer(full_speed)


def _placed(maps: Maps, path: Path) -> GridMap:
    grid = load_map(path)
    return GridMap(grid.cells, grid.resolution, compose(Pose2(*maps.known_at), grid.origin))


def _save(grid: GridMap, name: str, mode: str) -> Path:
    return save_map(grid, map_path(name), mode)
