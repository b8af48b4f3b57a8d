"""``missions/<name>.yaml``: a world, the vehicles with their starts and jobs, and when it counts as done."""

from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from uvf.runtime.params import BadInput, load_yaml, nearest

NotNegative = Annotated[float, Meta(ge=0)]
VehicleName = Annotated[str, Meta(pattern="^(?!sys$)[a-z][a-z0-9_]*$")]


class Start(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where and how fast a vehicle begins, world frame (ENU)."""

    x: float  # m
    y: float  # m
    z: float = 0.0  # m
    yaw: float = 0.0  # rad, from east, left positive
    speed: NotNegative = 0.0  # m/s


class Waypoint(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One mission item as people write it; field meanings as in ``uvf.v1.MissionItem``."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    kind: Literal["waypoint", "orbit", "return", "jump", "speed"] = "waypoint"
    acceptance_radius: NotNegative = 0.0  # m
    hold: NotNegative = 0.0  # s
    radius: float = 0.0  # m
    turns: NotNegative = 0.0
    speed: NotNegative = 0.0  # m/s
    jump_to: Annotated[int, Meta(ge=0)] = 0
    repeat: int = 0


class Job(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What a vehicle does with nobody touching anything; empty = hold."""

    explore: bool = False
    mission: list[Waypoint] = []


class Vehicle(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    model: str
    start: Start
    system_id: Annotated[int, Meta(ge=1, le=244)]
    job: Job = Job()
    roles: dict[str, str] = {}


class Criterion(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One line of the score: a measured figure of a vehicle and its limits; see ``uvf.launch.scores``."""

    vehicle: str
    measure: str
    at_least: float | None = None
    at_most: float | None = None


class MissionFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The whole of a mission file."""

    about: str
    world: str
    vehicles: dict[VehicleName, Vehicle]
    seed: int = 1
    duration: Annotated[float, Meta(gt=0)] = 120.0  # s
    criteria: list[Criterion] = []


def load_mission(path: Path) -> MissionFile:
    """Reads and cross-checks a mission file. Raises BadInput."""
    if not path.is_file():
        known = [p.stem for p in path.parent.glob("*.yaml")] if path.parent.is_dir() else []
        raise BadInput(f"no mission '{path}'; {nearest(path.stem, known)}")
    mission = load_yaml(path, MissionFile)
    ids: dict[int, str] = {}
    for name, vehicle in mission.vehicles.items():
        if vehicle.system_id in ids:
            raise BadInput(f"{path}: {name} and {ids[vehicle.system_id]} both have system_id {vehicle.system_id}")
        ids[vehicle.system_id] = name
        for role, other in vehicle.roles.items():
            if other not in mission.vehicles:
                raise BadInput(f"{path}: {name}: role {role}: no vehicle '{other}'; {nearest(other, mission.vehicles)}")
    for criterion in mission.criteria:
        if criterion.vehicle not in mission.vehicles:
            raise BadInput(f"{path}: criteria: no vehicle '{criterion.vehicle}'; {nearest(criterion.vehicle, mission.vehicles)}")
    return mission
