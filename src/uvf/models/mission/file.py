"""``missions/<name>.yaml``: a world, the vehicles with their starts and jobs, and pass criteria."""

from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from uvf.models.keys import key, name_like, plain
from uvf.models.mission.extending import whole_mission
from uvf.models.mission.faults import Fault, check_faults
from uvf.models.mission.fence import FenceFile, zones_of
from uvf.models.mission.fixtures import ChargerFile, MarkerFile
from uvf.models.mission.formation import Follow, check_follow
from uvf.models.mission.launch import Launch
from uvf.models.mission.task_check import check_tasks
from uvf.models.mission.task_needs import check_charging
from uvf.models.mission.tasks import Task, walk
from uvf.models.names import FOLDER, SYSTEM, VEHICLE
from uvf.models.world.wind import Wind, check_wind
from uvf.models.yaml_data import BadInput, FileLocation, load_yaml, nearest

NotNegative = Annotated[float, Meta(ge=0, le=1e6)]
Metres = Annotated[float, Meta(ge=-1e6, le=1e6)]  # local coordinates stay near the origin
VehicleName = Annotated[str, name_like(VEHICLE, 40, "a name has lower-case letters, digits and _, and begins with a letter")]
FolderName = Annotated[str, name_like(FOLDER, 80, "a folder has letters, digits and _, . or -, and no spaces")]


class StartPose(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where and how fast a vehicle begins, world frame (ENU)."""

    x: Annotated[Metres, key("m", "East of the world's origin.")]
    y: Annotated[Metres, key("m", "North of the world's origin.")]
    z: Annotated[
        Metres, key("m", "Height above the ground at that place. An aircraft with z = 0 stands on its wheels; a ground vehicle needs none.")
    ] = 0.0
    yaw: Annotated[float, Meta(ge=-7, le=7), key("rad", "Heading, counter-clockwise from east.")] = 0.0
    speed: Annotated[NotNegative, key("m/s", "Airspeed of an aircraft at the start; 0 means the `trim_speed` of its file.")] = 0.0
    climb: Annotated[float, Meta(ge=-1.5, le=1.5), key("rad", "Climb angle of an aircraft at the start, up from the horizon.")] = 0.0
    turn_rate: Annotated[float, Meta(ge=-3, le=3), key("rad/s", "Turn rate of an aircraft at the start, positive to the left.")] = 0.0
    charge: Annotated[float, Meta(ge=0, le=1), key("", "Charge of its battery at the start, 0 to 1.")] = 1.0
    on_ground: Annotated[bool, plain("The aircraft starts on its wheels, as one with z = 0 does.")] = False
    launch: Annotated[Launch | None, plain("The aircraft is thrown, by hand, catapult or bungee, once it is armed.")] = None


class Waypoint(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One mission item as people write it; field meanings as in ``uvf.v1.MissionItem``."""

    x: Annotated[Metres, key("m", "East of the world's origin.")] = 0.0
    y: Annotated[Metres, key("m", "North of the world's origin.")] = 0.0
    z: Annotated[Metres, key("m", "Height above the world's origin; of `takeoff`, the height to climb to. Ground vehicles ignore it.")] = (
        0.0
    )
    kind: Annotated[
        Literal["waypoint", "orbit", "return", "jump", "speed", "trigger", "trigger_distance", "takeoff", "land", "land_start", "set_home"],
        plain("What the item does; see [mission items](modes.md#mission-items)."),
    ] = "waypoint"
    acceptance_radius: Annotated[
        NotNegative,
        key(
            "m",
            "Largest distance at which the waypoint counts as passed; 0 means any distance for an aircraft, the "
            "parameter `acceptance_radius` for a ground vehicle.",
        ),
    ] = 0.0
    hold: Annotated[NotNegative, key("s", "Time that an aircraft circles the waypoint. Ground vehicles do not wait.")] = 0.0
    radius: Annotated[Metres, key("m", "Radius of an `orbit`; negative turns to the left.")] = 0.0
    turns: Annotated[NotNegative, key("", "Turns of an `orbit`; 0 means without end.")] = 0.0
    speed: Annotated[NotNegative, key("m/s", "Airspeed from this item on, of `speed` items; 0 means cruise speed.")] = 0.0
    jump_to: Annotated[int, Meta(ge=0, le=65535), key("", "Index of the item that a `jump` leads to; the first item is 0.")] = 0
    repeat: Annotated[int, Meta(ge=-1, le=65535), key("", "Number of times that a `jump` is taken; -1 means for ever.")] = 0
    course: Annotated[
        Annotated[float, Meta(ge=-7, le=7)] | None,
        key("rad", "Course over ground at which the waypoint is passed, counter-clockwise from east. Left out: any."),
    ] = None
    to_altitude: Annotated[bool, plain("An `orbit` lasts until the aircraft is at its altitude.")] = False
    distance: Annotated[NotNegative, key("m", "Distance over ground between two pictures, of `trigger_distance`; 0 ends the series.")] = 0.0


class JobFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What a vehicle does without an operator; empty: hold."""

    explore: Annotated[bool, plain("A ground vehicle explores until it knows every place that it can reach.")] = False
    armed: Annotated[
        bool | None,
        plain(
            "Whether the vehicle is armed from the start. Left out: a ground vehicle is when its job is to explore or a mission, and "
            "begins with it; an aircraft is when it starts in the air, and there it cannot be otherwise. An armed aircraft on its wheels "
            "takes off when its mission begins. A ground vehicle that is not armed waits in Hold for a task or an operator."
        ),
    ] = None
    mission: Annotated[list[Waypoint], plain("Mission items in the order in which they are done.")] = []
    follow: Annotated[Follow | None, plain("The aircraft keeps a formation slot behind a leader.")] = None


class Maps(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Maps of map_server, world frame: files (relative to the mission file's folder), or names of saved ones.

    speed: a mask whose values v, 1..100, allow speed_base + speed_multiplier * v.
    known: may be a session of a mapping (.npz), too. known_at: x, y [m], yaw [rad] of the frame of its file in the world.
    continues: a session (.npz) that the vehicle's mapping goes on with, from its start pose; known_at is that of its frame, too.
    localize: the vehicle draws no map, but is localized on ``known``, or on what comes on map/known: from its start pose, or anywhere.
    """

    known: Annotated[
        str | None,
        plain(
            "Map that the vehicle knows: a map_server yaml (path relative to the mission file's folder), a session of a "
            "mapping run (.npz), or the name of a saved map."
        ),
    ] = None
    known_at: Annotated[
        tuple[Metres, Metres, Metres], plain("Pose of the frame of `known` (or `continues`) in the world: x [m], y [m], yaw [rad].")
    ] = (0.0, 0.0, 0.0)
    continues: Annotated[str | None, plain("Session (.npz) that the vehicle's mapping continues, from its start pose.")] = None
    localize: Annotated[
        Literal["start", "anywhere"] | None,
        plain(
            "The vehicle draws no map but is localized on `known`: from its start pose (`start`) or without knowing "
            "where it is (`anywhere`)."
        ),
    ] = None
    keepout: Annotated[str | None, plain("Mask (map_server yaml) of the places to keep out of.")] = None
    speed: Annotated[
        str | None,
        plain("Mask (map_server yaml) of speed limits: a cell of value v, 1 to 100, allows `speed_base + speed_multiplier * v`."),
    ] = None
    speed_unit: Annotated[
        Literal["percent", "m/s"], plain("Unit of the limits in the speed mask: `percent` of the vehicle's own speed, or `m/s`.")
    ] = "percent"
    speed_base: Annotated[float, key("speed_unit", "Limit at mask value 0.")] = 100.0
    speed_multiplier: Annotated[float, key("speed_unit", "Change of the limit per mask value.")] = -1.0


class Vehicle(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One vehicle of a mission: its model, where it starts and what it does."""

    model: Annotated[FolderName, plain("Folder in `vehicles/`.")]
    start: Annotated[StartPose, plain("Pose and motion at the start.")]
    system_id: Annotated[int, Meta(ge=1, le=244), key("", "MAVLink system id; no two vehicles of a mission share one.")]
    job: Annotated[JobFile, plain("What the vehicle does without an operator. Left out: it holds.")] = JobFile()
    roles: Annotated[dict[str, str], plain("Vehicle by role, for services that read another vehicle's messages (`leader: milvus1`).")] = {}
    fence: Annotated[FenceFile, plain("Where the vehicle may be.")] = FenceFile()
    maps: Annotated[Maps | None, plain("Maps and masks that a ground vehicle starts with.")] = None
    params: Annotated[
        dict[str, dict[str, Any]],
        plain("Parameters by service that differ from those of the vehicle's file: `params: {mapping: {method: hector}}`."),
    ] = {}
    program: Annotated[
        str | None,
        plain("Python file (path relative to the mission file's folder) of a service of your own that runs with the vehicle."),
    ] = None


class Criterion(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One line of the score: a measured figure of a vehicle or a task and its limits; see ``launch.scoring.scores``."""

    measure: Annotated[str, plain("One of the [measures](#measures).")]
    vehicle: Annotated[str, plain("Vehicle that is measured; left out where a task is.")] = ""
    task: Annotated[str, plain("Name of the task that is measured.")] = ""
    at_least: Annotated[float | None, key("unit of the measure", "The criterion holds when the measure is not below this.")] = None
    at_most: Annotated[float | None, key("unit of the measure", "The criterion holds when the measure is not above this.")] = None


class MissionFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The whole of a mission file. ``wind`` stands for that of the world, whole."""

    about: Annotated[str, plain("One sentence for lists.")]
    world: Annotated[FolderName, plain("Folder in `worlds/`.")]
    vehicles: Annotated[
        dict[VehicleName, Vehicle],
        Meta(min_length=1),
        plain("Vehicles by name. A name has lower-case letters, digits and `_`, and begins with a letter."),
    ]
    seed: Annotated[int, key("", "Seed of every random number of the run. Two lockstep runs with the same seed are equal to the byte.")] = 1
    duration: Annotated[float, Meta(gt=0, le=1e6), key("s", "Simulation time after which `uvf run` ends and scores.")] = 120.0
    markers: Annotated[list[MarkerFile], Meta(max_length=200), plain("Coloured posts in the world that vehicles look for.")] = []
    chargers: Annotated[
        list[ChargerFile], Meta(max_length=100), plain("Places in the world on which ground vehicles are charged while they stand there.")
    ] = []
    roles: Annotated[dict[str, list[str]], plain("Vehicles by role: tasks name roles instead of vehicles, where several share one.")] = {}
    tasks: Annotated[
        list[Task],
        plain("What the vehicles do together, one task after the other. When the last one is done, or one has failed, `uvf run` ends."),
    ] = []
    criteria: Annotated[list[Criterion], plain("Pass criteria; all must hold. Without any, all tasks must be done.")] = []
    wind: Annotated[Wind | None, plain("Replaces the whole wind of the world.")] = None
    faults: Annotated[list[Fault], plain("Sensors and servos that fail during the run.")] = []


def load_mission(path: str | Path) -> MissionFile:
    """Reads and cross-checks a mission file. Raises BadInput."""
    path = Path(path)
    if not path.is_file():
        known = [p.stem for p in path.parent.glob("*.yaml")] if path.parent.is_dir() else []
        raise BadInput(f"no mission '{path}'; {nearest(path.stem, known)}")
    mission = load_yaml(path, MissionFile, lambda data, place: whole_mission(path))
    file = FileLocation(str(path))
    _check_vehicles(mission.vehicles, file.at("vehicles"), path.parent)
    _check_follow(mission.vehicles, file.at("vehicles"))
    if mission.wind is not None:
        check_wind(mission.wind, file.at("wind"))
    check_faults(mission.faults, mission.vehicles, mission.duration, file.at("faults"))
    check_tasks(mission.tasks, mission.roles, mission.vehicles, file, path.parent)
    check_charging(mission.tasks, len(mission.chargers), file)
    tasks = {task.name for task in walk(mission.tasks) if task.name}
    for i, criterion in enumerate(mission.criteria):
        _check_criterion(criterion, mission.vehicles, tasks, file.at("criteria", i))
    return mission


def _check_vehicles(vehicles: dict[str, Vehicle], place: FileLocation, folder: Path) -> None:
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
        if vehicle.program is not None and not (folder / vehicle.program).is_file():
            raise BadInput(f"{place.at(name, 'program')}: there is no file {folder / vehicle.program}")
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


def _check_criterion(criterion: Criterion, vehicles: dict[str, Vehicle], tasks: set[str], place: FileLocation) -> None:
    if bool(criterion.vehicle) == bool(criterion.task):
        raise BadInput(f"{place}: a criterion is about a vehicle or a task, one of the two")
    if criterion.task and criterion.task not in tasks:
        raise BadInput(f"{place}: no task is called '{criterion.task}'; {nearest(criterion.task, tasks)}")
    if criterion.vehicle and criterion.vehicle not in vehicles:
        raise BadInput(f"{place}: no vehicle '{criterion.vehicle}'; {nearest(criterion.vehicle, vehicles)}")
    low, high = criterion.at_least, criterion.at_most
    if low is None and high is None:
        raise BadInput(f"{place}: no limit: give at_least, at_most or both")
    if low is not None and high is not None and low > high:
        raise BadInput(f"{place}: at_least {low:g} is above at_most {high:g}: nothing can pass")
