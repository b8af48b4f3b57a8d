"""THE TABLE of the modes of flight: what each needs, where it falls when that fails, and what follows when it is done."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum


class FlightMode(Enum):
    """The modes by the names that people see."""

    MANUAL = "Manual"
    STABILIZED = "Stabilized"
    ALTITUDE = "Altitude"
    POSITION = "Position"
    TAKEOFF = "Takeoff"
    MISSION = "Mission"
    HOLD = "Hold"
    ORBIT = "Orbit"
    RETURN = "Return"
    LAND = "Land"
    OFFBOARD = "Offboard"
    FOLLOW = "Follow"


@dataclass(frozen=True, slots=True)
class Situation:
    """What guards look at."""

    airborne: bool = True
    position_known: bool = True
    has_mission: bool = False
    setpoint: bool = False
    """Somebody sends setpoints from outside."""
    stopped: str = ""
    """Who has stopped the aircraft."""
    led: bool = False
    """The aircraft has a leader, which is heard."""
    wheels: bool = True
    """It takes off and lands by itself."""


class Need(Enum):
    """Why a mode is refused without it."""

    RELEASED = "stopped by {stopped}: release the stop first"
    POSITION = "GNSS is lost: wait until it is back"
    AIRBORNE = "the aircraft is on the ground: take off first"
    GROUND = "the aircraft is flying: it can only take off from the ground"
    MISSION = "there is no mission: upload one first"
    SETPOINT = "no program sends setpoints: they have to come before this mode, as client, offboard or mavlink"
    WHEELS = "an airship neither takes off nor lands by itself"
    LEADER = "there is no leader to follow, or nothing is heard of it: see 'follow' of the mission's job"

    def is_met(self, now: Situation) -> bool:
        """Whether the need is met now."""
        return {
            Need.RELEASED: not now.stopped,
            Need.POSITION: now.position_known,
            Need.AIRBORNE: now.airborne,
            Need.GROUND: not now.airborne,
            Need.MISSION: now.has_mission,
            Need.SETPOINT: now.setpoint,
            Need.LEADER: now.led,
            Need.WHEELS: now.wheels,
        }[self]


@dataclass(frozen=True, slots=True)
class ModeRule:
    """needs: to be asked for, in the order in which refusals are told; keeps: those whose loss ends it."""

    needs: tuple[Need, ...] = ()
    keeps: tuple[Need, ...] = ()
    without: FlightMode = FlightMode.HOLD
    """What follows when one of ``keeps`` is lost."""
    done: FlightMode | None = None
    """What follows when it has come to its end; None: it has none."""
    is_manual: bool = False
    """It is steered by a stick; when nobody holds that the aircraft circles, and a failsafe follows."""
    on_ground: bool = False
    """It moves an aircraft that stands; in all other modes that keeps its brakes on and its motor off."""


_FLYING = (Need.RELEASED, Need.AIRBORNE, Need.POSITION)
_HERE = (Need.POSITION,)
_M = FlightMode

TABLE: Mapping[FlightMode, ModeRule] = {
    _M.MANUAL: ModeRule((Need.RELEASED,), is_manual=True, on_ground=True),
    _M.STABILIZED: ModeRule((Need.RELEASED,), is_manual=True, on_ground=True),
    _M.ALTITUDE: ModeRule((Need.RELEASED, Need.AIRBORNE), is_manual=True),
    _M.POSITION: ModeRule(_FLYING, _HERE, without=_M.ALTITUDE, is_manual=True),
    _M.TAKEOFF: ModeRule((Need.RELEASED, Need.WHEELS, Need.GROUND, Need.POSITION), done=_M.HOLD, on_ground=True),
    _M.MISSION: ModeRule((Need.RELEASED, Need.POSITION, Need.MISSION), _HERE, done=_M.HOLD, on_ground=True),
    _M.HOLD: ModeRule(),
    _M.ORBIT: ModeRule(_FLYING, _HERE),
    _M.RETURN: ModeRule(_FLYING, _HERE, done=_M.LAND),
    _M.LAND: ModeRule((*_FLYING, Need.WHEELS), _HERE, done=_M.HOLD),
    _M.OFFBOARD: ModeRule((Need.RELEASED, Need.AIRBORNE, Need.SETPOINT), (Need.SETPOINT,)),
    _M.FOLLOW: ModeRule((*_FLYING, Need.LEADER), (Need.POSITION, Need.LEADER)),
}


def refusal(mode: FlightMode, now: Situation) -> str:
    """Why this mode may not be asked for now; empty if it may."""
    for need in TABLE[mode].needs:
        if not need.is_met(now):
            return need.value.format(stopped=now.stopped)
    return ""


def lost(mode: FlightMode, now: Situation) -> Need | None:
    """What this mode lives on and has no longer."""
    return next((need for need in TABLE[mode].keeps if not need.is_met(now)), None)
