"""``missions/<name>.yaml``: a world, the vehicles with their starts and jobs, and when it counts as done."""

from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from uvf.models.mission.faults import Fault, check_faults
from uvf.models.mission.fence import FenceFile, zones_of
from uvf.models.mission.formation import Follow, check_follow
from uvf.models.names import FOLDER, SYSTEM, VEHICLE
from uvf.models.world.wind import Wind, check_wind
from uvf.models.yaml_data import BadInput, FileLocation, load_yaml, nearest

NotNegative = Annotated[float, Meta(ge=0, le=1e6)]
Metres = Annotated[float, Meta(ge=-1e6, le=1e6)]  # local coordinates stay near the origin
VehicleName = Annotated[str, Meta(pattern=rf"^{VEHICLE}\Z", max_length=40)]
FolderName = Annotated[str, Meta(pattern=rf"^{FOLDER}\Z", max_length=80)]


class StartPose(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where and how fast a vehicle begins, world frame (ENU)."""

    x: Metres
    y: Metres
    z: Metres = 0.0
    yaw: Annotated[float, Meta(ge=-7, le=7)] = 0.0  # rad, from east, left positive
    speed: NotNegative = 0.0  # m/s; of an aircraft through the air, 0 = its trim_speed
    climb: Annotated[float, Meta(ge=-1.5, le=1.5)] = 0.0  # rad, of an aircraft, up from the horizon
    turn_rate: Annotated[float, Meta(ge=-3, le=3)] = 0.0  # rad/s, of an aircraft, to the left
    on_ground: bool = False  # an aircraft stands on its wheels, as one with z = 0 does


class Waypoint(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One mission item as people write it; field meanings as in ``uvf.v1.MissionItem``."""

    x: Metres = 0.0
    y: Metres = 0.0
    z: Metres = 0.0
    kind: Literal[
        "waypoint", "orbit", "return", "jump", "speed", "trigger", "trigger_distance", "takeoff", "land", "land_start", "set_home"
    ] = "waypoint"
    acceptance_radius: NotNegative = 0.0  # m
    hold: NotNegative = 0.0  # s
    radius: Metres = 0.0
    turns: NotNegative = 0.0
    speed: NotNegative = 0.0  # m/s
    jump_to: Annotated[int, Meta(ge=0, le=65535)] = 0
    repeat: Annotated[int, Meta(ge=-1, le=65535)] = 0  # -1 = for ever
    course: Annotated[float, Meta(ge=-7, le=7)] | None = None  # rad, over ground, from east, left positive
    to_altitude: bool = False
    distance: NotNegative = 0.0  # m


class JobFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What a vehicle does with nobody touching anything; empty = hold."""

    explore: bool = False
    armed: bool = False  # an aircraft that stands is armed from the beginning, and takes off when its mission begins
    mission: list[Waypoint] = []
    follow: Follow | None = None


class Maps(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Maps of map_server, world frame: files (from the mission file's folder on), or names of saved ones. An empty one serves too.

    speed: a mask whose values v, 1..100, allow speed_base + speed_multiplier * v.
    known: may be a session of a mapping (.npz), too. known_at: x, y [m], yaw [rad] of the frame of its file in the world.
    continues: a session (.npz) that the vehicle's mapping goes on with, from its start pose; known_at is that of its frame, too.
    localize: the vehicle draws no map, but is localized on ``known``, or on what comes on map/known: from its start pose, or anywhere.
    """

    known: str | None = None
    known_at: tuple[Metres, Metres, Metres] = (0.0, 0.0, 0.0)
    continues: str | None = None
    localize: Literal["start", "anywhere"] | None = None
    keepout: str | None = None
    speed: str | None = None
    speed_unit: Literal["percent", "m/s"] = "percent"
    speed_base: float = 100.0
    speed_multiplier: float = -1.0


class Vehicle(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    model: FolderName
    start: StartPose
    system_id: Annotated[int, Meta(ge=1, le=244)]
    job: JobFile = JobFile()
    roles: dict[str, str] = {}
    fence: FenceFile = FenceFile()
    maps: Maps | None = None  # of a ground vehicle: it serves these, and its own


class Criterion(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One line of the score: a measured figure of a vehicle and its limits; see ``launch.scoring.scores``."""

    vehicle: str
    measure: str
    at_least: float | None = None
    at_most: float | None = None


class MissionFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The whole of a mission file. ``wind`` stands for that of the world, whole."""

    about: str
    world: FolderName
    vehicles: Annotated[dict[VehicleName, Vehicle], Meta(min_length=1)]
    seed: int = 1
    duration: Annotated[float, Meta(gt=0, le=1e6)] = 120.0  # s
    criteria: list[Criterion] = []
    wind: Wind | None = None
    faults: list[Fault] = []


def load_mission(path: Path) -> MissionFile:
    """Reads and cross-checks a mission file. Raises BadInput."""
    if not path.is_file():
        known = [p.stem for p in path.parent.glob("*.yaml")] if path.parent.is_dir() else []
        raise BadInput(f"no mission '{path}'; {nearest(path.stem, known)}")
    mission = load_yaml(path, MissionFile)
    file = FileLocation(str(path))
    _check_vehicles(mission.vehicles, file.at("vehicles"))
    _check_follow(mission.vehicles, file.at("vehicles"))
    if mission.wind is not None:
        check_wind(mission.wind, file.at("wind"))
    check_faults(mission.faults, mission.vehicles, file.at("faults"))
    for i, criterion in enumerate(mission.criteria):
        _check_criterion(criterion, mission.vehicles, file.at("criteria", i))
    return mission


def _check_vehicles(vehicles: dict[str, Vehicle], place: FileLocation) -> None:
    ids: dict[int, str] = {}
    for name, vehicle in vehicles.items():
        if name == SYSTEM:
            raise BadInput(f"{place.at(name)}: '{SYSTEM}' stands for the system itself; choose another name")
        if vehicle.system_id in ids:
            other = ids[vehicle.system_id]
            raise BadInput(f"{place.at(name, 'system_id')}: {name} and {other} both have system_id {vehicle.system_id}; change one")
        ids[vehicle.system_id] = name
        for role, other in vehicle.roles.items():
            if other not in vehicles:
                raise BadInput(f"{place.at(name, 'roles', role)}: no vehicle '{other}'; {nearest(other, vehicles)}")
        zones_of(vehicle.fence, place.at(name, "fence"))
        _check_jumps(vehicle.job.mission, place.at(name, "job", "mission"))


def _check_follow(vehicles: dict[str, Vehicle], place: FileLocation) -> None:
    for name, vehicle in vehicles.items():
        if vehicle.job.follow is not None and (vehicle.job.mission or vehicle.job.explore):
            raise BadInput(f"{place.at(name, 'job', 'follow')}: {name} has a mission of its own besides; leave one of them out")
    check_follow({name: v.job.follow for name, v in vehicles.items() if v.job.follow is not None}, vehicles, place)


def _check_jumps(items: list[Waypoint], place: FileLocation) -> None:
    for i, item in enumerate(items):
        if item.kind == "jump" and item.jump_to >= len(items):
            raise BadInput(f"{place.at(i)}: jumps to {item.jump_to}, but the last item is {len(items) - 1} (the first is 0)")


def _check_criterion(criterion: Criterion, vehicles: dict[str, Vehicle], place: FileLocation) -> None:
    if criterion.vehicle not in vehicles:
        raise BadInput(f"{place}: no vehicle '{criterion.vehicle}'; {nearest(criterion.vehicle, vehicles)}")
    low, high = criterion.at_least, criterion.at_most
    if low is None and high is None:
        raise BadInput(f"{place}: no limit: give at_least, at_most or both")
    if low is not None and high is not None and low > high:
        raise BadInput(f"{place}: at_least {low:g} is above at_most {high:g}: nothing can pass")
