"""What a ground vehicle is to do now: return, a person's errand, the mission, exploring, in this order."""

import math
from dataclasses import dataclass, replace

from schemas.messages import Mission, MissionItem, MissionProgress, Mode, RallyPoints, VehicleStatus
from uvf.runtime.messages.convert import mode_name

Point = tuple[float, float]


@dataclass(frozen=True)
class Goal:
    """A person's goal: position (x, y) [m, world] and yaw [rad, world], None = any."""

    point: Point
    yaw: float | None = None


@dataclass(frozen=True)
class Errand:
    """What a person has asked for: places to drive to in turn."""

    name: str
    """As in ``NavStatus.job``."""
    goals: tuple[Goal, ...]
    via: tuple[Point, ...] = ()
    """Places [m, world] to pass before the first one."""
    at: int = 0
    """Index of the place that is driven to now."""
    missed: int = 0
    """Places in a row that could not be reached."""
    repeats: bool = False
    """Whether it begins again after the last place."""
    leader: str = ""
    """The vehicle that is followed, if one is."""

    @property
    def goal(self) -> Goal:
        """The place that is driven to now."""
        return self.goals[self.at]

    def after(self, reached: bool) -> "Errand | None":
        """What is left when the place is reached, or given up; None when that was all, or no place at all can be reached."""
        missed = 0 if reached else self.missed + 1
        if missed >= len(self.goals) or (self.at + 1 == len(self.goals) and not self.repeats):
            return None
        return replace(self, at=(self.at + 1) % len(self.goals), missed=missed, via=())


@dataclass(frozen=True)
class Job:
    """The vehicle's job. name: as in ``NavStatus.job``; target: position to reach [m, world], None: it finds its own, or there is none."""

    name: str
    target: Point | None = None
    yaw: float | None = None
    via: tuple[Point, ...] = ()
    """Places [m, world] to pass on the way."""
    is_errand: bool = False
    """Whether a person has asked for it."""
    leader: str = ""
    """The vehicle that is followed, if one is."""

    @property
    def allow_unknown(self) -> bool:
        """Whether the path may cross unknown cells: who is followed has driven there, and a mission's author knows more than the map."""
        return bool(self.leader) or self.name in ("mission", "return")


@dataclass(frozen=True)
class Orders:
    """Standing orders. haven: return point [m, world]; explores: whether it explores when nothing else is to be done."""

    return_point: Point
    explores: bool


IDLE = Job("idle")
EXPLORE = Job("explore")


def mission_target(mission: Mission | None, progress: MissionProgress | None, home: Point) -> Point | None:
    """Position (x, y) [m, world] of the current mission item; None when there is nothing to drive to."""
    if mission is None or progress is None or progress.mission_id != mission.id or progress.current >= len(mission.items):
        return None
    if progress.state != MissionProgress.ACTIVE:
        return None
    item = mission.items[progress.current]
    return home if item.kind == MissionItem.RETURN else (item.position.x, item.position.y)


class ReturnPoints:
    """The return point of mode Return: the nearest of home and rally points when it begins; it does not change on the way."""

    def __init__(self) -> None:
        self._chosen: Point | None = None

    def step(self, status: VehicleStatus | None, here: Point, home: Point, rally: RallyPoints | None) -> Point:
        """The return point (x, y) in this cycle; all positions [m, world]."""
        places = [home, *((p.x, p.y) for p in (rally.points if rally is not None else ()))]
        if status is None or status.mode != Mode.MODE_RETURN or self._chosen not in places:
            self._chosen = min(places, key=lambda place: math.dist(place, here))
        return self._chosen


def choose(status: VehicleStatus | None, errand: Errand | None, target: Point | None, orders: Orders) -> Job:
    """The job that follows from status, errand and mission; target: position (x, y) [m, world] of the current item, if any."""
    if status is not None and status.mode == Mode.MODE_RETURN:
        return Job("return", orders.return_point)
    if errand is not None:
        return Job(errand.name, errand.goal.point, errand.goal.yaw, errand.via, is_errand=True, leader=errand.leader)
    if target is not None:
        return Job("mission", target)
    return EXPLORE if orders.explores else IDLE


def home_of(status: VehicleStatus | None) -> Point | None:
    """Home (x, y) [m, world]; None while the autopilot has not reported it."""
    return (status.home.x, status.home.y) if status is not None and status.HasField("home") else None


def not_now(status: VehicleStatus | None) -> str:
    """Why a person's goal cannot be driven to in the vehicle's state; "" if it can."""
    if status is None:
        return "the autopilot is silent"
    if status.stopped:
        return "STOP ALL is engaged: release it first"
    if not status.armed:
        return "the vehicle is disarmed: arm it first"
    if status.mode != Mode.MODE_MISSION:
        return f"the mode is {mode_name(status.mode)}: change it to MISSION first"
    return ""
