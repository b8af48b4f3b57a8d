"""The autopilot of one fixed-wing aircraft: sensors and requests in, surfaces, estimates and reports out."""

from collections.abc import Sequence
from dataclasses import replace

from schemas import topics
from schemas.messages import (
    AirData,
    ArmRequest,
    Battery,
    Fence,
    FenceRequest,
    FlightSetpoint,
    Gnss,
    GoalRequest,
    GoAroundRequest,
    Imu,
    Link,
    Mission,
    MissionProgress,
    MissionRequest,
    Mode,
    ModeRequest,
    NavState,
    OrbitRequest,
    OrderRequest,
    ParamValues,
    RallyPoints,
    RallyRequest,
    Range,
    Reply,
    SetCurrentRequest,
    SurfaceCommand,
    VehicleStatus,
)
from services.autopilot.air import manual_control
from services.autopilot.air.config import Ship
from services.autopilot.air.failsafes.monitor import Safety, Seen
from services.autopilot.air.failsafes.prearm import Standing, faults
from services.autopilot.air.failsafes.table import GNSS_HOLD
from services.autopilot.air.fence.fence_in_force import too_small
from services.autopilot.air.inputs import intake
from services.autopilot.air.inputs.external_control import Outside
from services.autopilot.air.inputs.over_ground import OverGround
from services.autopilot.air.inputs.sensing import Said, Sensing
from services.autopilot.air.mission import orders
from services.autopilot.air.mission.plans import Plans
from services.autopilot.air.mode_manager import Pilot
from services.autopilot.air.modes.leading import Steadied
from services.autopilot.air.modes.paths import Round
from services.autopilot.air.setpoints import Flown, Senses
from services.autopilot.air.status import status_messages, telemetry
from services.autopilot.air.status.event_log import Journal
from services.autopilot.safe_state import coming_down
from services.autopilot.told_params import ToldParams
from uvf.control.flight_control import level_trim
from uvf.estimation.landed import LandDetector
from uvf.estimation.state import Estimate
from uvf.guidance.fence_plan import Remembered, place_fault
from uvf.guidance.flyable import advice
from uvf.guidance.route import Place
from uvf.models.vehicle.flight_params import FIXED, AirParams
from uvf.runtime.contract.service import Service, every, optional, stop_all
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.outputs import Outputs
from uvf.runtime.state.stop_all import StopStatus


class AutopilotAir(Service):
    """Hold, Mission and Return from IMU, air data and GNSS, and Manual; it never sees the truth. The only writer of the surfaces."""

    name = "autopilot_air"
    hz = 50.0
    inputs = {
        "imu": every(topics.IMU),
        "air_data": optional(topics.AIR_DATA),
        "gnss": optional(topics.GNSS),
        "battery": optional(topics.BATTERY),
        "range": optional(every(topics.RANGE)),
        "link": optional(topics.LINK),
        "stop": stop_all(),
        "teleop": optional(topics.SURFACES.by("teleop")),
        "mavlink": optional(topics.SURFACES.by("mavlink")),
        "client": optional(topics.SURFACES.by("client")),
        "setpoint_offboard": optional(topics.SETPOINT.by("offboard")),
        "setpoint_client": optional(topics.SETPOINT.by("client")),
        "setpoint_mavlink": optional(topics.SETPOINT.by("mavlink")),
    }
    outputs = {
        "surfaces": topics.SURFACE_COMMAND,
        "nav_state": topics.NAV_STATE,
        "pose": topics.POSE,
        "body_frame": topics.TF_BODY,
        "status": topics.STATUS,
        "targets": topics.TARGETS,
        "quality": topics.QUALITY,
        "plan": topics.MISSION,
        "bounds": topics.FENCE,
        "rally": topics.RALLY,
        "progress": topics.PROGRESS,
        "path": topics.PATH,
        "events": topics.EVENTS.by("autopilot"),
        "params": topics.PARAMS.by("autopilot_air"),
    }
    requests = {
        "arm": topics.ARM,
        "mode": topics.SET_MODE,
        "goal": topics.GOAL,
        "mission": topics.SET_MISSION,
        "current": topics.SET_CURRENT,
        "orbit": topics.ORBIT,
        "go_around": topics.GO_AROUND,
        "order": topics.ORDER,
        "fence": topics.SET_FENCE,
        "set_rally": topics.SET_RALLY,
    }
    recalls = {
        "status": topics.STATUS,
        "plan": topics.MISSION,
        "bounds": topics.FENCE,
        "rally": topics.RALLY,
        "progress": topics.PROGRESS,
        "nav_state": topics.NAV_STATE,
        "params": topics.PARAMS.by("autopilot_air"),
    }
    fixed_params = FIXED
    params: AirParams

    def __init__(self, ship: Ship, params: AirParams) -> None:
        self.params = params
        self._ship = ship
        self._restarts = False
        self._told_params = ToldParams()
        self._armed = ship.starts_in_air or ship.starts_armed
        self._pilot = Pilot(intake.items(ship.items), ship.ground, ship.strips, ship.servos)
        self._pilot.leads = Steadied() if ship.leads else None
        self._over_ground = OverGround(ship.altimeter)
        self._within = Remembered()
        self._safety = Safety(self._pilot, ship.servos)
        self._safety.set_fence(ship.fence, None, params)
        self._journal = Journal()
        self._journal.note(advice(self._pilot.navigator.items, params))
        self._plans = Plans(ship.items, self._pilot, self._safety, self._journal)
        self._sensing = Sensing(ship.instruments, ship.tangent, params.estimator, self._safety.believed)
        self._surfaces = manual_control.LET_GO
        self._steering = Outside()
        self._now: Estimate | None = None
        self._cycles = 0
        self._told: tuple[object, ...] = ()
        self._where: tuple[object, ...] = ()
        self._land = LandDetector(ship.starts_in_air)
        self._status = VehicleStatus()
        self._stop = StopStatus()

    def step(
        self,
        t: float,
        imu: list[Imu],
        air_data: AirData | None,
        gnss: Gnss | None,
        battery: Battery | None,
        range: list[Range],
        link: Link | None,
        stop: StopStatus,
        teleop: SurfaceCommand | None,
        mavlink: SurfaceCommand | None,
        client: SurfaceCommand | None,
        setpoint_offboard: FlightSetpoint | None,
        setpoint_client: FlightSetpoint | None,
        setpoint_mavlink: FlightSetpoint | None,
        arm: list[ArmRequest],
        mode: list[ModeRequest],
        goal: list[GoalRequest],
        mission: list[MissionRequest],
        current: list[SetCurrentRequest],
        orbit: list[OrbitRequest],
        go_around: list[GoAroundRequest],
        order: list[OrderRequest],
        fence: list[FenceRequest],
        set_rally: list[RallyRequest],
    ) -> Outputs:
        if self._restarts:
            self._restart()
        samples = [sample for m in imu if (sample := intake.inertial(m, t)) is not None]
        now = self._now = self._sensing.step(t, Said(samples, air_data, gnss, self._land.airborne), self.params, 1 / self.hz)
        if now is None:
            requests: dict[str, Sequence[object]] = {"arm": arm, "mode": mode, "goal": goal, "mission": mission, "current": current}
            requests |= {"orbit": orbit, "go_around": go_around, "order": order, "fence": fence, "set_rally": set_rally}
            return {**self._news(t), **{name: [_reply("there is no satellite fix yet")] * len(asked) for name, asked in requests.items()}}
        if now.position_known or now.airspeed_known:
            self._land.step(now, self.params, 1 / self.hz)
        self._safety.hear(t, link, battery)
        warnings = self._safety.step(t, self._seen(now), self.params, 1 / self.hz)
        self._pilot.fly_blind(self._sensing.unfixed > GNSS_HOLD or self._safety.blind)
        self._heed(stop)
        replies = {
            "arm": [self._arm(r) for r in arm],
            "mode": [self._set_mode(r) for r in mode],
            "goal": [self._go_to(r) for r in goal],
            "mission": [_reply(self._plans.set_mission(r.mission, self.params)) for r in mission],
            "current": [_reply(self._pilot.set_current(r.index)) for r in current],
            "orbit": [_reply(self._orbit(r)) for r in orbit],
            "go_around": [_reply(self._pilot.go_around(r.source)) for r in go_around],
            "order": [_reply(self._carry_out(r, now)) for r in order],
            "fence": [_reply(self._plans.set_fence(r.fence, self._seen(now), self.params)) for r in fence],
            "set_rally": [_reply(self._plans.set_rally(r.rally, self.params)) for r in set_rally],
        }
        hands = {"teleop": teleop, "mavlink": mavlink, "client": client}
        setpoints = {"offboard": setpoint_offboard, "client": setpoint_client, "mavlink": setpoint_mavlink}
        self._steering.hear(t, hands, setpoints, self.params.stick_timeout)
        self._over_ground.hear(range, self._sensing.felt, 1 / self.hz)
        out = self._report(t, now, self._fly(t, now))
        out["events"] = warnings + self._journal.events(t, self._pilot, self._armed)
        return {**out, **self._news(t), **replies}  # type: ignore[dict-item]

    def _fly(self, t: float, now: Estimate) -> Flown:
        clearance = self._over_ground.clearance(t, now, self.params.gear_height)
        felt = self._over_ground
        senses = Senses(self._land.airborne, self._armed, None, self._ship.servos, clearance, felt.push, felt.heave)
        self._pilot.hear(self._steering.tell(senses), 1 / self.hz)
        flown = self._pilot.step(now, self._safety.demands(self.params), 1 / self.hz)
        self._surfaces = flown.surfaces
        self._journal.note(self._steering.news(t, self._pilot))
        if self._pilot.disarms:
            self._pilot.disarms = self._armed = False
        return flown

    def _report(self, t: float, now: Estimate, flown: Flown) -> dict[str, object]:
        """Surfaces and motion; what is told now and then, and the status also when it changes."""
        state = telemetry.nav_state(t, now)
        out: dict[str, object] = {
            "surfaces": telemetry.surfaces(t, flown.surfaces, self._armed),
            "nav_state": state,
            "pose": telemetry.pose(state),
            "body_frame": telemetry.body_frame(state, self._ship.name),
        }
        pilot = self._pilot
        told = (pilot.mode, pilot.reason, pilot.stopped, self._armed, self._steering.followed(pilot))
        if self._cycles % 5 == 0 or told != self._told:
            self._told = told
            self._status = telemetry.status(t, self._pilot, now, flown)
            self._status.battery_remaining, self._status.battery_voltage = self._safety.endurance.shown
            self._status.prearm.extend(self._faults())
            self._status.failsafes.extend(self._safety.texts)
            self._status.stops.extend(self._stop.engagements)
            self._status.breach, self._status.breaches = self._safety.breach, self._safety.breaches
            out["status"] = self._stamped_status(t)
        if self._cycles % 5 == 0:
            out["targets"] = status_messages.targets(t, self._pilot, flown)
        navigator = self._pilot.navigator
        where = (navigator.index, navigator.reached, navigator.laps, navigator.finished)
        if self._cycles % 25 == 0 or where != self._where:
            self._where = where
            out["progress"] = telemetry.progress(t, self._pilot, self._plans.mission.id)
        if self._cycles % 25 == 0:
            out["quality"] = status_messages.quality(t, now)
            out["path"] = telemetry.path(t, self._pilot)
        self._cycles += 1
        return out

    def recall(
        self,
        status: VehicleStatus | None = None,
        plan: Mission | None = None,
        bounds: Fence | None = None,
        rally: RallyPoints | None = None,
        progress: MissionProgress | None = None,
        nav_state: NavState | None = None,
        params: ParamValues | None = None,
    ) -> None:
        """Goes on in the mode, at the item, from the attitude and with the parameters where the instance before has been."""
        if params is not None:
            self.params = self._told_params.taken_up(params, self.params)
        if plan is not None:
            self._plans.set_mission(plan, self.params)
        if bounds is not None:
            self._plans.set_fence(bounds, None, self.params)
        if rally is not None:
            self._plans.set_rally(rally, self.params)
        if status is not None and status.mode in intake.MODES:
            self._armed = status.armed
            self._land = LandDetector(not status.landed)
            self._stop = StopStatus(tuple(status.stops))
            self._pilot.stopped = self._stop.who
            self._pilot.take_up(intake.MODES[status.mode], intake.place(status.home), intake.stand(progress))
        if nav_state is not None:
            self._sensing.begin_from(nav_state)

    def stale(self, t: float, missing: tuple[str, ...]) -> Outputs:
        """Without the IMU nothing can be steered: surfaces at trim until it is back; before the first cycle the servos hold."""
        if not self._cycles:
            return self._news(t)
        self._status.reason = f"sensor lost: {', '.join(missing)}"
        return {
            "surfaces": telemetry.surfaces(t, level_trim(self.params), self._armed and self._land.airborne),
            "status": self._stamped_status(t),
            "events": self._journal.lost(t, missing),
        }

    given_up = "its motor is off and it comes down in a turn"
    stand_in = staticmethod(coming_down)

    def _seen(self, now: Estimate) -> Seen:
        return Seen(now, self._sensing.unfixed, self._land.airborne, self._surfaces)

    def _faults(self) -> list[str]:
        """Why it should not be armed; nothing of it counts in the air."""
        if self._now is None:
            return ["there is no satellite fix yet"]
        if self._land.airborne:
            return []
        safety, pilot, now = self._safety, self._pilot, self._now
        fence = pilot.fence.fencing
        standing = Standing(
            now,
            self.params,
            unfixed=self._sensing.unfixed,
            accuracy=self._sensing.accuracy,
            charge=safety.endurance.charge,
            has_air_data=safety.has_air_data,
            field=self._sensing.field,
            fence_fault="it stands outside" if fence.region.at((now.east, now.north)) < 0 else too_small(self.params),
            mission_fault=self._within.mission_fault(pilot.navigator.items, fence, self.params),
        )
        return faults(standing)

    def _heed(self, stop: StopStatus) -> None:
        """STOP ALL: in the air it holds, at rest it is disarmed."""
        self._stop = stop
        self._pilot.stop(stop.who)
        if self._pilot.stopped and not self._land.airborne:
            self._armed = False

    def _arm(self, request: ArmRequest) -> Reply:
        if request.arm and self._pilot.stopped and not self._land.airborne:
            return _reply(self._pilot.blocked)
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
        refusal = self._pilot.change_mode(intake.MODES[request.mode], request.source)
        if not refusal:
            self._safety.watch.overrule()
        return _reply(refusal)

    def _go_to(self, request: GoalRequest) -> Reply:
        place, how = intake.place(request.position), Round(request.radius, request.speed)
        refusal = self._outside(place, how.radius) or self._pilot.go_to(place, request.source, self.params, how)
        if not refusal:
            self._safety.watch.overrule()
        return _reply(refusal)

    def _orbit(self, request: OrbitRequest) -> str:
        circle = intake.circle(request)
        refusal = self._outside(circle.centre, circle.radius)
        return refusal or self._pilot.orbit(circle, request.speed, request.source, self.params)

    def _outside(self, place: Place, radius: float) -> str:
        """Why this circle does not lie within the fence; empty if it does."""
        fence = self._pilot.fence.fencing
        return "" if fence.is_open else place_fault(place, fence, self.params, abs(radius) or self.params.hold_radius)

    def _carry_out(self, order: OrderRequest, now: Estimate) -> str:
        if order.WhichOneof("kind") != "restart":
            return orders.carry_out(order, self._pilot, now, self.params)
        if self._armed or self._land.airborne or self._pilot.formation is not None:
            return "it is armed, flies, or follows a leader: land and disarm it first"
        self._restarts = True
        return ""

    def _restart(self) -> None:
        """As after power has been off, with mission, fence and rally points of now."""
        plans = self._plans
        ship = replace(self._ship, starts_in_air=False, starts_armed=False, items=list(plans.mission.items), fence=self._safety.fence)
        vars(self).update(vars(AutopilotAir(ship, self.params)))
        self._plans.set_rally(plans.rally, self.params)

    def _news(self, t: float) -> Outputs:
        """What is told once, and again when it has changed."""
        return {**self._plans.news(t), **self._told_params.news(t, self.params)}

    def _stamped_status(self, t: float) -> VehicleStatus:
        status = self._status
        status.timestamp.CopyFrom(stamp(t))
        status.armed, status.landed, status.system_id = self._armed, not self._land.airborne, self._ship.system_id
        return status


def _reply(refusal: str) -> Reply:
    return Reply(accepted=not refusal, reason=refusal)
