"""A mission as a list of items, and which item is flown next."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from types import MappingProxyType

from uvf.guidance.route import Place


class ItemKind(Enum):
    """Kind of a mission item."""

    WAYPOINT = "waypoint"
    ORBIT = "orbit"
    RETURN = "return"
    JUMP = "jump"
    SPEED = "speed"
    TRIGGER = "trigger"
    TRIGGER_DISTANCE = "trigger_distance"
    TAKEOFF = "takeoff"
    LAND = "land"
    LAND_START = "land_start"
    SET_HOME = "set_home"


OFF_PATH = (ItemKind.RETURN, ItemKind.TAKEOFF, ItemKind.LAND)
"""What is not flown along legs and circles."""


@dataclass(frozen=True, slots=True)
class PlanItem:
    """One item of a mission; which fields count depends on the kind (see mission.proto).

    An acceptance radius limits how far from a waypoint the corner may be rounded; the waypoint counts as reached where the corner begins.
    """

    kind: ItemKind
    place: Place
    hold: float = 0.0  # s
    radius: float = 0.0  # m, positive clockwise
    turns: float = 0.0
    speed: float = 0.0  # m/s; SPEED: 0 = cruise again
    jump_to: int = 0
    repeat: int = 0
    course: float | None = None  # rad, over ground, from north clockwise
    acceptance: float = math.inf  # m
    to_altitude: bool = False
    distance: float = 0.0  # m
    here: bool = False

    @property
    def flies_through(self) -> bool:
        """Whether it is a waypoint that is passed without holding."""
        return self.kind is ItemKind.WAYPOINT and self.hold == 0

    def is_at(self, place: Place) -> bool:
        """Whether it asks for nothing more than to pass this place."""
        away = math.hypot(self.place.north - place.north, self.place.east - place.east)
        return self.flies_through and self.course is None and away < ONE_PLACE


@dataclass(frozen=True, slots=True)
class PlanProgress:
    """Progress of an aircraft in a mission; index None: not begun."""

    index: int | None
    reached: int
    laps: int
    finished: bool


DEEDS = (ItemKind.TRIGGER, ItemKind.TRIGGER_DISTANCE, ItemKind.SET_HOME)
ONE_PLACE = 1.0  # m, between waypoints that are taken for one
NO_JUMPS: Mapping[int, int] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class NextItem:
    """The item flown next (None: the end) and what was passed on the way to it."""

    index: int | None
    jumps: Mapping[int, int]  # jump item -> how often it has been taken
    laps: int  # jumps taken now
    speed: float | None  # m/s, 0 = cruise, None = unchanged
    deeds: tuple[int, ...] = ()  # items that are carried out in passing


def next_stop(items: Sequence[PlanItem], index: int, jumps: Mapping[int, int]) -> NextItem:
    """The next item to fly, from ``index`` on past speed changes, actions, marks and jumps.

    Jumps without anything to fly between them end the mission.
    """
    taken, laps = dict(jumps), 0
    speed: float | None = None
    deeds: tuple[int, ...] = ()
    for _ in range(2 * len(items) + 1):
        if index >= len(items):
            return NextItem(None, taken, laps, speed, deeds)
        item = items[index]
        if item.kind is ItemKind.SPEED:
            speed, index = item.speed, index + 1
        elif item.kind in DEEDS:
            deeds, index = (*deeds, index), index + 1
        elif item.kind is ItemKind.LAND_START:
            index += 1
        elif item.kind is ItemKind.JUMP:
            if 0 <= item.repeat <= taken.get(index, 0):
                index += 1
            else:
                taken[index] = taken.get(index, 0) + 1
                laps, index = laps + 1, item.jump_to
        else:
            return NextItem(index, taken, laps, speed, deeds)
    return NextItem(None, taken, laps, speed, deeds)


def following(items: Sequence[PlanItem], stop: NextItem) -> NextItem:
    """The item to fly after that of ``stop``: waypoints at the same place that are flown through are passed with it."""
    assert stop.index is not None
    here, found = items[stop.index], next_stop(items, stop.index + 1, stop.jumps)
    for _ in items:
        if found.index is None or not (here.flies_through and items[found.index].is_at(here.place)):
            break
        more = next_stop(items, found.index + 1, found.jumps)
        speed = found.speed if more.speed is None else more.speed
        found = NextItem(more.index, more.jumps, found.laps + more.laps, speed, found.deeds + more.deeds)
    return found
