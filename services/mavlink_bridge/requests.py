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
    OrderRequest,
    ParamReply,
    ParamRequest,
    RallyRequest,
    Reply,
    SetCurrentRequest,
    Vector3,
)
from services.mavlink_bridge.autopilot import Autopilot
from services.mavlink_bridge.commands import NAN, command
from services.mavlink_bridge.frame import Chart
from services.mavlink_bridge.wire import Done
from uvf.runtime.mavlink import dialect as mav
from uvf.runtime.service import Later

ANSWER_WITHIN = 4.5  # s: whoever asks over the bus hears nothing after 5
FORCE = {True: 2989.0, False: 21196.0}
CHANGE_MODE = float(mav.MAV_DO_REPOSITION_FLAGS_CHANGE_MODE)
AMSL = mav.MAV_FRAME_GLOBAL
MOVING = (ModeRequest, GoalRequest, OrbitRequest, OrderRequest, GoAroundRequest, SetCurrentRequest)
"""What STOP ALL forbids; arming is forbidden beside."""


class Requests:
    """``stopped`` is set while STOP ALL is engaged."""

    def __init__(self, autopilot: Autopilot) -> None:
        self._autopilot = autopilot
        self.stopped = False
        self._open: list[tuple[float, Later[Any], type[Any]]] = []
        """(until when, what is not answered yet, by what kind of reply)."""

    def ask(self, request: Message) -> Later[Any]:
        """The reply comes with a later step, or with this one."""
        later: Later[Any] = Later()
        kind = ParamReply if isinstance(request, ParamRequest) else Reply

        def done(accepted: bool, reason: str) -> None:
            later.give(Reply(accepted=accepted, reason="" if accepted else reason))

        if self._autopilot.is_lost:
            later.give(kind(accepted=False, reason="no link to the autopilot"))
        elif self.stopped and (isinstance(request, MOVING) or (isinstance(request, ArmRequest) and request.arm)):
            done(False, "STOP ALL is engaged: release it first")
        elif isinstance(request, ParamRequest):
            self._autopilot.parameters.ask(request.name, request.value, later.give)
        else:
            HANDLERS[type(request)](self._autopilot, request, done)
        self._open.append((self._autopilot.wire.t + ANSWER_WITHIN, later, kind))
        return later

    def tick(self) -> None:
        """Whoever asks over the bus is not left without an answer."""
        for until, later, kind in self._open:
            if later.reply is None and self._autopilot.wire.t >= until:
                later.give(kind(accepted=False, reason=f"not done within {ANSWER_WITHIN:g} s; it may still be"))
        self._open = [each for each in self._open if each[1].reply is None]


def hold(autopilot: Autopilot, done: Done) -> None:
    set_mode(autopilot, Mode.MODE_HOLD, done)


def set_mode(autopilot: Autopilot, mode: Mode, done: Done) -> None:
    custom = autopilot.modes.custom_of(mode)
    if custom is None:
        done(False, f"the autopilot has no mode like {Mode.Name(mode).removeprefix('MODE_').capitalize()}")
        return
    autopilot.commands.ask(command(mav.MAV_CMD_DO_SET_MODE, (*autopilot.modes.command_parameters(custom), 0.0, 0.0, 0.0, 0.0), done))


def arm(autopilot: Autopilot, armed: bool, force: bool, done: Done) -> None:
    p = (float(armed), FORCE[armed] if force else 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    autopilot.commands.ask(command(mav.MAV_CMD_COMPONENT_ARM_DISARM, p, done))


def _arm(autopilot: Autopilot, request: ArmRequest, done: Done) -> None:
    arm(autopilot, request.arm, request.force, done)


def _mode(autopilot: Autopilot, request: ModeRequest, done: Done) -> None:
    set_mode(autopilot, request.mode, done)


def _cancel(autopilot: Autopilot, request: CancelRequest, done: Done) -> None:
    hold(autopilot, done)


def _current(autopilot: Autopilot, request: SetCurrentRequest, done: Done) -> None:
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


def _where(chart: Chart, place: Vector3) -> tuple[float, float, float]:
    """deg, deg, m AMSL."""
    latitude, longitude, _ = chart.geodetic((place.x, place.y, place.z))  # type: ignore[arg-type]
    return latitude, longitude, place.z + chart.origin.altitude


def _goal(autopilot: Autopilot, request: GoalRequest, chart: Chart, done: Done) -> None:
    """Aircraft circle over it (direction by the radius' sign), ground vehicles drive there and stand."""
    at = _where(chart, request.position)
    speed = request.speed if request.speed > 0 else -1.0
    flies = autopilot.told.kind == Kind.KIND_FIXED_WING
    way = float(request.radius < 0) if flies else math.pi / 2 - request.yaw if math.isfinite(request.yaw) else NAN
    p = (speed, CHANGE_MODE, abs(request.radius), way, *at)
    autopilot.commands.ask(command(mav.MAV_CMD_DO_REPOSITION, p, done, AMSL))


def _orbit(autopilot: Autopilot, request: OrbitRequest, chart: Chart, done: Done) -> None:
    p = (request.radius or NAN, request.speed or NAN, 0.0, NAN, *_where(chart, request.centre))
    autopilot.commands.ask(command(mav.MAV_CMD_DO_ORBIT, p, done, AMSL))


def _go_around(autopilot: Autopilot, request: GoAroundRequest, done: Done) -> None:
    autopilot.commands.ask(command(mav.MAV_CMD_DO_GO_AROUND, (0.0,) * 7, done))


def _order(autopilot: Autopilot, request: OrderRequest, done: Done) -> None:
    kind = request.WhichOneof("kind")
    if kind is None:
        done(False, "the order is empty")
        return
    ORDERS[kind](autopilot, getattr(request, kind), done)


def _takeoff(autopilot: Autopilot, order: Any, chart: Chart, done: Done) -> None:
    """Where it stands, up to a height: above the sea for PX4, above home for the others."""
    if autopilot.told.heartbeat.autopilot == mav.MAV_AUTOPILOT_PX4:
        p = (*(NAN,) * 6, order.altitude + chart.origin.altitude)
    else:
        p = (*(0.0,) * 6, order.altitude - autopilot.plans.home_z)
    autopilot.commands.ask(command(mav.MAV_CMD_NAV_TAKEOFF, p, done))


def _speed(autopilot: Autopilot, order: Any, done: Done) -> None:
    over_ground = order.over_ground or autopilot.told.kind == Kind.KIND_GROUND
    p = (float(over_ground), order.speed if order.speed > 0 else -2.0, -1.0, 0.0, 0.0, 0.0, 0.0)
    autopilot.commands.ask(command(mav.MAV_CMD_DO_CHANGE_SPEED, p, done))


def _altitude(autopilot: Autopilot, order: Any, chart: Chart, done: Done) -> None:
    """As QGroundControl asks it of PX4: a new place that is only higher or lower."""
    amsl = order.altitude + chart.origin.altitude
    if autopilot.is_ardupilot:
        autopilot.commands.ask(command(mav.MAV_CMD_DO_CHANGE_ALTITUDE, (amsl, float(AMSL), 0.0, 0.0, 0.0, 0.0, 0.0), done))
    else:
        autopilot.commands.ask(command(mav.MAV_CMD_DO_REPOSITION, (-1.0, CHANGE_MODE, 0.0, NAN, NAN, NAN, amsl), done))


def _home(autopilot: Autopilot, order: Any, chart: Chart, done: Done) -> None:
    if order.HasField("position"):
        p = (0.0, 0.0, 0.0, NAN, *_where(chart, order.position))
        autopilot.commands.ask(command(mav.MAV_CMD_DO_SET_HOME, p, done, AMSL))
    else:
        autopilot.commands.ask(command(mav.MAV_CMD_DO_SET_HOME, (1.0, 0.0, 0.0, NAN, 0.0, 0.0, 0.0), done))


def _picture(autopilot: Autopilot, order: Any, done: Done) -> None:
    if order.HasField("distance"):
        asked = command(mav.MAV_CMD_DO_SET_CAM_TRIGG_DIST, (order.distance, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), done)
    else:
        asked = command(mav.MAV_CMD_DO_DIGICAM_CONTROL, (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0), done)
    autopilot.commands.ask(asked)


def _restart(autopilot: Autopilot, order: Any, done: Done) -> None:
    autopilot.commands.ask(command(mav.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), done))


ORDERS: dict[str, Callable[[Autopilot, Any, Done], None]] = {
    "takeoff": _placed(_takeoff),
    "speed": _speed,
    "altitude": _placed(_altitude),
    "home": _placed(_home),
    "picture": _picture,
    "restart": _restart,
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
    OrderRequest: _order,
    CancelRequest: _cancel,
}
