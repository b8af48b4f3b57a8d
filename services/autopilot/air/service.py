"""The autopilot of one fixed-wing aircraft, alone or behind a leader: sensors and requests in, surfaces, estimates and reports out."""

from dataclasses import replace

from schemas import topics
from schemas.messages import (
    ArmRequest,
    GoalRequest,
    Mode,
    ModeRequest,
    NavState,
    OrbitRequest,
    Reply,
    VehicleCommandRequest,
    VehicleStatus,
)
from services.autopilot.air import interface
from services.autopilot.air.config import AutopilotConfig
from services.autopilot.air.failsafes.monitor import FailsafeMonitor, VehicleCondition
from services.autopilot.air.failsafes.prearm import PrearmInputs, faults
from services.autopilot.air.failsafes.table import GNSS_HOLD
from services.autopilot.air.fence_guard import too_small
from services.autopilot.air.inputs import intake
from services.autopilot.air.inputs.external_control import ExternalControl
from services.autopilot.air.inputs.sensing import GroundProximity, SensorInputs, StateEstimation
from services.autopilot.air.mission import orders
from services.autopilot.air.mission.plans import ActivePlans
from services.autopilot.air.mode_manager import ModeManager
from services.autopilot.air.modes.airspeed import LeaderSpeedFilter
from services.autopilot.air.modes.follower import FormationLink
from services.autopilot.air.modes.paths import LoiterOptions
from services.autopilot.air.setpoints import STICK_RELEASED, ControlOutput, FlightContext
from services.autopilot.air.status import telemetry
from services.autopilot.air.status.event_log import EventLog
from services.autopilot.multiplexing import DISARMED_OFFBOARD
from services.autopilot.parameter_state import ToldParams
from services.autopilot.safe_state import coming_down
from uvf.control.flight_control import level_trim
from uvf.estimation.landed import LandDetector
from uvf.estimation.state import Estimate
from uvf.guidance.fence_plan import CachedFenceCheck, place_fault
from uvf.guidance.flyable import advice
from uvf.guidance.route import Place
from uvf.models.vehicle.flight_params import FIXED, AirParams
from uvf.runtime.contract.declaration import each_vehicle
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.plans.plan_items import place_of, plan_items
from uvf.runtime.state.stop_all import StopStatus


class AutopilotAir(Service):
    """Hold, Mission and Return from IMU, air data and GNSS, and Manual; it never sees the truth. The only writer of the surfaces."""

    name = "autopilot_air"
    hz = 50.0

    Inputs = interface.Inputs
    Outputs = interface.Outputs
    Recalls = interface.Recalls

    fixed_params = FIXED
    params: AirParams

    def __init__(self, config: AutopilotConfig, params: AirParams) -> None:
        self.params = params
        self._config = config
        self._reboots = False
        self._told_params = ToldParams()
        self._armed = config.starts_in_air or config.starts_armed
        self._mode_manager = ModeManager(plan_items(config.items), config.ground, config.strips, config.servos)
        self._mode_manager.has_wheels = params.law != "airship"
        self._mode_manager.leads = LeaderSpeedFilter() if config.leads else None
        self._over_ground = GroundProximity(config.altimeter)
        self._within = CachedFenceCheck()
        self._safety = FailsafeMonitor(self._mode_manager, config.servos)
        self._safety.set_fence(config.fence, None, params)
        self._journal = EventLog()
        self._journal.new_mission(advice(self._mode_manager.navigator.items, params))
        self._plans = ActivePlans(config.items, self._mode_manager, self._safety, self._journal)
        self._sensing = StateEstimation(config.instruments, config.tangent, params.estimator, self._safety.believed)
        self._surfaces = STICK_RELEASED
        self._steering = ExternalControl()
        self._now: Estimate | None = None
        self._cycles = 0
        self._told: tuple[object, ...] = ()
        self._where: tuple[object, ...] = ()
        self._land = LandDetector(config.starts_in_air)
        self._status = VehicleStatus()
        self._stop = StopStatus()

    def step(self, t: float, now: interface.Inputs) -> interface.Outputs:
        """One cycle at simulation time ``t`` [s]."""
        if self._reboots:
            self._reboot()
        samples = [sample for m in now.imu if (sample := intake.inertial(m, t)) is not None]
        carried = self._land.airborne and not self._mode_manager.rolls_out
        estimate = self._sensing.step(t, SensorInputs(samples, now.air_data, now.gnss, carried), self.params, 1 / self.hz)
        self._now = estimate
        if estimate is None:
            return self._without_fix(t, now)
        if estimate.position_known or estimate.airspeed_known:
            self._land.step(estimate, self.params, 1 / self.hz)
        self._safety.hear(t, now.link, now.battery)
        warnings = self._safety.step(t, self._seen(estimate), self.params, 1 / self.hz)
        self._mode_manager.fly_blind(self._sensing.gnss_age > GNSS_HOLD or self._safety.blind)
        self._handle_stop_all(now.stop)
        out = self._answer(now, estimate)
        hands = {"teleop": now.teleop, "mavlink": now.mavlink, "client": now.client}
        setpoints = {"offboard": now.setpoint_offboard, "client": now.setpoint_client, "mavlink": now.setpoint_mavlink}
        self._steering.hear(t, hands, setpoints, self.params.stick_timeout)
        self._over_ground.hear(now.range, self._sensing.felt, 1 / self.hz)
        self._report(t, estimate, self._fly(t, estimate), out)
        out.events = warnings + self._journal.events(t, self._mode_manager, self._armed)
        self._tell_news(t, out)
        return out

    def _without_fix(self, t: float, now: interface.Inputs) -> interface.Outputs:
        """Nothing can be done yet; who asks for something hears why."""
        refused = {name: [_reply("there is no satellite fix yet") for _ in getattr(now, name)] for name in self.requests}
        out = self.Outputs()
        out.update(refused)
        self._tell_news(t, out)
        return out

    def _answer(self, now: interface.Inputs, estimate: Estimate) -> interface.Outputs:
        """What is asked of it, in the order in which the kinds of requests count."""
        out = self.Outputs()
        out.arm = [self._arm(r) for r in now.arm]
        out.mode = [self._set_mode(r) for r in now.mode]
        out.goal = [self._go_to(r) for r in now.goal]
        out.mission = [_reply(self._plans.set_mission(r.mission, self.params)) for r in now.mission]
        out.current = [_reply(self._mode_manager.set_current(r.index)) for r in now.current]
        out.orbit = [_reply(self._orbit(r)) for r in now.orbit]
        out.go_around = [_reply(self._mode_manager.go_around(r.source)) for r in now.go_around]
        out.order = [_reply(self._carry_out(r, estimate)) for r in now.order]
        out.fence = [_reply(self._plans.set_fence(r.fence, self._seen(estimate), self.params)) for r in now.fence]
        out.set_rally = [_reply(self._plans.set_rally(r.rally, self.params)) for r in now.set_rally]
        return out

    def _fly(self, t: float, now: Estimate) -> ControlOutput:
        clearance = self._over_ground.clearance(t, now, self.params.gear_height)
        felt = self._over_ground
        context = FlightContext(
            self._land.airborne,
            self._armed,
            None,
            self._config.servos,
            clearance,
            felt.specific_force_x,
            felt.specific_force_up,
            self._safety.must_land,
        )
        self._mode_manager.hear(self._steering.tell(context), 1 / self.hz)
        flown = self._mode_manager.step(now, self._safety.demands(self.params), 1 / self.hz)
        self._surfaces = flown.surfaces
        self._journal.note(self._steering.news(t, self._mode_manager))
        if self._mode_manager.disarms:
            self._mode_manager.disarms = self._armed = False
        return flown

    def _report(self, t: float, now: Estimate, flown: ControlOutput, out: interface.Outputs) -> None:
        """Surfaces and motion; what is told now and then, and the status also when it changes."""
        state = telemetry.nav_state(t, now)
        out.surfaces, out.nav_state = telemetry.surfaces(t, flown.surfaces, self._armed), state
        out.pose, out.body_frame = telemetry.pose(state), telemetry.body_frame(state, self._config.name)
        mode_manager = self._mode_manager
        told = (mode_manager.mode, mode_manager.reason, mode_manager.stopped, self._armed, self._steering.followed(mode_manager))
        if self._cycles % 5 == 0 or told != self._told:
            self._told = told
            self._status = telemetry.status(t, self._mode_manager, now, flown)
            self._status.battery_remaining, self._status.battery_voltage = self._safety.endurance.shown
            self._status.prearm.extend(self._faults())
            self._status.failsafes.extend(self._safety.texts)
            self._status.stops.extend(self._stop.engagements)
            self._status.breach, self._status.breaches = self._safety.breach, self._safety.breaches
            out.status = self._stamped_status(t)
        if self._cycles % 5 == 0:
            out.targets = telemetry.targets(t, self._mode_manager, flown)
        navigator = self._mode_manager.navigator
        where = (navigator.index, navigator.reached, navigator.laps, navigator.finished)
        if self._cycles % 25 == 0 or where != self._where:
            self._where = where
            out.progress = telemetry.progress(t, self._mode_manager, self._plans.mission.id)
        if self._cycles % 25 == 0:
            out.quality = telemetry.quality(t, now)
            out.path = telemetry.path(t, self._mode_manager)
        self._cycles += 1

    def recall(self, left: interface.Recalls) -> None:
        """Goes on in the mode, at the item, from the attitude and with the parameters where the instance before has been."""
        if left.params is not None:
            self.params = self._told_params.taken_up(left.params, self.params)
        if left.plan is not None:
            self._plans.set_mission(left.plan, self.params)
        if left.bounds is not None:
            self._plans.set_fence(left.bounds, None, self.params)
        if left.rally is not None:
            self._plans.set_rally(left.rally, self.params)
        if left.status is not None and left.status.mode in intake.MODES:
            self._armed = left.status.armed
            self._land = LandDetector(not left.status.landed)
            self._stop = StopStatus(tuple(left.status.stops))
            self._mode_manager.stopped = self._stop.who
            self._mode_manager.take_up(intake.MODES[left.status.mode], place_of(left.status.home), intake.stand(left.progress))
        if left.nav_state is not None:
            self._sensing.begin_from(left.nav_state)

    def stale(self, t: float, missing: tuple[str, ...]) -> interface.Outputs:
        """Without the IMU at ``t`` [s] nothing is steered: surfaces at trim until it is back; before the first cycle the servos hold."""
        if not self._cycles:
            out = self.Outputs()
            self._tell_news(t, out)
            return out
        self._status.reason = f"sensor lost: {', '.join(missing)}"
        return self.Outputs(
            surfaces=telemetry.surfaces(t, level_trim(self.params), self._armed and self._land.airborne),
            status=self._stamped_status(t),
            events=self._journal.lost(t, missing),
        )

    given_up = "its motor is off and it comes down in a turn"
    stand_in = staticmethod(coming_down)

    def _seen(self, now: Estimate) -> VehicleCondition:
        return VehicleCondition(now, self._sensing.gnss_age, self._land.airborne, self._surfaces)

    def _faults(self) -> list[str]:
        """Why it should not be armed; nothing of it counts in the air."""
        if self._now is None:
            return ["there is no satellite fix yet"]
        if self._land.airborne:
            return []
        safety, mode_manager, now = self._safety, self._mode_manager, self._now
        fence = mode_manager.fence.fencing
        standing = PrearmInputs(
            now,
            self.params,
            gnss_age=self._sensing.gnss_age,
            accuracy=self._sensing.accuracy,
            charge=safety.endurance.charge,
            has_air_data=safety.has_air_data,
            field=self._sensing.field,
            fence_fault="it stands outside" if fence.region.at((now.east, now.north)) < 0 else too_small(self.params),
            mission_fault=self._within.mission_fault(mode_manager.navigator.items, fence, self.params),
        )
        return faults(standing)

    def _handle_stop_all(self, stop: StopStatus) -> None:
        """STOP ALL: in the air it holds, at rest it is disarmed."""
        self._stop = stop
        self._mode_manager.stop(stop.who)
        if self._mode_manager.stopped and not self._land.airborne:
            self._armed = False

    def _arm(self, request: ArmRequest) -> Reply:
        if request.arm and self._mode_manager.stopped and not self._land.airborne:
            return _reply(self._mode_manager.blocked)
        if request.arm and not request.force and not self._armed and (why := self._faults()):
            return _reply("; ".join(why))
        if not request.arm and self._land.airborne and not request.force:
            return _reply("the aircraft is flying: land first, or force it")
        self._armed = request.arm
        return _reply("")

    def _set_mode(self, request: ModeRequest) -> Reply:
        if request.mode not in intake.MODES:
            wanted = ", ".join(m.value for m in intake.MODES.values())
            known = Mode.Name(request.mode) if request.mode in Mode.values() else f"mode {request.mode}"
            return _reply(f"{known} is not flown by this autopilot; {wanted} are")
        if request.mode == Mode.MODE_OFFBOARD and not self._armed:
            return _reply(DISARMED_OFFBOARD)
        refusal = self._mode_manager.change_mode(intake.MODES[request.mode], request.source)
        if not refusal:
            self._safety.watch.overrule()
        return _reply(refusal)

    def _go_to(self, request: GoalRequest) -> Reply:
        place, how = place_of(request.position), LoiterOptions(request.radius, request.speed)
        refusal = self._outside(place, how.radius) or self._mode_manager.go_to(place, request.source, self.params, how)
        if not refusal:
            self._safety.watch.overrule()
        return _reply(refusal)

    def _orbit(self, request: OrbitRequest) -> str:
        circle = intake.circle(request)
        refusal = self._outside(circle.centre, circle.radius)
        return refusal or self._mode_manager.orbit(circle, request.speed, request.source, self.params)

    def _outside(self, place: Place, radius: float) -> str:
        """Why this circle does not lie within the fence; empty if it does."""
        fence = self._mode_manager.fence.fencing
        return "" if fence.is_open else place_fault(place, fence, self.params, abs(radius) or self.params.hold_radius)

    def _carry_out(self, order: VehicleCommandRequest, now: Estimate) -> str:
        if order.WhichOneof("kind") != "reboot":
            return orders.carry_out(order, self._mode_manager, now, self.params)
        if self._armed or self._land.airborne or self._mode_manager.formation is not None:
            return "it is armed, flies, or follows a leader: land and disarm it first"
        self._reboots = True
        return ""

    def _reboot(self) -> None:
        """As after power has been off, with mission, fence and rally points of now."""
        plans = self._plans
        config = replace(self._config, starts_in_air=False, starts_armed=False, items=list(plans.mission.items), fence=self._safety.fence)
        vars(self).update(vars(AutopilotAir(config, self.params)))
        self._plans.set_rally(plans.rally, self.params)

    def _tell_news(self, t: float, out: interface.Outputs) -> None:
        """What is told once, and again when it has changed."""
        self._plans.tell(t, out)
        out.params = self._told_params.news(t, self.params)

    def _stamped_status(self, t: float) -> VehicleStatus:
        status = self._status
        status.timestamp.CopyFrom(stamp(t))
        status.armed, status.landed, status.system_id = self._armed, not self._land.airborne, self._config.system_id
        return status


class AutopilotWingman(AutopilotAir):
    """All that an aircraft's autopilot does, and mode Follow: it hears where the others think they are."""

    class Inputs(interface.Inputs):
        others: dict[str, NavState] = each_vehicle(topics.NAV_STATE)

    def __init__(self, config: AutopilotConfig, params: AirParams, formation: FormationLink) -> None:
        super().__init__(config, params)
        self._formation = formation
        self._mode_manager.join(formation)

    def step(self, t: float, now: interface.Inputs) -> interface.Outputs:
        """One cycle at simulation time ``t`` [s]: hears the others, then flies as every aircraft."""
        assert isinstance(now, self.Inputs)
        self._formation.hear(t, now.others)
        return super().step(t, now)


def _reply(refusal: str) -> Reply:
    return Reply(accepted=not refusal, reason=refusal)
