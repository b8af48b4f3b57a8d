"""What the tasks of a mission see in one step, and what they say."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import dist, hypot
from typing import NamedTuple

from schemas.messages import DriveCommand, Grid, Mode, TaskStatus
from services.executive.asking import PendingRequests
from services.executive.interface import Inputs
from uvf.models.mission.task_check import members_of
from uvf.models.mission.tasks import Who
from uvf.models.scenario import MissionVehicle

Point = tuple[float, float]

SAME_MARKER = 3.0  # m, that two vehicles may tell of one marker apart: each has the error of its own pose in it


class FoundMarker(NamedTuple):
    """A marker: where it is [m, world] by the surest estimate, and by (vehicle, number there) where each that tells of it has it."""

    place: Point
    told: Mapping[tuple[str, int], Point]

    def may_be(self, other: "FoundMarker") -> bool:
        """Whether two are one: near each other, and nobody tells of both."""
        tell_apart = {name for name, _ in self.told} & {name for name, _ in other.told}
        return not tell_apart and dist(self.place, other.place) <= SAME_MARKER

    def is_of(self, other: "FoundMarker") -> bool:
        """Whether both are of one marker, told at different times."""
        return bool(self.told.keys() & other.told.keys()) or self.may_be(other)

    def also(self, other: "FoundMarker") -> "FoundMarker":
        """The same marker, told by more; the place is that of this one."""
        return self._replace(told={**other.told, **self.told})

    def place_for(self, vehicle: str) -> Point:
        """Where it is for a vehicle that goes there: as it has seen it itself, with the error that its pose has, too; or else at best."""
        return next((place for (name, _), place in self.told.items() if name == vehicle), self.place)


@dataclass
class TeamSituation:
    """One step at ``t`` [s, simulation]."""

    members: Mapping[str, MissionVehicle]
    roles: Mapping[str, list[str]]
    desk: PendingRequests = field(default_factory=PendingRequests)
    records: dict[str, TaskStatus] = field(default_factory=dict)
    """Of the tasks that have names."""
    t: float = 0.0
    now: Inputs = field(default_factory=Inputs)
    drive: dict[str, DriveCommand] = field(default_factory=dict)
    shared: dict[str, Grid] = field(default_factory=dict)
    """Maps that are handed over in this step, by who gets them."""
    given_up: dict[str, str] = field(default_factory=dict)
    """Why a vehicle's planner has given up its goal last."""

    def begin(self, t: float, now: Inputs) -> None:
        """Begins a step."""
        self.t, self.now, self.drive, self.shared = t, now, {}, {}
        for vehicle, events in now.told.items():
            for event in events:
                if "given up" in event.text:
                    self.given_up[vehicle] = event.cause

    def vehicles(self, who: Who) -> list[str]:
        """Names of the vehicles that are meant."""
        return members_of(who, self.roles)

    def flies(self, vehicle: str) -> bool:
        """Whether the vehicle is an aircraft."""
        return self.members[vehicle].file.kind == "fixed_wing"

    def place(self, vehicle: str) -> tuple[float, float, float] | None:
        """Where the vehicle thinks it is: x, y, z [m, world]; None without a fresh pose."""
        pose = self.now.pose.get(vehicle)
        return (pose.pose.position.x, pose.pose.position.y, pose.pose.position.z) if pose is not None else None

    def distance(self, vehicle: str, point: Point) -> float | None:
        """Horizontal distance [m] of a vehicle from a point [m, world]; None without a fresh pose."""
        place = self.place(vehicle)
        return hypot(place[0] - point[0], place[1] - point[1]) if place is not None else None

    def found(self, vehicles: Sequence[str]) -> list[FoundMarker]:
        """The markers that these vehicles have found together, each once, by the surest estimate of it."""
        told = [(name, each) for name in vehicles if name in self.now.detections for each in self.now.detections[name].detections]
        markers: list[FoundMarker] = []
        for name, each in sorted(told, key=lambda pair: pair[1].sigma):
            place = each.position.x, each.position.y
            seen = FoundMarker(place, {(name, each.id): place})
            known = min(
                (k for k, marker in enumerate(markers) if marker.may_be(seen)), key=lambda k: dist(markers[k].place, place), default=None
            )
            if known is None:
                markers.append(seen)
            else:
                markers[known] = markers[known].also(seen)
        return markers

    def is_armed(self, vehicle: str) -> bool:
        """Whether the vehicle's autopilot says that it is armed."""
        status = self.now.status.get(vehicle)
        return status is not None and status.armed

    def mode(self, vehicle: str) -> int:
        """The mode of a vehicle's autopilot."""
        status = self.now.status.get(vehicle)
        return status.mode if status is not None else Mode.MODE_UNSPECIFIED
