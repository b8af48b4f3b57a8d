"""A mission as a list of items, and which item is flown next."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from types import MappingProxyType

from services.autopilot.air.route import Place


class Kind(Enum):
    WAYPOINT = "waypoint"
    ORBIT = "orbit"
    RETURN = "return"
    JUMP = "jump"
    SPEED = "speed"


@dataclass(frozen=True, slots=True)
class Item:
    """One line of a mission; which fields count depends on the kind (see mission.proto).

    An acceptance radius is not among them: a waypoint is passed when its half plane is, or where the arc round it begins.
    """

    kind: Kind
    place: Place
    hold: float = 0.0  # s
    radius: float = 0.0  # m, positive clockwise
    turns: float = 0.0
    speed: float = 0.0  # m/s
    jump_to: int = 0
    repeat: int = 0

    @property
    def flies_through(self) -> bool:
        return self.kind is Kind.WAYPOINT and self.hold == 0


NO_JUMPS: Mapping[int, int] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class Stop:
    """The item flown next (None: the end) and what was passed on the way to it."""

    index: int | None
    jumps: Mapping[int, int]  # jump item -> how often it has been taken
    laps: int  # jumps taken now
    speed: float  # m/s, 0 = unchanged


def next_stop(items: Sequence[Item], index: int, jumps: Mapping[int, int]) -> Stop:
    """From ``index`` on past speed changes and jumps; jumps without anything to fly between them end the mission."""
    taken, laps, speed = dict(jumps), 0, 0.0
    for _ in range(2 * len(items) + 1):
        if index >= len(items):
            return Stop(None, taken, laps, speed)
        item = items[index]
        if item.kind is Kind.SPEED:
            speed, index = item.speed, index + 1
        elif item.kind is Kind.JUMP:
            if 0 <= item.repeat <= taken.get(index, 0):
                index += 1
            else:
                taken[index] = taken.get(index, 0) + 1
                laps, index = laps + 1, item.jump_to
        else:
            return Stop(index, taken, laps, speed)
    return Stop(None, taken, laps, speed)


def fault(items: Sequence[Item]) -> str:
    """Why a list of items cannot be flown; empty if it can."""
    for i, item in enumerate(items):
        if item.kind is Kind.JUMP and item.jump_to >= len(items):
            return f"item {i} jumps to {item.jump_to}, but there are {len(items)} items"
        if item.kind is Kind.SPEED and item.speed <= 0:
            return f"item {i} sets a speed of {item.speed:g} m/s"
    return ""
