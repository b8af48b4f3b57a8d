"""Modes of flight: what is flown now, and which changes are allowed."""

import math
from collections.abc import Sequence
from dataclasses import astuple, dataclass
from enum import Enum

from services.autopilot.air.by_hand import COMMAND_MAX_AGE, LET_GO, Hand, Stick
from services.autopilot.air.commands import Surfaces, Wanted
from services.autopilot.air.control import Control
from services.autopilot.air.guidance import Aim, Steering
from services.autopilot.air.navigator import Navigator
from services.autopilot.air.params import AirParams
from services.autopilot.air.plan import Item, fault
from services.autopilot.air.route import Circle, Level, Place
from services.autopilot.air.state import Estimate


class FlightMode(Enum):
    HOLD = "Hold"
    MISSION = "Mission"
    RETURN = "Return"
    MANUAL = "Manual"


@dataclass(frozen=True, slots=True)
class Flown:
    """What a cycle came to."""

    surfaces: Surfaces
    aim: Aim
    level: Level


@dataclass(frozen=True, slots=True)
class Stand:
    """Where in a mission an aircraft is; index None: not begun."""

    index: int | None
    reached: int
    laps: int
    finished: bool


class Pilot:
    """Holds, flies the mission, returns or lets somebody fly by hand. Requests give the reason of a refusal, empty when accepted."""

    def __init__(self, items: Sequence[Item], ground: float = 0.0) -> None:
        """ground: height [m] of home, which lies on the ground below the start."""
        self._ground = ground
        self.navigator = Navigator(items)
        self.mode = FlightMode.MISSION if items else FlightMode.HOLD
        self.reason = "start"
        self.stopped = ""
        self._blind = False
        self.home: Place | None = None
        self.circle: Circle | None = None
        self._stick = Stick()
        self._control = Control()
        self._steering = Steering()
        self._level = Level(math.nan)
        self._fresh = True

    def step(self, now: Estimate, params: AirParams, dt: float) -> Flown:
        if self._fresh:
            self._begin(now)
        if self.mode is FlightMode.MISSION and (self.navigator.returns_home or self.navigator.finished):
            self._end_mission()
        if self.mode is FlightMode.MANUAL and (flown := self._by_hand(now, params)) is not None:
            return flown
        if self.mode is FlightMode.MISSION:
            aim, self._level = self.navigator.step(now, params, dt)
            speed = self.navigator.speed or params.trim_airspeed
        else:
            self.circle = self.circle or self._new_circle(now, params)
            aim, self._level = self.circle.aim(now, params), Level(self.circle.centre.height)
            speed = params.trim_airspeed
        bank = self._steering.bank(aim, now, params, dt)
        level = self._level if now.height_known else Level(now.height)
        surfaces = self._control.step(now, Wanted(bank, level.height, level.climb, speed), params, dt)
        return Flown(surfaces, aim, self._level)

    def hear(self, hand: Hand | None, airborne: bool, dt: float) -> None:
        """Before each step: what is asked by hand, None = nothing fresh."""
        self._stick.hold(hand, airborne, dt)

    def rest(self) -> None:
        """Standing still it learns nothing: the loops begin anew."""
        self._control, self._steering = Control(), Steering()

    @property
    def source(self) -> str:
        """Whose commands reach the surfaces."""
        if self.mode is not FlightMode.MANUAL or self._stick.hand is None:
            return "autopilot"
        return self._stick.hand.source

    def _by_hand(self, now: Estimate, params: AirParams) -> Flown | None:
        """As the hand asks; None while it is waited for, and once the autopilot has taken over."""
        stick, aim = self._stick, Aim(0.0, now.course, 0.0, params.k_path, params.chi_inf)
        self._level = Level(now.height)
        if stick.hand is not None:
            self.circle = None
            return Flown(stick.hand.surfaces, aim, self._level)
        if not stick.airborne:
            return Flown(LET_GO, aim, self._level)
        if stick.abandoned:
            self._change(FlightMode.HOLD, f"no command by hand for {COMMAND_MAX_AGE:g} s")
            self._level = Level(max(now.height, params.min_altitude))
        return None

    def _begin(self, now: Estimate) -> None:
        self._fresh = False
        self.home = self.home or Place(now.north, now.east, self._ground)
        self._level = Level(now.height)
        if self.mode is FlightMode.MISSION:
            self.navigator.resume()

    def take_up(self, mode: FlightMode, home: Place, stand: Stand) -> None:
        """Before the first step: goes on for an instance that has died."""
        self.mode, self.home, self.reason = mode, home, "started again"
        self.navigator.take_up(stand.index, stand.reached, stand.laps, stand.finished)

    def _end_mission(self) -> None:
        if self.navigator.returns_home:
            self._change(FlightMode.RETURN, "mission: return")
            return
        self._change(FlightMode.HOLD, "mission complete")

    def _new_circle(self, now: Estimate, params: AirParams) -> Circle:
        if self.mode is FlightMode.RETURN and self.home is not None:
            height = max(self._level.height, params.return_altitude)
            return Circle(Place(self.home.north, self.home.east, height), params.hold_radius)
        return Circle.ahead(now, self._level.height, params.hold_radius)

    @property
    def blocked(self) -> str:
        """Why nothing but Hold may be asked for; empty if everything may."""
        return self._stop_blocks or ("GNSS is lost: wait until it is back" if self._blind else "")

    @property
    def _stop_blocks(self) -> str:
        return f"stopped by {self.stopped}: release the stop first" if self.stopped else ""

    def _change(self, mode: FlightMode, reason: str) -> None:
        self.mode, self.reason, self.circle = mode, reason, None
        self._stick.take()

    def change_mode(self, mode: FlightMode, source: str) -> str:
        blocked = self._stop_blocks if mode is FlightMode.MANUAL else self.blocked
        if blocked and mode is not FlightMode.HOLD:
            return blocked
        if mode is FlightMode.MISSION:
            if not self.navigator.items:
                return "there is no mission: upload one first"
            if not self._fresh:
                self._restart()
        self._change(mode, f"asked by {source}")
        return ""

    def _restart(self) -> None:
        """Goes on where the mission was left; from its beginning when it was complete."""
        if self.navigator.finished:
            self.navigator = Navigator(self.navigator.items)
        self.navigator.resume()

    def go_to(self, place: Place, source: str, params: AirParams) -> str:
        """Flies there and holds over it; too low a height means the present one."""
        if self.blocked:
            return self.blocked
        if not all(map(math.isfinite, astuple(place))):
            return "the goal is no place: its coordinates are not finite"
        height = place.height if place.height >= params.min_altitude else self._level.height
        self._change(FlightMode.HOLD, f"goal of {source}")
        self.circle = Circle(Place(place.north, place.east, height), params.hold_radius)
        return ""

    def load(self, items: Sequence[Item]) -> str:
        """Replaces the mission; while one is flown the new one is begun at once."""
        if why := fault(items):
            return why
        self.navigator = Navigator(items)
        if self.mode is FlightMode.MISSION:
            if not items:
                self._change(FlightMode.HOLD, "the mission was cleared")
            elif not self._fresh:
                self.navigator.resume()
        return ""

    def set_current(self, index: int) -> str:
        if index >= len(self.navigator.items):
            return f"there is no item {index}: the mission has {len(self.navigator.items)}"
        self.navigator.jump_to(index)
        return ""

    def stop(self, source: str) -> None:
        """STOP ALL: an airborne aircraft holds until it is released (an empty source)."""
        if source and not self.stopped:
            self._change(FlightMode.HOLD, f"stopped by {source}")
        elif self.stopped and not source:
            self.reason = "stop released"
        self.stopped = source

    def fly_blind(self, blind: bool) -> None:
        """Without GNSS for long it holds where it reckons to be, and goes on holding when GNSS is back, until told."""
        by_hand = self.mode is FlightMode.MANUAL  # which needs no satellites
        if blind and not self._blind and not self.stopped and not by_hand:
            self._change(FlightMode.HOLD, "GNSS lost: holds by dead reckoning")
        elif self._blind and not blind and not self.stopped and not by_hand:
            self.reason = "GNSS back: holds until a mode is asked for"
        self._blind = blind
