"""Everything a service is built from: the mission with its world and vehicles, loaded and checked once."""

import hashlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypeVar

import numpy as np

from uvf.runtime.mission_file import MissionFile, Vehicle, load_mission
from uvf.runtime.params import convert
from uvf.runtime.service import Params, Service
from uvf.runtime.vehicle_file import VehicleFile, load_vehicle
from uvf.runtime.world_file import WorldFile, load_world

ROOT = Path(__file__).resolve().parents[3]
P = TypeVar("P", bound=Params)


@dataclass(frozen=True)
class Member:
    """One vehicle of the mission: its entry there, its file and its folder."""

    name: str
    entry: Vehicle
    file: VehicleFile
    folder: Path

    def params(self, service: str, type_: type[P]) -> P:
        """The parameters that this vehicle's file sets for a service, the rest by default. Raises BadInput."""
        place = f"{self.folder / 'vehicle.yaml'}: params: {service}"
        return convert(self.file.params.get(service, {}), type_, place)


@dataclass(frozen=True)
class Site:
    mission_path: Path
    mission: MissionFile
    world: WorldFile
    world_folder: Path
    members: dict[str, Member]

    def of_kind(self, kind: str) -> Iterator[Member]:
        return (m for m in self.members.values() if m.file.kind == kind)

    def rng(self, *names: str) -> np.random.Generator:
        """A generator of its own for each purpose: the mission's seed and the names decide, nothing else."""
        text = "/".join((str(self.mission.seed), *names))
        return np.random.default_rng(int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big"))


@dataclass(frozen=True)
class Host:
    """One service instance: how to make it afresh (at start and after each reset), and for which vehicle.

    writes_for: the vehicles about which a service of the whole world writes.
    """

    service: type[Service]
    make: Callable[[], Service]
    vehicle: str | None = None
    roles: dict[str, str] | None = None
    writes_for: tuple[str, ...] = ()


class Build(Protocol):
    """``services/<name>/build.py`` holds one: which instances a process of this service hosts."""

    def __call__(self, site: Site) -> list[Host]: ...


def load_site(mission: Path, root: Path = ROOT) -> Site:
    """Loads a mission file and all that it names. Raises BadInput."""
    data = load_mission(mission)
    members = {
        name: Member(name, entry, load_vehicle(root / "vehicles", entry.model), root / "vehicles" / entry.model)
        for name, entry in data.vehicles.items()
    }
    return Site(mission, data, load_world(root / "worlds", data.world), root / "worlds" / data.world, members)
