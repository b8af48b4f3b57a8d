"""The autopilot of a ground vehicle: modes, arming, STOP ALL, the command multiplexer, limits and missions."""

from collections.abc import Mapping
from dataclasses import replace
from math import hypot, inf

from schemas.messages import (
    ArmRequest,
    Breach,
    DriveCommand,
    Event,
    Fence,
    FenceRequest,
    JointStates,
    Kind,
    MissionItem,
    MissionRequest,
    Mode,
    ModeRequest,
    MoveJointsRequest,
    RallyPoints,
    Reply,
    SetCurrentRequest,
    VehicleCommandRequest,
    VehicleStatus,
    WheelCommand,
)
from services.autopilot.failsafes import FailsafeAction
from services.autopilot.ground import fence as fences
from services.autopilot.ground import interface, orders
from services.autopilot.ground.joints import JointMover
from services.autopilot.ground.mission import MissionEngine, Point, mission_of, refusal, vector
from services.autopilot.ground.multiplexer import COMMAND_MAX_AGE, SOURCES, ActiveCommand, VelocityCommand, choose
from services.autopilot.ground.params import GroundAutopilotParams
from services.autopilot.ground.safety import GroundActivity, GroundFailsafeMonitor, GroundSensorInputs, SensorLooks, mode_of, place
from services.autopilot.multiplexing import DISARMED_OFFBOARD, Once
from services.autopilot.parameter_state import ToldParams
from services.autopilot.safe_state import standing
from uvf.control.drive_limits import within_limits
from uvf.control.steered_ramp import velocity_ramp
from uvf.maths.kinematics import Twist
from uvf.models.vehicle.file import GroundBody
from uvf.models.vehicle.joints import MovedJoint
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import mode_name, seconds, stamp, yaw_of
from uvf.runtime.messages.wheels import wheel_command
from uvf.runtime.state.stop_all import StopStatus

STATUS_EVERY, PROGRESS_EVERY = 5, 25
"""Steps between two messages: 10 Hz and 2 Hz."""
UNKNOWN_BATTERY = -1.0
REFUSALS_EVERY = 10.0  # s between two events about commands that are no numbers

NO_JOINTS: Mapping[str, MovedJoint] = {}

SENDERS = ("teleop", "mavlink", "gcs", "client", "executive", "offboard", "planner")
"""Inputs of commands, by who sends them."""


class GroundAutopilot(Service):
    """The only writer of a ground vehicle's ``actuator/wheels``. With a job it begins armed, in mode MISSION."""

    name = "autopilot_ground"
    hz = 50.0

    Inputs = interface.Inputs
    Outputs = interface.Outputs
    Recalls = interface.Recalls

    params: GroundAutopilotParams

    def __init__(
        self,
        body: GroundBody,
        home: Point,
        job: tuple[bool, bool, list[MissionItem]],
        system_id: int,
        params: GroundAutopilotParams,
        fence: Fence | None = None,
        looks: SensorLooks = SensorLooks(),  # noqa: B008  it cannot be changed
        joints: Mapping[str, MovedJoint] = NO_JOINTS,
    ) -> None:
        """home: start pose [m, world]; job: whether it is armed, whether it begins at once, and the mission's items, perhaps none.

        joints: that are moved on command, beside wheels and steering.
        """
        self.params = params
        self._body = body
        self._made_with = (body, home, system_id, looks, joints)
        self._mover = JointMover(joints)
        self._system_id = system_id
        self._drive = body.drive.kinematics
        self._ramp = velocity_ramp(body)
        self._armed, begins, items = job
        self._mode: int = Mode.MODE_MISSION if begins else Mode.MODE_HOLD
        self._stop = StopStatus()
        self._choice = ActiveCommand("", "starting")
        self._refused_at = -inf
        self._once = Once()
        self._heard: dict[str, VelocityCommand] = {}
        self._engine = MissionEngine(home, params.acceptance_radius)
        self._engine.load(mission_of(items, stamp(0.0)))
        self._mission_is_new = True
        self._safety = GroundFailsafeMonitor(body, fence or Fence(), looks)
        self._fence_is_new = True
        self._told_params = ToldParams()
        self._reboots = False
        self._rally = RallyPoints()
        self._rally_is_new = True
        self._here: fences.GroundPose | None = None
        self._steps = 0
        self._told: tuple[object, ...] = ()
        self._events: list[Event] = []

    def step(self, t: float, now: interface.Inputs) -> interface.Outputs:
        """One cycle at ``t`` [s, simulation]: requests, failsafes, mission, command multiplexer, wheel speeds."""
        self._handle_stop_all(t, now.stop)
        self._here = place(now.pose, yaw_of(now.pose.pose.orientation)) if now.pose is not None else None
        speed = now.odometry.linear_velocity.x if now.odometry is not None else None
        scans = [*([now.scan] if now.scan is not None else []), *now.other_scans]
        self._watch(t, GroundSensorInputs(self._here, speed, now.link, now.imu, now.ticks, scans, now.correction, now.battery, now.range))
        out = self.Outputs()
        out.arm = [self._arm(t, r) for r in now.arm]
        out.set_mode = [self._set_mode(t, r) for r in now.set_mode]
        out.set_mission = [self._set_mission(t, r) for r in now.set_mission]
        out.set_current = [self._set_current(t, r) for r in now.set_current]
        out.set_fence = [self._set_fence(t, r) for r in now.set_fence]
        out.order = [self._carry_out(t, r) for r in now.order]
        out.set_rally = [self._set_rally(r.rally) for r in now.set_rally]
        out.move_joints = [self._move_joints(t, r, now.joints) for r in now.move_joints]
        commands = {name: getattr(now, name) for name in SENDERS}
        position = (now.pose.pose.position.x, now.pose.pose.position.y) if now.pose is not None else None
        self._follow_mission(t, position)
        lasts = self.params.stick_timeout if self._mode == Mode.MODE_MANUAL else COMMAND_MAX_AGE
        # An input is gone once it is stale; how long a command counts is the parameter's to say.
        self._heard |= {k: _velocity_command(c) for k, c in commands.items() if c is not None}
        self._choose(t, {k: replace(c, lasts=lasts) for k, c in self._heard.items()})
        out.wheels = self._wheels(t)
        out.joints = self._mover.command(t, 1.0 / self.hz, bool(self._obstacle))
        self._report(t, position, out)
        if self._reboots:
            self._reboot()
        return out

    def recall(self, left: interface.Recalls) -> None:
        """Resumes mode, arming, STOP ALL, mission item and parameters of the instance before."""
        if left.params is not None:
            self.params = self._told_params.taken_up(left.params, self.params)
        if left.status is not None and left.status.mode in SOURCES:
            self._mode, self._armed = left.status.mode, left.status.armed
        if left.status is not None:
            self._stop = StopStatus(tuple(left.status.stops))
        if left.bounds is not None:
            self._safety.set_fence(left.bounds, None)
        if left.rally is not None:
            self._set_rally(left.rally)
        if left.mission is not None and left.progress is not None:
            self._engine.resume(left.mission, left.progress)

    given_up = "its wheels stand"
    stand_in = staticmethod(standing)

    def _watch(self, t: float, sensed: GroundSensorInputs) -> None:
        """What the failsafes order, whatever the mode."""
        asked = tuple(speed * self._drive.wheel_radius for speed in self._drive.wheels(self._ramp.velocity))
        doing = GroundActivity(self._mode, self._armed and not self._stop, bool(self._choice.source), asked)
        self._safety.keep_near(self._engine.home, self.params.max_distance)
        events, order = self._safety.step(t, sensed, doing, self.params, 1.0 / self.hz)
        self._events += events
        if order is None or not order.action:
            return
        if (mode := mode_of(order.action)) != self._mode:
            self._mode = mode
            self._tell(t, f"mode {mode_name(mode)}", order.rule.raised_text, Event.WARNING)
        if order.action is FailsafeAction.OFF and self._armed:
            self._armed = False
            self._tell(t, "disarmed", order.rule.raised_text, Event.WARNING)

    def _set_fence(self, t: float, request: FenceRequest) -> Reply:
        reason = self._safety.set_fence(request.fence, self._here)
        if not reason:
            self._fence_is_new = True
            self._tell(t, f"new fence of {len(request.fence.zones)} zones", f"asked by {request.source or 'unknown'}")
        return Reply(accepted=not reason, reason=reason)

    def _set_rally(self, rally: RallyPoints) -> Reply:
        """The planner drives there in mode Return."""
        reason = fences.rally_refusal(rally, self._safety.fencing, self._body.radius)
        if not reason:
            self._rally, self._rally_is_new = rally, True
        return Reply(accepted=not reason, reason=reason)

    def _move_joints(self, t: float, request: MoveJointsRequest, measured: JointStates | None) -> Reply:
        reason = self._obstacle or self._mover.ask(request, measured)
        if not reason:
            told = ", ".join(f"{joint.name} to {joint.position:g}" for joint in request.joints)
            self._tell(t, told, f"asked by {request.source or 'unknown'}")
        return Reply(accepted=not reason, reason=reason)

    @property
    def _obstacle(self) -> str:
        """Why nothing of it moves now; "" when it may."""
        return f"STOP ALL is engaged by {self._stop.who}" if self._stop else "" if self._armed else "disarmed"

    def _handle_stop_all(self, t: float, stop: StopStatus) -> None:
        before, self._stop = self._stop, stop
        if stop and stop.who != before.who:
            self._tell(t, "STOP ALL: standing until it is released", f"engaged by {stop.who}", Event.WARNING)
        elif before and not stop:
            self._tell(t, "STOP ALL is released", f"released by {stop.released_by or 'unknown'}")

    def _arm(self, t: float, request: ArmRequest) -> Reply:
        if request.arm and self._stop:
            return Reply(accepted=False, reason=f"STOP ALL is engaged by {self._stop.who}: release it first")
        if request.arm and not request.force and not self._armed and (why := self._safety.faults()):
            return Reply(accepted=False, reason="; ".join(why))
        if request.arm != self._armed:
            self._armed = request.arm
            self._tell(t, "armed" if request.arm else "disarmed", f"asked by {request.source or 'unknown'}")
        return Reply(accepted=True)

    def _set_mode(self, t: float, request: ModeRequest) -> Reply:
        if request.mode not in SOURCES:
            known = ", ".join(mode_name(mode) for mode in SOURCES)
            asked = mode_name(request.mode) if request.mode in Mode.values() else request.mode
            return Reply(accepted=False, reason=f"a ground vehicle has no mode {asked}; there are: {known}")
        if request.mode == Mode.MODE_OFFBOARD and not self._armed:
            return Reply(accepted=False, reason=DISARMED_OFFBOARD)
        self._safety.overrule()
        if request.mode != self._mode:
            self._mode = request.mode
            self._tell(t, f"mode {mode_name(request.mode)}", f"asked by {request.source or 'unknown'}")
        return Reply(accepted=True, reason="" if self._armed else "the vehicle is disarmed: arm it before it moves")

    def _set_mission(self, t: float, request: MissionRequest) -> Reply:
        items = list(request.mission.items)
        reason = refusal(items) or fences.refusal(items, self._safety.fencing, self._body.radius)
        if reason:
            return Reply(accepted=False, reason=reason)
        self._engine.load(mission_of(request.mission.items, stamp(t)))
        self._mission_is_new = True
        self._tell(t, f"new mission of {len(request.mission.items)} items", f"asked by {request.source or 'unknown'}")
        return Reply(accepted=True)

    def _set_current(self, t: float, request: SetCurrentRequest) -> Reply:
        reason = self._engine.jump_to(request.index)
        if not reason:
            self._tell(t, f"mission item {request.index} is next", f"asked by {request.source or 'unknown'}")
        return Reply(accepted=not reason, reason=reason)

    def _carry_out(self, t: float, order: VehicleCommandRequest) -> Reply:
        kind, here = order.WhichOneof("kind"), self._here
        if kind == "reboot":
            reason = "it is armed: disarm it first" if self._armed else ""
            self._reboots = not reason
        else:
            reason = orders.carry_out(order, self._engine, (here.x, here.y) if here is not None else None, self._body)
        if not reason:
            self._tell(t, f"order {kind}", f"asked by {order.source or 'unknown'}")
        return Reply(accepted=not reason, reason=reason)

    def _reboot(self) -> None:
        """As after power has been off, with mission, fence and rally points of now."""
        rally = self._rally
        body, home, system_id, looks, joints = self._made_with
        job = (False, False, list(self._engine.mission.items))
        vars(self).update(vars(GroundAutopilot(body, home, job, system_id, self.params, self._safety.fence, looks, joints)))
        self._set_rally(rally)

    def _follow_mission(self, t: float, position: Point | None) -> None:
        active = self._mode == Mode.MODE_MISSION and self._armed and not self._stop
        self._engine.acceptance_radius = self.params.acceptance_radius
        reached = self._engine.advance(t, position, active)
        if reached is not None:
            self._tell(t, f"mission item {reached} reached", "within its acceptance radius")

    def _choose(self, t: float, commands: Mapping[str, VelocityCommand]) -> None:
        obstacle = self._obstacle or self._safety.obstacle(self._mode)
        before, self._choice = self._choice, choose(t, self._mode, commands, obstacle, self._choice.source)
        hand_over = f"{before.source} {self._choice.source}" if before.source and self._choice.source else ""
        if before.source != self._choice.source and not (hand_over and not self._once.is_new(t, hand_over)):
            self._tell(t, f"commands from {self._choice.source or 'nobody'}", self._choice.reason)
        if self._choice.refused and t - self._refused_at >= REFUSALS_EVERY:
            self._refused_at = t
            self._tell(t, f"command refused: {self._choice.refused}", "it is not a velocity", Event.WARNING)
        if self._choice.twist.lateral and not self._drive.goes_sideways and t - self._refused_at >= REFUSALS_EVERY:
            self._refused_at = t
            self._tell(t, f"sideways velocity of {self._choice.source} left out", "it cannot drive sideways", Event.WARNING)

    def _wheels(self, t: float) -> WheelCommand:
        top_speed = self._engine.speed if self._mode == Mode.MODE_MISSION and self._engine.speed else self._body.max_linear
        asked = self._choice.twist if self._drive.goes_sideways else self._choice.twist._replace(lateral=0.0)
        wanted = within_limits(asked, self._ramp.limits, top_speed)
        if self._safety.brakes(self._here, wanted):
            wanted = Twist(0.0, wanted.angular)
        if self._safety.halts(wanted if _goes(wanted) else self._ramp.velocity):
            wanted = Twist(0.0, wanted.angular)
            self._ramp.stand()
        speeds = self._drive.wheels(self._ramp.lead(wanted, 1.0 / self.hz))
        return wheel_command(t, speeds, self._ramp.steering)

    def _report(self, t: float, position: Point | None, out: interface.Outputs) -> None:
        self._steps += 1
        out.params = self._told_params.news(t, self.params)
        out.events, self._events = self._events, []
        told = (self._mode, self._armed, self._stop.who)
        if self._steps % STATUS_EVERY == 1 or told != self._told:
            self._told = told
            out.status = self._status(t, position)
        if self._steps % PROGRESS_EVERY == 1:
            out.progress = self._engine.progress(stamp(t))
        if self._mission_is_new:
            out.mission = self._engine.mission
            self._mission_is_new = False
        if self._fence_is_new:
            out.bounds = self._safety.fence
            self._fence_is_new = False
        if self._rally_is_new:
            self._rally.timestamp.CopyFrom(stamp(t))
            out.rally = self._rally
            self._rally_is_new = False

    def _status(self, t: float, position: Point | None) -> VehicleStatus:
        battery = self._safety.battery
        return VehicleStatus(
            timestamp=stamp(t),
            kind=Kind.KIND_GROUND,
            mode=Mode.Name(self._mode),
            armed=self._armed,
            landed=True,
            stopped=bool(self._stop),
            stops=self._stop.engagements,
            command_source=self._choice.source,
            reason=self._choice.reason,
            throttle=hypot(self._ramp.velocity.linear, self._ramp.velocity.lateral) / self._body.max_linear,
            battery_remaining=battery.remaining if battery is not None else UNKNOWN_BATTERY,
            battery_voltage=battery.voltage if battery is not None else 0.0,
            prearm=self._safety.faults(),
            waypoint=self._engine.current,
            distance_to_waypoint=self._engine.distance_left(position),
            home=vector(self._engine.home),
            system_id=self._system_id,
            breach=Breach.BREACH_EDGE if self._safety.is_outside else Breach.BREACH_NONE,
            breaches=self._safety.breaches,
            failsafes=[rule.raised_text for rule in self._safety.watch.holding.values()],
        )

    def _tell(self, t: float, text: str, cause: str, severity: Event.Severity = Event.NOTICE) -> None:
        self._events.append(Event(timestamp=stamp(t), severity=severity, text=text, cause=cause, source="autopilot"))


def _velocity_command(m: DriveCommand) -> VelocityCommand:
    return VelocityCommand(seconds(m.timestamp), Twist(m.linear, m.angular, m.lateral))


def _goes(velocity: Twist) -> bool:
    """Whether it leads to another place."""
    return velocity.linear != 0.0 or velocity.lateral != 0.0
