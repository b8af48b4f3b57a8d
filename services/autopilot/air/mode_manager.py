"""Which mode is flown: requests, what they are refused for, and what follows when a mode ends or loses what it needs."""

import math
from collections.abc import Sequence
from dataclasses import astuple, replace

from services.autopilot.air.active_mode import ROLLS_OUT, ActiveMode
from services.autopilot.air.fence_guard import FenceGuard
from services.autopilot.air.flight_controller import FlightController
from services.autopilot.air.mode_table import TABLE, FlightMode, Need
from services.autopilot.air.modes.airspeed import LeaderSpeedFilter
from services.autopilot.air.modes.beginnings import ModeContext, begin
from services.autopilot.air.modes.descent import DescendMode
from services.autopilot.air.modes.field import Airfield
from services.autopilot.air.modes.follower import FormationLink
from services.autopilot.air.modes.mission_flight import MissionMode
from services.autopilot.air.modes.offboard import OLDEST
from services.autopilot.air.modes.paths import OWN, LoiterOptions, OrbitMode, PathMode
from services.autopilot.air.modes.return_mode import return_point
from services.autopilot.air.modes.takeoff import TakeoffMode
from services.autopilot.air.setpoints import STICK_RELEASED, ControlOutput, FlightContext, FlightPhase, PathSetpoint, Setpoint
from uvf.control.commands import AltitudeAirspeedSetpoint
from uvf.control.servos import SERVOS, Servos
from uvf.estimation.state import Estimate
from uvf.guidance.flight_plan import PlanItem, PlanProgress
from uvf.guidance.flyable import fault
from uvf.guidance.plan_follower import PlanFollower
from uvf.guidance.route import AltitudeProfile, Circle, Place
from uvf.guidance.runways import LandingStrip
from uvf.guidance.vector_field import PathReference
from uvf.models.vehicle.flight_params import AirParams

BACK = "GNSS back: holds until a mode is asked for"


class ModeManager(ActiveMode):
    """Flies one mode of the table. Requests give the reason of a refusal, empty when accepted."""

    def __init__(
        self, items: Sequence[PlanItem], ground: float = 0.0, strips: Sequence[LandingStrip] = (), servos: Servos = SERVOS
    ) -> None:
        """ground: height [m] of home, which lies on the ground below the start."""
        super().__init__(FlightMode.MISSION if items else FlightMode.HOLD, PlanFollower(items))
        self._ground = ground
        self._field = Airfield(strips)
        self.disarms = False
        """The motor has nothing more to do: whoever arms takes notice and resets this."""
        self.leads: LeaderSpeedFilter | None = None
        """Of an aircraft that others follow."""
        self._servos = servos
        self.fence = FenceGuard()
        self._flight_controller = FlightController(self._servos, self.fence)
        self._level = AltitudeProfile(math.nan)
        self._fresh = True

    def step(self, now: Estimate, params: AirParams, dt: float) -> ControlOutput:
        """One cycle of ``dt`` [s]: whether the mode goes on, what it asks for, and the surfaces that carry it out."""
        if self._fresh:
            self._begin(now)
        self._look(now, params)
        if self._stands:
            self._flight_controller = FlightController(self._servos, self.fence)
            return ControlOutput(STICK_RELEASED, self._straight_on(now, params), self._level)
        phase = self._phase = self._phase or self._begun(now, params)
        self._set_speed(now, params)
        self.shutter.step((now.north, now.east))
        return self._flown(phase.step(now, params, dt), now, params, dt)

    def hear(self, context: FlightContext, dt: float) -> None:
        """Takes what is known beside the estimate, before each step of ``dt`` [s]."""
        self.context.update(context)
        self._stick.hold(context.hand, dt)

    def _set_speed(self, now: Estimate, params: AirParams) -> None:
        part = self._part
        if isinstance(part, PathMode):
            self.navigator.speed = self.speed_override.of(now, params, self.navigator.speed)
        elif isinstance(part, OrbitMode):
            part.airspeed = self.speed_override.of(now, params, part.airspeed)

    def join(self, formation: FormationLink) -> None:
        """Before the first step: follows from the start on."""
        self.formation, self.mode = formation, FlightMode.FOLLOW

    def _look(self, now: Estimate, params: AirParams) -> None:
        """Whether this mode goes on."""
        if self.mode is FlightMode.MISSION:
            self._phase = self._phase or self._begun(now, params)
        if isinstance(self._phase, TakeoffMode) and self._climb_to is None and self.home is not None:
            self._phase.height = self.home.height + params.takeoff_alt
        if isinstance(self._phase, MissionMode):
            self._phase.look(now, params)
        self._move_home(now)
        if self.landing is not None and self.landing.told:
            self.reason, self.landing.told = self.landing.told, ""
        if self._phase is not None and self._phase.ended:
            self._end(self._phase)
        if TABLE[self.mode].is_manual:
            self._look_at_stick()
        if self.formation is not None:
            self._look_at_leader(self.formation)
        if Need.SETPOINT in TABLE[self.mode].keeps and self.context.setpoint is None:
            self._change(TABLE[self.mode].without, f"no setpoint for {OLDEST:g} s")

    def _look_at_leader(self, formation: FormationLink) -> None:
        """Without a leader it holds; once the leader is back it follows again, unless it has been told something else."""
        if self.mode is FlightMode.FOLLOW and formation.is_lost:
            self._change(FlightMode.HOLD, formation.lost_reason)
        elif self.mode is FlightMode.HOLD and self.reason == formation.lost_reason:
            self.change_mode(FlightMode.FOLLOW, "autopilot", formation.reason)
        if self.mode is FlightMode.FOLLOW and formation.is_led:
            self.reason = formation.reason

    def _look_at_stick(self) -> None:
        """Before the first command and after the last one the autopilot circles; the failsafe ``sticks`` may order more."""
        if isinstance(self._phase, OrbitMode) == (self.context.hand is not None):
            self._phase = None

    def _begun(self, now: Estimate, params: AirParams) -> FlightPhase:
        """The present mode from its beginning."""
        assert self.home is not None
        to = self.return_point(now, params) if self.mode is FlightMode.RETURN else None
        height, climb_to = self._level.height, self._climb_to
        return begin(
            self.mode,
            ModeContext(
                now, params, self.home, self.navigator, self._field, self.context, height, climb_to, to, self.rally, self.formation
            ),
        )

    def _flown(self, wish: Setpoint, now: Estimate, params: AirParams, dt: float) -> ControlOutput:
        if self.leads is not None and isinstance(self._part, OrbitMode | PathMode):
            wish = self.leads.step(wish, now, params, dt)
        asked = wish.asked
        aim = asked.aim if isinstance(asked, PathSetpoint) else self._straight_on(now, params)
        height = asked.height if isinstance(asked, PathSetpoint | AltitudeAirspeedSetpoint) else None
        self._level = AltitudeProfile(
            now.height if height is None else height, asked.climb if isinstance(asked, PathSetpoint | AltitudeAirspeedSetpoint) else 0.0
        )
        return ControlOutput(
            self._flight_controller.step(now, wish, params, dt),
            aim,
            self._level,
            self._flight_controller.attitude,
            self._flight_controller.airspeed,
        )

    @staticmethod
    def _straight_on(now: Estimate, params: AirParams) -> PathReference:
        return PathReference(0.0, now.course, 0.0, params.k_path, params.chi_inf)

    def _begin(self, now: Estimate) -> None:
        self._fresh = False
        self.home = self.home or Place(now.north, now.east, self._ground)
        self._level = AltitudeProfile(now.height)
        if self.mode is FlightMode.MISSION:
            self.navigator.resume()

    def take_up(self, mode: FlightMode, home: Place, stand: PlanProgress) -> None:
        """Before the first step: goes on for an instance that has died."""
        self.mode, self.home, self.reason = mode, home, "started again"
        self.navigator.take_up(stand.index, stand.reached, stand.laps, stand.finished)

    def _end(self, phase: FlightPhase) -> None:
        """What the table says follows."""
        becomes = phase.becomes if isinstance(phase, MissionMode) else None
        self.disarms = self.disarms or phase.disarms
        then, reason = becomes or TABLE[self.mode].done or FlightMode.HOLD, phase.ended
        if then is FlightMode.LAND and not self.has_wheels:
            then, reason = FlightMode.HOLD, Need.WHEELS.value
        self._change(then, reason)

    def return_point(self, now: Estimate, params: AirParams) -> Place | None:
        """Where Return would lead now."""
        return return_point(now, self.home, self.rally, self.fence.fencing, params) if self.home is not None else None

    def change_mode(self, mode: FlightMode, source: str, reason: str = "") -> str:
        """reason: what the status tells; by default who asked."""
        if why := self._refused(mode):
            return why
        if mode is FlightMode.MISSION and not self._fresh:
            self._restart()
        self._change(mode, reason or f"asked by {source}")
        return ""

    def _restart(self) -> None:
        """Goes on where the mission was left; from its beginning when it was complete."""
        if self.navigator.finished:
            self.navigator = PlanFollower(self.navigator.items)
        self.navigator.resume()

    def take_off(self, height: float, source: str) -> str:
        """Mode Takeoff up to ``height`` [m, world]."""
        if not (why := self.change_mode(FlightMode.TAKEOFF, source)):
            self._climb_to = height
        return why

    def settle(self, home: Place) -> None:
        """Home is there from now on; on its way to the old one it turns to the new one."""
        self.home = home
        if self.mode is FlightMode.RETURN:
            self._phase = None

    def _move_home(self, now: Estimate) -> None:
        """As items of the mission say that have been passed; "here" is on the ground that home had before."""
        for item in self.navigator.homes:
            self.settle(Place(now.north, now.east, self.home.height if self.home else self._ground) if item.here else item.place)
        self.navigator.homes.clear()

    def go_to(self, place: Place, source: str, params: AirParams, how: LoiterOptions = OWN) -> str:
        """Flies there and holds over it; too low a height means the present one."""
        if self.blocked:
            return self.blocked
        if not all(map(math.isfinite, astuple(place))):
            return "the goal is no place: its coordinates are not finite"
        if why := how.fault(params):
            return why
        height = place.height if place.height >= params.min_altitude else self._level.height
        self._change(FlightMode.HOLD, f"goal of {source}")
        self._phase = OrbitMode(Circle(Place(place.north, place.east, height), how.radius or params.hold_radius), how)
        if how.airspeed:
            self.speed_override.begin(anew=True)
        return ""

    def descend(self, now: Estimate, reason: str, params: AirParams) -> None:
        """Mode Land without a position: down where it is."""
        if self.rolls_out or isinstance(self._phase, DescendMode):
            return
        circle = self.circle or Circle.ahead(now, now.height, params.hold_radius)
        self._change(FlightMode.LAND, reason)
        self._phase = DescendMode(circle, self.home.height if self.home is not None else self._ground, self.context)

    def orbit(self, circle: Circle, airspeed: float, source: str, params: AirParams) -> str:
        """Mode Orbit; a radius [m] or ``airspeed`` [m/s] of 0 is the vehicle's own."""
        if why := self._refused(FlightMode.ORBIT):
            return why
        if not all(map(math.isfinite, astuple(circle.centre))):
            return "the circle is none: its numbers are not finite"
        how = LoiterOptions(circle.radius, airspeed)
        if why := how.fault(params):
            return why
        height = circle.centre.height if circle.centre.height >= params.min_altitude else self._level.height
        self._change(FlightMode.ORBIT, f"asked by {source}")
        place = replace(circle.centre, height=height)
        self._phase = OrbitMode(Circle(place, circle.radius or params.hold_radius), how)
        return ""

    def go_around(self, source: str) -> str:
        """Gives up the approach that is flown and begins it again."""
        if self.landing is None:
            return "there is no approach to be given up"
        if self.landing.rolls:
            return ROLLS_OUT
        self.landing.around(f"asked by {source}")
        return ""

    def load(self, items: Sequence[PlanItem], params: AirParams) -> str:
        """Replaces the mission; while one is flown the new one is begun at once."""
        if why := fault(items, params):
            return why
        self.navigator = PlanFollower(items)
        if self.mode is FlightMode.MISSION:
            self._phase = None
            if not items:
                self._change(FlightMode.HOLD, "the mission was cleared")
            elif not self._fresh:
                self.navigator.resume()
        return ""

    def set_current(self, index: int) -> str:
        """Goes on with the item ``index`` of the mission."""
        if index >= len(self.navigator.items):
            return f"there is no item {index}: the mission has {len(self.navigator.items)}"
        self.navigator.jump_to(index)
        return ""

    def stop(self, source: str) -> None:
        """STOP ALL: an airborne aircraft holds until it is released (an empty source)."""
        if source and not self.stopped and not self.rolls_out:
            self._change(FlightMode.HOLD, f"stopped by {source}")
        elif self.stopped and not source:
            self.reason = "stop released"
        self.stopped = source

    def fly_blind(self, blind: bool) -> None:
        """Without GNSS for long it holds where it reckons to be, and goes on holding when GNSS is back, until told.

        On the last metres of a landing it goes on by dead reckoning: to turn away there is worse.
        """
        row, was, self._blind = TABLE[self.mode], self._blind, blind
        needs, holds = Need.POSITION in row.keeps, self.mode is FlightMode.HOLD
        if self.stopped or self.rolls_out or self._settles or not (needs or holds):
            return
        if blind and not isinstance(self._phase, DescendMode) and (needs or not was):
            self._change(row.without, "GNSS lost: holds by dead reckoning" if row.without is FlightMode.HOLD else "GNSS lost")
        elif was and not blind and isinstance(self._phase, DescendMode):
            self._change(FlightMode.HOLD, BACK)
        elif was and not blind:
            self.reason = BACK
