"""The autopilot of one fixed-wing aircraft: sensors and requests in, surfaces, estimates and reports out."""

from dataclasses import dataclass

from schemas import topics
from schemas.convert import stamp
from schemas.messages import (
    AirData,
    ArmRequest,
    Battery,
    FlightSetpoint,
    Gnss,
    GoalRequest,
    GoAroundRequest,
    Imu,
    Mission,
    MissionItem,
    MissionProgress,
    MissionRequest,
    Mode,
    ModeRequest,
    NavState,
    OrbitRequest,
    Range,
    Reply,
    SetCurrentRequest,
    StopCommand,
    SurfaceCommand,
    VehicleStatus,
)
from services.autopilot.air import by_hand, intake, offboard, reports
from services.autopilot.air.commands import Surfaces
from services.autopilot.air.estimators import Instruments, estimator
from services.autopilot.air.flyable import advice
from services.autopilot.air.journal import Journal
from services.autopilot.air.landed import LandDetector
from services.autopilot.air.losses import GNSS_HOLD, Loss, losses
from services.autopilot.air.mount import ImuMount
from services.autopilot.air.over_ground import OverGround
from services.autopilot.air.params import AirParams
from services.autopilot.air.pilot import Flown, Pilot
from services.autopilot.air.sensed import Fix, Sensed
from services.autopilot.air.servos import SERVOS, Servos
from services.autopilot.air.state import Estimate
from services.autopilot.air.strip import Strip
from services.autopilot.air.wishes import Senses
from uvf.maths.geodesy import GRAVITY, LocalTangent
from uvf.runtime.service import Outputs, Service, every, optional

FIRST_FIX = 1.0  # s, waited for after a restart
BEFORE = "an operator before the restart"


@dataclass(frozen=True)
class Ship:
    """What the autopilot is told of its vehicle at the start."""

    name: str
    system_id: int
    tangent: LocalTangent
    instruments: Instruments
    items: list[MissionItem]
    starts_in_air: bool
    ground: float = 0.0  # m, world: height of the ground below the start
    servos: Servos = SERVOS
    strips: tuple[Strip, ...] = ()
    altimeter: str = ""
    """Frame of the range finder that looks down."""
    starts_armed: bool = False


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
        "stop": optional(topics.STOP.by("*")),
        "teleop": optional(topics.SURFACES.by("teleop")),
        "mavlink": optional(topics.SURFACES.by("mavlink")),
        "client": optional(topics.SURFACES.by("client")),
        "setpoint": optional(topics.SETPOINT.by("*")),
    }
    outputs = {
        "surfaces": topics.SURFACE_COMMAND,
        "nav_state": topics.NAV_STATE,
        "pose": topics.POSE,
        "body_frame": topics.TF_BODY,
        "status": topics.STATUS,
        "plan": topics.MISSION,
        "progress": topics.PROGRESS,
        "path": topics.PATH,
        "events": topics.EVENTS.by("autopilot"),
    }
    requests = {
        "arm": topics.ARM,
        "mode": topics.SET_MODE,
        "goal": topics.GOAL,
        "mission": topics.SET_MISSION,
        "current": topics.SET_CURRENT,
        "orbit": topics.ORBIT,
        "go_around": topics.GO_AROUND,
    }
    recalls = {"status": topics.STATUS, "plan": topics.MISSION, "progress": topics.PROGRESS, "nav_state": topics.NAV_STATE}
    fixed_params = frozenset({"estimator"})
    params: AirParams

    def __init__(self, ship: Ship, params: AirParams) -> None:
        self.params = params
        self._ship = ship
        self._mission = intake.with_id(ship.items)
        self._announced = False
        self._armed = ship.starts_in_air or ship.starts_armed
        self._estimator = estimator(params.estimator, ship.instruments)
        self._mount = ImuMount(ship.instruments.imu_xyz, ship.instruments.imu_rpy)
        self._estimated = 0.0  # s
        self._pilot = Pilot(intake.items(ship.items), ship.ground, ship.strips, ship.servos)
        self._over_ground = OverGround(ship.altimeter)
        self._journal = Journal()
        self._journal.note(advice(self._pilot.navigator.items, params))
        self._fix_stamp = 0
        self._left: NavState | None = None
        self._now: Estimate | None = None
        self._waited = 0.0  # s, for the first fix
        self._lost: frozenset[Loss] = frozenset()
        self._cycles = 0
        self._told: tuple[object, ...] = ()
        self._land = LandDetector(ship.starts_in_air)
        self._status = VehicleStatus()

    def step(
        self,
        t: float,
        imu: list[Imu],
        air_data: AirData | None,
        gnss: Gnss | None,
        battery: Battery | None,
        range: list[Range],
        stop: StopCommand | None,
        teleop: SurfaceCommand | None,
        mavlink: SurfaceCommand | None,
        client: SurfaceCommand | None,
        setpoint: FlightSetpoint | None,
        arm: list[ArmRequest],
        mode: list[ModeRequest],
        goal: list[GoalRequest],
        mission: list[MissionRequest],
        current: list[SetCurrentRequest],
        orbit: list[OrbitRequest],
        go_around: list[GoAroundRequest],
    ) -> Outputs:
        now = self._now = self._estimate(t, imu, air_data, gnss)
        if now is None:
            waiting = [_reply("there is no satellite fix yet")]
            asked = {"arm": len(arm), "mode": len(mode), "goal": len(goal), "mission": len(mission), "current": len(current)}
            asked |= {"orbit": len(orbit), "go_around": len(go_around)}
            return {**self._announce(t), **{name: waiting * count for name, count in asked.items()}}
        if len(self._lost) < len(Loss):
            self._land.step(now, self.params, 1 / self.hz)
        self._pilot.fly_blind(self._estimator.unfixed > GNSS_HOLD)
        self._heed(stop)
        replies = {
            "arm": [self._arm(r) for r in arm],
            "mode": [self._set_mode(r) for r in mode],
            "goal": [_reply(self._pilot.go_to(intake.place(r.position), r.source, self.params)) for r in goal],
            "mission": [self._set_mission(r.mission) for r in mission],
            "current": [_reply(self._pilot.set_current(r.index)) for r in current],
            "orbit": [_reply(self._pilot.orbit(intake.circle(r), r.speed, r.source, self.params)) for r in orbit],
            "go_around": [_reply(self._pilot.go_around(r.source)) for r in go_around],
        }
        hand = by_hand.choose(t, {"teleop": teleop, "mavlink": mavlink, "client": client})
        self._over_ground.hear(range, [intake.inertial(m, t) for m in imu], 1 / self.hz)
        flown = self._fly(t, now, hand, offboard.fresh(t, setpoint))
        state = reports.nav_state(t, now)
        out: dict[str, object] = {
            "surfaces": reports.surfaces(t, flown.surfaces, self._armed),
            "nav_state": state,
            "pose": reports.pose(state),
            "body_frame": reports.body_frame(state, self._ship.name),
            "events": self._journal.events(t, self._pilot, self._armed, self._lost),
        }
        out |= self._reports(t, now, flown, battery)
        self._cycles += 1
        return {**out, **self._announce(t), **replies}  # type: ignore[dict-item]

    def _fly(self, t: float, now: Estimate, hand: by_hand.Hand | None, setpoint: FlightSetpoint | None) -> Flown:
        clearance = self._over_ground.clearance(t, now, self.params.gear_height)
        senses = Senses(self._land.airborne, self._armed, hand, self._ship.servos, clearance, self._over_ground.push, setpoint)
        self._pilot.hear(senses, 1 / self.hz)
        flown = self._pilot.step(now, self.params, 1 / self.hz)
        if self._pilot.disarms:
            self._pilot.disarms = self._armed = False
        return flown

    def _reports(self, t: float, now: Estimate, flown: Flown, battery: Battery | None) -> dict[str, object]:
        """What is told less often than each cycle."""
        out: dict[str, object] = {}
        told = (self._pilot.mode, self._pilot.reason, self._pilot.stopped, self._armed)
        if self._cycles % 5 == 0 or told != self._told:
            self._told = told
            self._status = reports.status(t, self._pilot, now, flown)
            self._status.battery_remaining = battery.remaining if battery is not None else -1.0
            self._status.battery_voltage = battery.voltage if battery is not None else 0.0
            out["status"] = self._stamped_status(t)
        if self._cycles % 25 == 0:
            out["progress"] = reports.progress(t, self._pilot, self._mission.id)
            out["path"] = reports.path(t, self._pilot)
        return out

    def recall(
        self,
        status: VehicleStatus | None = None,
        plan: Mission | None = None,
        progress: MissionProgress | None = None,
        nav_state: NavState | None = None,
    ) -> None:
        """Goes on in the mode, at the item and from the attitude where the instance before has been."""
        if plan is not None:
            self._set_mission(plan)
        if status is not None and status.mode in intake.MODES:
            self._armed = status.armed
            self._land = LandDetector(not status.landed)
            self._pilot.stopped = BEFORE if status.stopped else ""
            self._pilot.take_up(intake.MODES[status.mode], intake.place(status.home), intake.stand(progress))
        if nav_state is not None:
            self._left = nav_state
            self._estimator.begin_at(*intake.attitude(nav_state))

    def stale(self, t: float, missing: tuple[str, ...]) -> Outputs:
        """Without the IMU nothing can be steered: surfaces at trim until it is back; before the first cycle the servos hold."""
        if not self._cycles:
            return self._announce(t)
        p = self.params
        alpha = p.alpha_zero_lift + p.alpha_per_load * GRAVITY / p.trim_airspeed**2
        level = Surfaces(0.0, p.elev_zero_alpha + p.elev_per_alpha * alpha, 0.0, p.trim_throttle)
        self._status.reason = f"sensor lost: {', '.join(missing)}"
        return {
            "surfaces": reports.surfaces(t, level, self._armed and self._land.airborne),
            "status": self._stamped_status(t),
            "events": self._journal.lost(t, missing),
        }

    def _estimate(self, t: float, imu: list[Imu], air_data: AirData | None, gnss: Gnss | None) -> Estimate | None:
        """None until the first fix."""
        fix = self._new_fix(t, gnss) if gnss is not None else None
        if fix is None and not self._estimator.started:
            fix = self._left_fix(t)
            if fix is None:
                return None
        pressures = intake.pressures(air_data, t) if air_data is not None else None
        self._lost = losses(self._estimator.unfixed, pressures is not None)
        period = 1 / self._ship.instruments.sheet.imu_hz
        samples = [self._mount.at_centre(intake.inertial(m, t), period) for m in imu]
        dt = t - self._estimated if self._estimator.started else 1 / self.hz
        self._estimated = t
        return self._estimator.step(Sensed(samples, pressures, fix), self.params, dt)

    def _left_fix(self, t: float) -> Fix | None:
        """After a restart without GNSS: where the instance before has been, once a fix has been waited for."""
        self._waited += 1 / self.hz
        return intake.left_fix(self._left, t) if self._left is not None and self._waited > FIRST_FIX else None

    def _new_fix(self, t: float, gnss: Gnss) -> Fix | None:
        stamp_ns = gnss.timestamp.ToNanoseconds()
        is_new, self._fix_stamp = stamp_ns != self._fix_stamp, stamp_ns
        return intake.fix(gnss, self._ship.tangent, t) if is_new else None

    def _heed(self, stop: StopCommand | None) -> None:
        """STOP ALL: in the air it holds, at rest it is disarmed. Without a word of it, what was said before counts."""
        if stop is not None:
            self._pilot.stop(stop.source or "unknown" if stop.engaged else "")
        if self._pilot.stopped and not self._land.airborne:
            self._armed = False

    def _arm(self, request: ArmRequest) -> Reply:
        if request.arm and self._pilot.stopped and not self._land.airborne:
            return _reply(self._pilot.blocked)
        if not request.arm and self._land.airborne and not request.force:
            return _reply("the aircraft is flying: land first, or force it")
        self._armed = request.arm
        return _reply("")

    def _set_mode(self, request: ModeRequest) -> Reply:
        if request.mode not in intake.MODES:
            wanted = ", ".join(m.value for m in intake.MODES.values())
            known = Mode.Name(request.mode) if request.mode in Mode.values() else f"mode {request.mode}"
            return _reply(f"{known} is not flown by this autopilot; {wanted} are")
        return _reply(self._pilot.change_mode(intake.MODES[request.mode], request.source))

    def _set_mission(self, mission: Mission) -> Reply:
        try:
            refusal = self._pilot.load(intake.items(mission.items), self.params)
        except ValueError as error:
            refusal = str(error)
        if not refusal:
            self._mission = intake.with_id(mission.items)
            self._journal.note(advice(self._pilot.navigator.items, self.params))
            self._announced = False
        return _reply(refusal)

    def _announce(self, t: float) -> Outputs:
        if self._announced:
            return {}
        self._announced = True
        self._mission.timestamp.CopyFrom(stamp(t))
        return {"plan": self._mission}

    def _stamped_status(self, t: float) -> VehicleStatus:
        status = self._status
        status.timestamp.CopyFrom(stamp(t))
        status.armed, status.landed, status.system_id = self._armed, not self._land.airborne, self._ship.system_id
        return status


def _reply(refusal: str) -> Reply:
    return Reply(accepted=not refusal, reason=refusal)
