"""Everything a service is built from: the mission with its world and vehicles, loaded and checked once."""

import hashlib
import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import msgspec
import numpy as np

from uvf.models.mission.extending import merge
from uvf.models.mission.faults import check_parts
from uvf.models.mission.file import MissionFile, Vehicle, load_mission
from uvf.models.mission.fixtures import furnished
from uvf.models.mission.task_needs import (
    check_batteries,
    check_drivers,
    check_explorers,
    check_finders,
    check_heights,
    check_merging,
    check_shares,
)
from uvf.models.params import Params
from uvf.models.vehicle.file import VehicleFile, load_vehicle
from uvf.models.world.file import WorldFile, load_world
from uvf.models.world.wind import Wind
from uvf.models.yaml_data import BadInput, FileLocation, convert

ROOT = Path(__file__).resolve().parents[3]
DETECTOR = "detector"  # who has parameters for it looks for markers
AIRCRAFT_RADIUS = 1.5  # m, about the half span of a small one
P = TypeVar("P", bound=Params)


@dataclass(frozen=True)
class MissionVehicle:
    """One vehicle of the mission: its entry there, its file, with the parameters that the mission sets, and its folder."""

    name: str
    entry: Vehicle
    file: VehicleFile
    folder: Path
    mission: str = ""
    """Path of the mission file; empty for a vehicle that was put in while it ran."""

    def params(self, service: str, type_: type[P]) -> P:
        """Parameters of a service as this vehicle's file and its mission set them, the rest by default. Raises BadInput."""
        convert(self.entry.params.get(service, {}), type_, self.mission, ("vehicles", self.name, "params", service))
        return convert(self.file.params.get(service, {}), type_, str(self.folder / "vehicle.yaml"), ("params", service))


@dataclass(frozen=True)
class Scenario:
    """A mission with its world and its vehicles, loaded and checked."""

    mission_path: Path
    mission: MissionFile
    world: WorldFile
    world_folder: Path
    members: dict[str, MissionVehicle]

    def of_kind(self, kind: str) -> Iterator[MissionVehicle]:
        """The vehicles of one kind: ``ground`` or ``fixed_wing``."""
        return (m for m in self.members.values() if m.file.kind == kind)

    @property
    def mapping(self) -> list[MissionVehicle]:
        """The vehicles that draw maps."""
        return [m for m in self.of_kind("ground") if m.entry.maps is None or m.entry.maps.localize is None]

    @property
    def vehicles_folder(self) -> Path:
        """Folder that holds the models of its vehicles, and those that may be put in later."""
        return next(iter(self.members.values())).folder.parent

    @property
    def wind(self) -> Wind:
        """Wind of the mission, or else that of the world."""
        return self.world.wind if self.mission.wind is None else self.mission.wind

    def rng(self, *names: str) -> np.random.Generator:
        """A random generator for one purpose: the mission's seed and the names decide its numbers, nothing else."""
        text = "/".join((str(self.mission.seed), *names))
        return np.random.default_rng(int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big"))


def check_starts(site: Scenario) -> None:
    """Checks that every vehicle begins in its world and none inside another one. Raises BadInput."""
    x_min, y_min, x_max, y_max = site.world.floor
    place = FileLocation(str(site.mission_path)).at("vehicles")
    for name, member in site.members.items():
        start, body = member.entry.start, member.file.ground
        if body is not None and not (x_min <= start.x <= x_max and y_min <= start.y <= y_max):
            floor = f"x {x_min:g}..{x_max:g}, y {y_min:g}..{y_max:g}"
            raise BadInput(f"{place.at(name, 'start')}: ({start.x:g}, {start.y:g}) is not on the floor of {site.mission.world}: {floor}")
        if start.charge < 1.0 and not member.file.has_battery:
            raise BadInput(
                f"{place.at(name, 'start', 'charge')}: {member.entry.model} has no battery; give its vehicle.yaml one, or leave it out"
            )
        if start.z < 0:
            raise BadInput(f"{place.at(name, 'start', 'z')}: {start.z:g} m is under the ground; the ground is 0")
    for (one, a), (other, b) in itertools.combinations(site.members.items(), 2):
        apart = math.dist(_position(a), _position(b))
        if apart < _radius(a) + _radius(b):
            raise BadInput(f"{place.at(other, 'start')}: {other} begins {apart:.2f} m from {one}, which is inside it; move one of them")


def _position(member: MissionVehicle) -> tuple[float, float, float]:
    start = member.entry.start
    return start.x, start.y, start.z if member.file.air is not None else 0.0


def _radius(member: MissionVehicle) -> float:
    return member.file.ground.radius if member.file.ground is not None else AIRCRAFT_RADIUS


def _with_params(file: VehicleFile, entry: Vehicle) -> VehicleFile:
    return msgspec.structs.replace(file, params=merge(file.params, entry.params)) if entry.params else file


def load_scenario(mission: str | Path, root: str | Path = ROOT) -> Scenario:
    """Loads a mission file and all that it names. root: folder that holds ``vehicles`` and ``worlds``. Raises BadInput."""
    mission, root = Path(mission), Path(root)
    data, place = load_mission(mission), FileLocation(str(mission))
    vehicles, worlds = root / "vehicles", root / "worlds"
    files = {name: load_vehicle(vehicles, entry.model, place.at("vehicles", name, "model")) for name, entry in data.vehicles.items()}
    members = {
        name: MissionVehicle(name, entry, _with_params(files[name], entry), vehicles / entry.model, str(mission))
        for name, entry in data.vehicles.items()
    }
    world = furnished(load_world(worlds, data.world, place.at("world")), data.markers, data.chargers, place)
    site = Scenario(mission, data, world, worlds / data.world, members)
    check_starts(site)
    kinds = {name: file.kind for name, file in files.items()}
    check_parts(data.faults, files, place.at("faults"))
    _check_jobs(data.vehicles, kinds, place.at("vehicles"))
    check_drivers(data.tasks, data.roles, kinds, place)
    check_explorers(data.tasks, data.roles, {name for name, entry in data.vehicles.items() if entry.job.explore}, place)
    check_heights(data.tasks, data.roles, kinds, place)
    check_merging(data.tasks, data.roles, {member.name for member in site.mapping}, place)
    check_batteries(data.tasks, data.roles, {name for name, file in files.items() if not file.has_battery}, place)
    check_shares(data.tasks, data.roles, kinds, place)
    check_finders(data.tasks, data.roles, {name for name, member in members.items() if DETECTOR in member.file.params}, place)
    return site


def _check_jobs(vehicles: Mapping[str, Vehicle], kinds: Mapping[str, str], place: FileLocation) -> None:
    """Checks that aircraft have jobs that they can do."""
    for name, entry in vehicles.items():
        if kinds[name] == "ground":
            continue
        if entry.job.explore:
            raise BadInput(f"{place.at(name, 'job', 'explore')}: {name} flies; only ground vehicles explore")
        for i, item in enumerate(entry.job.mission):
            if item.kind in ("waypoint", "orbit", "takeoff") and item.z <= 0.0:
                raise BadInput(f"{place.at(name, 'job', 'mission', i, 'z')}: {name} flies; give the height above the world's origin")
