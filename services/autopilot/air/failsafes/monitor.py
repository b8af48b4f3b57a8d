"""Keeps watch over an aircraft: gathers what the failsafes look at, and has the pilot do what they order."""

import math
from dataclasses import dataclass, field

from schemas.messages import Battery, Breach, Event, Fence, Link
from services.autopilot.air.failsafes.endurance import Endurance
from services.autopilot.air.failsafes.table import AIR_RULES, FailsafeInputs
from services.autopilot.air.fence_guard import FenceInForce, circle_within, in_force
from services.autopilot.air.mode_manager import ModeManager
from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.modes.paths import LoiterOptions
from services.autopilot.air.modes.return_mode import is_within
from services.autopilot.failsafes import FailsafeAction, FailsafeOrder, FailsafeWatch
from services.autopilot.link_watch import LinkWatch
from uvf.control.commands import Surfaces
from uvf.control.saturation import Saturation, eased
from uvf.control.servos import Servos
from uvf.estimation.air_data_check import AirDataCheck, FlightState
from uvf.estimation.sensor_inputs import Pressures
from uvf.estimation.state import Estimate
from uvf.guidance.fence_plan import fence_fit, mission_fault, tightest
from uvf.guidance.route import Circle, Place
from uvf.models.mission.fence import FenceAction
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.messages.plans.fences import fence_fault, fencing

RANK = {FlightMode.HOLD: FailsafeAction.HOLD, FlightMode.RETURN: FailsafeAction.RETURN, FlightMode.LAND: FailsafeAction.LAND}
FENCED = "fence", "breach"  # rows whose action is the fence's
FENCE_ACTIONS = {action: FailsafeAction[action.name] for action in FenceAction}


@dataclass(slots=True)
class VehicleCondition:
    """Of one cycle."""

    now: Estimate
    gnss_age: float  # s
    airborne: bool
    surfaces: Surfaces = field(default_factory=lambda: Surfaces(0.0, 0.0, 0.0, 0.0))


class FailsafeMonitor:
    """One aircraft's failsafes, with the pilot whom they order about."""

    def __init__(self, mode_manager: ModeManager, servos: Servos) -> None:
        self.watch = FailsafeWatch(AIR_RULES)
        self.endurance = Endurance()
        self.fence = Fence()
        """As it was set."""
        self.has_air_data = True
        self._mode_manager = mode_manager
        self._air_data = AirDataCheck()
        self._saturation = Saturation(servos)
        self._link = LinkWatch()
        self._lost_for = 0.0  # s
        self._was_blind = self._waits = False
        self._in_force = FenceInForce()
        self.breaches = 0
        """How often it has been outside of a fence."""
        self.must_land = False
        """A failsafe has ordered it down."""

    def hear(self, t: float, link: Link | None, battery: Battery | None) -> None:
        """Takes what comes from outside at ``t`` [s], before each step."""
        self.endurance.take(t, battery)
        self._link.step(t, link)

    def believed(self, read: tuple[object, Pressures] | None, flying: FlightState | None, params: AirParams, dt: float) -> Pressures | None:
        """The pressures (with their stamp) as far as they can be believed, in a cycle of ``dt`` [s]."""
        pressures = self._air_data.step(read, flying, params, dt)
        self.has_air_data = pressures is not None
        return pressures

    @property
    def blind(self) -> bool:
        """Whether modes that need a position are not to be flown."""
        return "estimator" in self.watch.holding

    @property
    def breach(self) -> Breach:
        """How it is outside of its fence."""
        return self._mode_manager.fence.outlook.breach if "breach" in self.watch.holding else Breach.BREACH_NONE

    @property
    def texts(self) -> list[str]:
        """What is wrong now."""
        return [rule.raised_text for rule in self.watch.holding.values()]

    def demands(self, params: AirParams) -> AirParams:
        """What may be asked of the aircraft now."""
        return eased(params) if "saturation" in self.watch.holding else params

    def step(self, t: float, seen: VehicleCondition, params: AirParams, dt: float) -> list[Event]:
        """One cycle of ``dt`` [s] at ``t`` [s], before the mode manager's step; ``seen.surfaces`` are those of the cycle before."""
        self._saturation.step(seen.surfaces, dt)
        if not self._mode_manager.is_blind:
            self._lost_for = 0.0
        elif not self._mode_manager.is_manual:
            self._lost_for += dt
        self._keep_fence(params)
        known = self._known(seen, params)
        changes, order = self.watch.step(known, dt)
        in_force = self.watch.in_force(known)
        self.must_land = in_force is not None and in_force.action >= FailsafeAction.LAND
        self.breaches += any(change.began and change.rule.name == "breach" for change in changes)
        committed = self._mode_manager.is_committed(seen.now)
        if self._mode_manager.is_blind != self._was_blind or (self._waits and not committed):
            # What was ordered may have been given up for want of a position, or may be carried out by now.
            self._was_blind, self._waits = self._mode_manager.is_blind, False
            order = order or in_force
        if order is not None and committed:
            self._waits = True
        elif order is not None and seen.airborne:
            self._obey(order, seen.now, params)
        return [change.event(t) for change in changes]

    def _known(self, seen: VehicleCondition, params: AirParams) -> FailsafeInputs:
        self._mode_manager.fence.grounds = not seen.airborne or self._mode_manager.goes_down
        now, outlook = seen.now, self._mode_manager.fence.look(seen.now, self.demands(params))
        stop, stopped_for = self._saturation.worst
        return FailsafeInputs(
            params=params,
            airborne=seen.airborne,
            silence=self._link.silence,
            stick_released=self._mode_manager.is_manual_control_lost,
            gnss_age=seen.gnss_age,
            sigma=now.position_sigma,
            lost_for=self._lost_for,
            has_air_data=self.has_air_data,
            pitot_gap=self._air_data.gap,
            charge=self.endurance.charge,
            spare=self.endurance.spare(now, self._mode_manager.return_point(now, params), params) if seen.airborne else math.inf,
            fence=outlook.spare(params),
            breached=outlook.breached,
            fence_action=FENCE_ACTIONS[self._mode_manager.fence.fencing.action],
            stop=stop,
            stopped_for=stopped_for,
            roll=now.roll,
            pitch=now.pitch,
            lands=self._mode_manager.landing is not None,
            wind=math.hypot(now.wind_north, now.wind_east),
        )

    def _obey(self, order: FailsafeOrder[FailsafeInputs], now: Estimate, params: AirParams) -> None:
        """The mode ordered, or the next best; one that goes as far already stays."""
        mode_manager, reason = self._mode_manager, order.rule.raised_text
        outside = order.rule.name in FENCED and order.action and self._circles_outside(params)
        if RANK.get(mode_manager.mode, FailsafeAction.WARN) >= order.action and not outside:
            return
        if mode_manager.is_blind and order.action is FailsafeAction.LAND:
            mode_manager.descend(now, reason, params)
            return
        if order.rule.name in FENCED and order.action is FailsafeAction.RETURN and self._return_point(reason, params):
            return
        wanted = [mode for mode, rank in RANK.items() if rank <= order.action and self._may(mode, now, params)]
        for mode in sorted(wanted, key=lambda m: -RANK[m]):
            if mode is FlightMode.HOLD and self._hold_within(now, reason, params):
                return
            if not mode_manager.change_mode(mode, "failsafe", reason):
                return

    def _circles_outside(self, params: AirParams) -> bool:
        """Holding where it does leads out of the fence."""
        circling = self._mode_manager.circling
        return circling is not None and not is_within(circling.circle, self._mode_manager.fence.fencing, params)

    def _may(self, mode: FlightMode, now: Estimate, params: AirParams) -> bool:
        """Not home, where neither home nor a rally point is within the fence."""
        to = self._mode_manager.return_point(now, params)
        return mode is FlightMode.HOLD or to is None or is_within(Circle(to, params.hold_radius), self._mode_manager.fence.fencing, params)

    def _return_point(self, reason: str, params: AirParams) -> bool:
        """To the place that the fence itself names."""
        to = self._mode_manager.fence.fencing.return_point
        if to is None or self._mode_manager.go_to(Place(to[1], to[0], to[2]), "the failsafe", params):
            return False
        self._mode_manager.reason = reason
        return True

    def _hold_within(self, now: Estimate, reason: str, params: AirParams) -> bool:
        """On a circle that lies within the fence, if there is a fence and room for one."""
        fence = self._mode_manager.fence.fencing
        if fence.is_open or not fence.steers:
            return False
        here = Place(now.north, now.east, now.height)
        for radius in (0.0, tightest(params)):
            circle = circle_within(fence, here, radius or params.hold_radius, params)
            if circle is not None and not self._mode_manager.go_to(circle.centre, "the failsafe", params, LoiterOptions(radius)):
                self._mode_manager.reason = reason
                return True
        return False

    def _keep_fence(self, params: AirParams) -> None:
        found = self._in_force.of(self.fence, self._mode_manager.home, params)
        if found is not self._mode_manager.fence.fencing:
            self._mode_manager.fence.take(found)

    def set_fence(self, fence: Fence, seen: VehicleCondition | None, params: AirParams) -> str:
        """Why it is refused; empty if it is in force from now on."""
        new = fencing(fence)
        here = Place(seen.now.north, seen.now.east, seen.now.height) if seen is not None else None
        why = fence_fault(fence) or fence_fit(new, here, seen is not None and seen.airborne, params)
        kept = new if why else in_force(fence, self._mode_manager.home, params)
        if not why and (item := mission_fault(self._mode_manager.navigator.items, kept, params)):
            why = f"the mission does not lie within it: {item}"
        if not why:
            self.fence = fence
            self._keep_fence(params)
        return why
