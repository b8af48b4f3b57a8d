"""Odometry and mapping for every ground vehicle of the mission, and the maps that it is given."""

from collections.abc import Callable, Sequence
from functools import partial

from services.slam.localization_service import LocalizationService, LocalizationStart
from services.slam.map_serving import map_servers
from services.slam.mapping_service import MappingParams, MappingService
from services.slam.odometry.service import OdometryService
from services.slam.warm_up import warm_up, warm_up_localization
from uvf.estimation.odometry.params import OdometryParams
from uvf.maths.geodesy import LocalTangent
from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.models.mission.file import Maps
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.vehicle.sensors import Lidar
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.state.saved_maps import known_path
from uvf.slam.localization import known_map
from uvf.slam.localization.params import FilterParams
from uvf.slam.maps.session import MappingSession
from uvf.slam.maps.tiles import TileMap
from uvf.slam.method import SlamMethod
from uvf.slam.methods import METHODS, make_method
from uvf.slam.resumable import Resumable


def build(site: Scenario) -> list[ServiceInstance]:
    """The odometry, the mapping or localization, and the map server of the ground vehicles.

    Raises BadInput for a vehicle without lidar or wheel encoders, and for files that are no maps.
    """
    warm: set[str] = set()
    hosts = [host for member in site.of_kind("ground") for host in _hosts(site, member, warm)]
    return hosts + map_servers(site)


def _hosts(site: Scenario, member: MissionVehicle, warm: set[str]) -> list[ServiceInstance]:
    """warm: names of what has been compiled: methods, and localization."""
    sensors = member.file.sensors
    lidar = sensors.lidar
    if lidar is None or sensors.encoders is None:
        path, missing = member.folder / "vehicle.yaml", "lidar" if lidar is None else "encoders"
        raise BadInput(f"{path}: sensors: no {missing}: SLAM needs lidar and encoders; 'uvf vehicle check {member.entry.model}' shows how")
    world_from_map = _world_from_map(member)
    mapping = member.params("mapping", MappingParams)
    maps = member.entry.maps
    if maps is not None and maps.localize is not None and maps.continues is not None:
        place = f"{site.mission_path}: vehicles.{member.name}.maps"
        raise BadInput(f"{place}: a vehicle either 'continues' a map or is localized on one; leave one of them out")
    if maps is not None and maps.localize is not None:
        if "localization" not in warm:
            warm_up_localization()
            warm.add("localization")
        return [_odometry(site, member), _localization(site, member, sensors.lidars, maps)]
    method = _method(member, mapping.method)
    if mapping.method not in warm:
        warm_up(method())
        warm.add(mapping.method)
    left = _left(site, member, mapping, maps.continues) if maps is not None and maps.continues is not None else None

    def make() -> MappingService:
        return MappingService(member.name, sensors.lidars, world_from_map, mapping, lambda name: _method(member, name)(), left)

    return [_odometry(site, member), ServiceInstance(MappingService, make, member.name)]


def _left(site: Scenario, member: MissionVehicle, mapping: MappingParams, name: str) -> MappingSession:
    """The session that a mapping goes on with, in the vehicle's map frame. Raises BadInput where it cannot."""
    assert member.entry.maps is not None
    path, method = site.mission_path.parent / name, _method(member, mapping.method)()
    map_from_file = compose(inverse(_world_from_map(member)), Pose2(*member.entry.maps.known_at))
    session = MappingSession.load(path).moved(map_from_file)
    if not isinstance(method, Resumable):
        raise BadInput(f"{member.name}: maps: continues: method {mapping.method} cannot go on with a session; graph does")
    if not session.keyframes:
        raise BadInput(f"session {path}: holds nothing to go on with")
    try:
        method.resume(session, IDENTITY)
        drawn = TileMap(mapping.resolution)
        drawn.follow(method.keyframes())
        drawn.cells()
    except (ValueError, BadInput) as error:
        raise BadInput(f"session {path}: {error}") from error
    return session


def _world_from_map(member: MissionVehicle) -> Pose2:
    start = member.entry.start
    return Pose2(start.x, start.y, start.yaw)


def _odometry(site: Scenario, member: MissionVehicle) -> ServiceInstance:
    params, origin = member.params("odometry", OdometryParams), site.world.origin
    tangent = LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude)
    start = _world_from_map(member)
    return ServiceInstance(OdometryService, lambda: OdometryService(member.name, member.file, start, params, tangent), member.name)


def _localization(site: Scenario, member: MissionVehicle, lidars: Sequence[Lidar], maps: Maps) -> ServiceInstance:
    """In the place of mapping. Raises BadInput for a file that is no map."""
    start, params, known = _world_from_map(member), member.params("localization", FilterParams), None
    if maps.known is not None:
        known = known_map.known_map(known_path(maps.known, site.mission_path.parent), compose(inverse(start), Pose2(*maps.known_at)))
    seed = int(site.rng(member.name, "localization").integers(1 << 31))
    beginning = LocalizationStart(known, maps.localize == "anywhere", seed)
    return ServiceInstance(LocalizationService, lambda: LocalizationService(member.name, lidars, start, params, beginning), member.name)


def _method(member: MissionVehicle, name: str) -> Callable[[], SlamMethod]:
    """Makes it by its name, with the parameters that the vehicle's file has for that name. Raises BadInput."""
    path = str(member.folder / "vehicle.yaml")
    if name not in METHODS:
        raise BadInput(f"{path}: params.mapping.method: no SLAM method '{name}'; {nearest(name, METHODS)}")
    return partial(make_method, name, member.params(name, METHODS[name].params))
