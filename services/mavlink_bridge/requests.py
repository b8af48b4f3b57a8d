"""What the bus asks of a vehicle, as commands to its autopilot; each is answered once the autopilot has."""

import math
from collections.abc import Callable
from typing import Any

from google.protobuf.message import Message

from schemas.messages import (
    ArmRequest,
    CancelRequest,
    FenceRequest,
    GoalRequest,
    GoAroundRequest,
    Kind,
    MissionRequest,
    Mode,
    ModeRequest,
    OrbitRequest,
    ParamReply,
    ParamRequest,
    RallyRequest,
    Reply,
    SetCurrentRequest,
    VehicleCommandRequest,
)
from services.mavlink_bridge.autopilot import Autopilot
from services.mavlink_bridge.commands import ANSWER_WITHIN, NAN, PendingCommand, command
from services.mavlink_bridge.connection import Done
from services.mavlink_bridge.frame import Chart
from services.mavlink_bridge.limits import OutOfLimits, amsl, where
from uvf.mavlink import dialect as mav
from uvf.runtime.contract.service import Later
from uvf.runtime.mavlink.limits import HIGHEST
from uvf.runtime.messages.convert import mode_name

FORCE = {True: 2989.0, False: 21196.0}
CHANGE_MODE = float(mav.MAV_DO_REPOSITION_FLAGS_CHANGE_MODE)
AMSL = mav.MAV_FRAME_GLOBAL
LAST_ITEM = 0xFFFE  # a plan's highest number on the wire; the next one is "unknown"
FASTEST = 1000.0  # m/s
MOVING = (ModeRequest, GoalRequest, OrbitRequest, VehicleCommandRequest, GoAroundRequest, SetCurrentRequest)
"""What STOP ALL forbids; arming is forbidden beside."""


class Requests:
    """Passes requests from the bus on to the autopilot. ``stopped``: who engages STOP ALL, "" if nobody does."""

    def __init__(self, autopilot: Autopilot) -> None:
        self._autopilot = autopilot
        self.stopped = ""
        self._open: list[tuple[float, Later[Any], type[Any]]] = []
        """(until when, what is not answered yet, by what kind of reply)."""

    def ask(self, request: Message) -> Later[Any]:
        """Passes a request on; the reply comes with this step or a later one."""
        later: Later[Any] = Later()
        kind = ParamReply if isinstance(request, ParamRequest) else Reply

        def done(accepted: bool, reason: str) -> None:
            later.give(Reply(accepted=accepted, reason="" if accepted else reason))

        if self._autopilot.is_lost:
            later.give(kind(accepted=False, reason="no link to the autopilot"))
        elif self.stopped and (isinstance(request, MOVING) or (isinstance(request, ArmRequest) and request.arm)):
            done(False, f"STOP ALL is engaged by {self.stopped}: release it first")
        elif isinstance(request, ParamRequest):
            self._autopilot.parameters.ask(request.name, request.value, later.give)
        else:
            try:
                HANDLERS[type(request)](self._autopilot, request, done)
            except OutOfLimits as refused:
                done(False, str(refused))
        self._open.append((self._autopilot.wire.t + ANSWER_WITHIN, later, kind))
        return later

    def tick(self) -> None:
        """Answers requests that were not answered in time."""
        for until, later, kind in self._open:
            if later.reply is None and self._autopilot.wire.t >= until:
                later.give(kind(accepted=False, reason=f"not done within {ANSWER_WITHIN:g} s; it may still be"))
        self._open = [each for each in self._open if each[1].reply is None]


def hold(autopilot: Autopilot, done: Done) -> None:
    """Requests mode Hold."""
    set_mode(autopilot, Mode.MODE_HOLD, done)


def set_mode(autopilot: Autopilot, mode: Mode, done: Done) -> None:
    """Requests a mode; mode Hold is sent ahead of all others."""
    custom = autopilot.modes.custom_of(mode)
    if custom is None:
        done(False, f"the autopilot has no mode like {mode_name(mode).capitalize()}")
        return
    asked = command(mav.MAV_CMD_DO_SET_MODE, (*autopilot.modes.command_parameters(custom), 0.0, 0.0, 0.0, 0.0), done)
    _send(autopilot, asked, mode == Mode.MODE_HOLD)


def arm(autopilot: Autopilot, armed: bool, force: bool, done: Done) -> None:
    """Requests arming or disarming; disarming is sent ahead of all others."""
    p = (float(armed), FORCE[armed] if force else 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    _send(autopilot, command(mav.MAV_CMD_COMPONENT_ARM_DISARM, p, done), not armed)


def _send(autopilot: Autopilot, asked: PendingCommand, first: bool) -> None:
    if first:
        autopilot.commands.ask_first(asked)
    else:
        autopilot.commands.ask(asked)


def _arm(autopilot: Autopilot, request: ArmRequest, done: Done) -> None:
    arm(autopilot, request.arm, request.force, done)


def _mode(autopilot: Autopilot, request: ModeRequest, done: Done) -> None:
    if request.mode not in Mode.values():
        raise OutOfLimits(f"there is no mode {request.mode}: name one of {', '.join(map(mode_name, Mode.values()[1:]))}")
    set_mode(autopilot, request.mode, done)


def _cancel(autopilot: Autopilot, request: CancelRequest, done: Done) -> None:
    hold(autopilot, done)


def _current(autopilot: Autopilot, request: SetCurrentRequest, done: Done) -> None:
    mission = autopilot.plans.mission
    last = len(mission.items) - 1 if mission is not None else LAST_ITEM - autopilot.first
    if request.index > last:
        raise OutOfLimits(
            f"there is no mission item {request.index}: " + (f"the last one is {last}" if last >= 0 else "there is no mission")
        )
    seq = float(request.index + autopilot.first)
    autopilot.commands.ask(command(mav.MAV_CMD_DO_SET_MISSION_CURRENT, (seq, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), done))


def _mission(autopilot: Autopilot, request: MissionRequest, done: Done) -> None:
    autopilot.plans.write(request.mission, done)


def _fence(autopilot: Autopilot, request: FenceRequest, done: Done) -> None:
    autopilot.plans.write(request.fence, done)


def _rally(autopilot: Autopilot, request: RallyRequest, done: Done) -> None:
    autopilot.plans.write(request.rally, done)


def _placed(handle: Callable[[Autopilot, Any, Chart, Done], None]) -> Callable[[Autopilot, Any, Done], None]:
    """For what names a place: not before it is known where the world lies."""

    def handler(autopilot: Autopilot, request: Any, done: Done) -> None:
        if autopilot.chart is None:
            done(False, "the autopilot has not told yet where it is")
        else:
            handle(autopilot, request, autopilot.chart, done)

    return handler


def _radius(value: float) -> float:
    return _within("a radius", value, -HIGHEST, HIGHEST, "m")


def _flyable(speed: float) -> float:
    return _within("a speed", speed, 0.0, FASTEST, "m/s")


def _within(what: str, value: float, low: float, high: float, unit: str) -> float:
    """Raises OutOfLimits."""
    if not low <= value <= high:
        raise OutOfLimits(f"{what} of {value:g} {unit}: name one from {low:g} to {high:g} {unit}")
    return value


def _goal(autopilot: Autopilot, request: GoalRequest, chart: Chart, done: Done) -> None:
    """Aircraft circle over it (direction by the radius' sign), ground vehicles drive there and stand."""
    at = where(chart, request.position)
    speed = _flyable(request.speed) if request.speed > 0 else -1.0
    flies = autopilot.told.kind == Kind.KIND_FIXED_WING
    way = float(request.radius < 0) if flies else math.pi / 2 - request.yaw if math.isfinite(request.yaw) else NAN
    p = (speed, CHANGE_MODE, abs(_radius(request.radius)), way, *at)
    autopilot.commands.ask(command(mav.MAV_CMD_DO_REPOSITION, p, done, AMSL))


def _orbit(autopilot: Autopilot, request: OrbitRequest, chart: Chart, done: Done) -> None:
    p = (_radius(request.radius) or NAN, _flyable(request.speed) or NAN, 0.0, NAN, *where(chart, request.centre))
    autopilot.commands.ask(command(mav.MAV_CMD_DO_ORBIT, p, done, AMSL))


def _go_around(autopilot: Autopilot, request: GoAroundRequest, done: Done) -> None:
    autopilot.commands.ask(command(mav.MAV_CMD_DO_GO_AROUND, (0.0,) * 7, done))


def _order(autopilot: Autopilot, request: VehicleCommandRequest, done: Done) -> None:
    kind = request.WhichOneof("kind")
    if kind is None:
        done(False, "the order is empty")
        return
    ORDERS[kind](autopilot, getattr(request, kind), done)


def _takeoff(autopilot: Autopilot, order: Any, chart: Chart, done: Done) -> None:
    """Where it stands, up to a height: above the sea for PX4, above home for the others."""
    to = amsl(chart, order.altitude)
    if autopilot.told.heartbeat.autopilot == mav.MAV_AUTOPILOT_PX4:
        p = (*(NAN,) * 6, to)
    else:
        p = (*(0.0,) * 6, order.altitude - autopilot.plans.home_z)
    autopilot.commands.ask(command(mav.MAV_CMD_NAV_TAKEOFF, p, done))


def _speed(autopilot: Autopilot, order: Any, done: Done) -> None:
    over_ground = order.over_ground or autopilot.told.kind == Kind.KIND_GROUND
    p = (float(over_ground), _flyable(order.speed) if order.speed > 0 else -2.0, -1.0, 0.0, 0.0, 0.0, 0.0)
    autopilot.commands.ask(command(mav.MAV_CMD_DO_CHANGE_SPEED, p, done))


def _altitude(autopilot: Autopilot, order: Any, chart: Chart, done: Done) -> None:
    """As QGroundControl asks it of PX4: a new place that is only higher or lower."""
    to = amsl(chart, order.altitude)
    if autopilot.is_ardupilot:
        autopilot.commands.ask(command(mav.MAV_CMD_DO_CHANGE_ALTITUDE, (to, float(AMSL), 0.0, 0.0, 0.0, 0.0, 0.0), done))
    else:
        autopilot.commands.ask(command(mav.MAV_CMD_DO_REPOSITION, (-1.0, CHANGE_MODE, 0.0, NAN, NAN, NAN, to), done))


def _home(autopilot: Autopilot, order: Any, chart: Chart, done: Done) -> None:
    if order.HasField("position"):
        p = (0.0, 0.0, 0.0, NAN, *where(chart, order.position))
        autopilot.commands.ask(command(mav.MAV_CMD_DO_SET_HOME, p, done, AMSL))
    else:
        autopilot.commands.ask(command(mav.MAV_CMD_DO_SET_HOME, (1.0, 0.0, 0.0, NAN, 0.0, 0.0, 0.0), done))


def _picture(autopilot: Autopilot, order: Any, done: Done) -> None:
    if order.HasField("distance"):
        apart = _within("a distance between pictures", order.distance, 0.0, HIGHEST, "m")
        asked = command(mav.MAV_CMD_DO_SET_CAM_TRIGG_DIST, (apart, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), done)
    else:
        asked = command(mav.MAV_CMD_DO_DIGICAM_CONTROL, (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0), done)
    autopilot.commands.ask(asked)


def _reboot(autopilot: Autopilot, order: Any, done: Done) -> None:
    autopilot.commands.ask(command(mav.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), done))


ORDERS: dict[str, Callable[[Autopilot, Any, Done], None]] = {
    "takeoff": _placed(_takeoff),
    "speed": _speed,
    "altitude": _placed(_altitude),
    "home": _placed(_home),
    "picture": _picture,
    "reboot": _reboot,
}
HANDLERS: dict[type[Message], Callable[[Autopilot, Any, Done], None]] = {
    ArmRequest: _arm,
    ModeRequest: _mode,
    MissionRequest: _mission,
    SetCurrentRequest: _current,
    FenceRequest: _fence,
    RallyRequest: _rally,
    GoalRequest: _placed(_goal),
    OrbitRequest: _placed(_orbit),
    GoAroundRequest: _go_around,
    VehicleCommandRequest: _order,
    CancelRequest: _cancel,
}
