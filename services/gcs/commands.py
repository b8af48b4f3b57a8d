"""What people ask for on the page, checked here before anything is sent: a page can ask for anything at any time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from google.protobuf.message import Message

from schemas.messages import (
    ClockRequest,
    DriveCommand,
    Event,
    GimbalCommand,
    GoalRequest,
    HomeCommand,
    LaunchRequest,
    MissionRequest,
    Mode,
    ModeRequest,
    PreviewRequest,
    StopCommand,
    Vector3,
    VehicleCommandRequest,
)
from services.gcs.actions import (
    AimGimbal,
    AnswerControl,
    Asked,
    ClickGround,
    Command,
    GimbalMode,
    LaunchMission,
    LeaveWheel,
    Point,
    ReleaseStop,
    RequestControl,
    Rescale,
    RunClock,
    SetRate,
    Steer,
    StopAll,
    TakeWheel,
    ground_point,
)
from services.gcs.browsing import Browsing
from services.gcs.by_hand import ManualDriving
from services.gcs.offers import SOURCE, STOPPED, offer_of
from services.gcs.orders import OrderBook
from services.gcs.planning import Planning
from services.gcs.planning_actions import OfPlan, PlanGoTo, PlanUpload
from services.gcs.state.control import called
from services.gcs.state.pointing import TOOLS, Pointed
from services.gcs.state.session import OLD_AFTER, BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.state.wording import GIMBAL_MODES, describe
from uvf.control.teleop_drive import SCALINGS, TeleopCommand
from uvf.runtime.contract.service import Answer
from uvf.runtime.messages.convert import stamp
from uvf.runtime.state.stop_all import StopVoice

REACH = 50.0  # m, how far outside the floor a goal of a ground vehicle may lie
CLOCK_ACTIONS = {
    "pause": ClockRequest.PAUSE,
    "resume": ClockRequest.RESUME,
    "step": ClockRequest.STEP,
    "reset": ClockRequest.RESET,
}
OBEYING_PLANNER = (Mode.MODE_MISSION, Mode.MODE_RETURN)


@dataclass
class Outbox:
    """The messages that a step sends, by the service's declared names."""

    stop: list[StopCommand] = field(default_factory=list)
    calls: dict[str, Any] = field(default_factory=dict)
    """Requests by the name of the call, then by vehicle; those to the system as a list."""
    drive: dict[str, Message] = field(default_factory=dict)
    gimbal: dict[str, Message] = field(default_factory=dict)

    def call(self, name: str, vehicle: str, request: Message) -> None:
        """Adds a request."""
        self.calls.setdefault(name, {}).setdefault(vehicle, []).append(request)

    def said(self) -> Mapping[str, Any]:
        """All of it by the names of the service's outputs."""
        return {"stop": self.stop, "drive": self.drive, "gimbal": self.gimbal, **self.calls}


class Commander:
    """Turns actions into requests, and follows each until it is answered."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._voice = StopVoice(SOURCE)
        self._back: dict[str, int] = {}
        self._mode_before: dict[str, int] = {}
        bodies = {v.name: v.member.file.ground for v in model.vehicles.values()}
        self.by_hand = ManualDriving({n: TeleopCommand(b.max_linear, b.max_angular) for n, b in bodies.items() if b is not None})
        self._browsing = Browsing(model, self.by_hand)
        self._orders = OrderBook(model)
        self.planning = Planning(model)

    def act(self, t: float, actions: Sequence[Asked]) -> Outbox:
        """The messages to send for the actions asked for at ``t`` [s, wall]."""
        out = Outbox()
        for name, before in self._back.items():
            out.call("mode", name, ModeRequest(mode=before, source=SOURCE))  # type: ignore[arg-type]
        self._back.clear()
        for action in actions:
            if not self._browsing.shows(t, action):
                session = self._model.sessions.get(action.page)
                if session is not None:
                    self._heed(t, session, action, out)
        self._hand_over(t)
        now = stamp(self._model.sim_time)
        for name, (linear, angular) in self.by_hand.commands(t).items():
            out.drive[name] = DriveCommand(timestamp=now, linear=linear, angular=angular)
        return out

    def _heed(self, t: float, session: BrowserSession, action: Asked, out: Outbox) -> None:
        match action:
            case StopAll():
                self._stop(t, session, True, out)
            case ReleaseStop():
                self._stop(t, session, False, out)
            case ClickGround(_, origin, direction):
                self._click(t, session, ground_point(origin, direction), out)
            case Point(_, tool):
                self._point(t, session, tool, out)
            case Command(_, vehicle, key):
                self._command(t, session, vehicle, key, out)
            case RequestControl() | AnswerControl():
                self._negotiate(t, session, action)
            case TakeWheel(page, vehicle):
                self._take_wheel(t, session, vehicle, out)
            case LeaveWheel(page):
                self.by_hand.let_go(t, page)
            case Steer(page, forward, left):
                self.by_hand.steer(t, page, (forward, left))
            case Rescale(page, key) if key in SCALINGS:
                self.by_hand.rescale(t, page, key)
            case AimGimbal() | GimbalMode():
                self._aim(t, session, action, out)
            case RunClock() | SetRate() | LaunchMission():
                self._run(t, session, action, out)
            case OfPlan():
                self._plan(t, session, action, out)

    def _reason_against(self, session: BrowserSession, v: VehicleModel) -> str:
        """Why this page may not command the vehicle: another operator controls it."""
        return self._model.control.reason_against(v.name, session.operator, self._model.present)

    def _takes_control(self, session: BrowserSession, v: VehicleModel) -> None:
        if self._model.control.take(v.name, session.operator):
            self._model.note(v.name, f"{called(session.operator)} controls it", Event.NOTICE, of_operator=True)

    def _begin(self, t: float, session: BrowserSession, name: str, request: Message, why_not: str = "") -> VehicleModel | None:
        """The vehicle, if the request may be sent to it from this page; else it is refused at once, with the reason."""
        vehicle = self._model.vehicles.get(name)
        if vehicle is None:
            return None
        why = self._reason_against(session, vehicle) or why_not
        if why:
            self._orders.refuse(t, vehicle, describe(request), why)
            return None
        if not self._orders.open(t, vehicle, request):
            return None
        self._takes_control(session, vehicle)
        return vehicle

    def _command(self, t: float, session: BrowserSession, name: str, key: str, out: Outbox) -> None:
        vehicle = self._model.vehicles.get(name)
        offer = offer_of(self._model, vehicle, key) if vehicle is not None else None
        if vehicle is None or offer is None:
            return
        if offer.risky and not offer.why_not:
            if session.behind(t) > OLD_AFTER:
                why = f"this page shows what is {session.behind(t):.0f} s old: wait until it is live"
                self._orders.refuse(t, vehicle, describe(offer.request), why)
                return
            if not session.confirms(name, key, t):
                session.to_confirm = (name, key, t)
                return
        session.to_confirm = None
        if self._begin(t, session, name, offer.request, offer.why_not) is not None:
            if offer.name == "mode" and key != "manual":
                self.by_hand.free(t, name)
            out.call(offer.name, name, offer.request)

    def _aim(self, t: float, session: BrowserSession, asked: AimGimbal | GimbalMode, out: Outbox) -> None:
        vehicle = self._model.vehicles.get(asked.vehicle)
        gimbal = vehicle.member.file.sensors.gimbal if vehicle is not None else None
        if vehicle is None or gimbal is None:
            return
        if why := self._reason_against(session, vehicle):
            self._orders.refuse(t, vehicle, "turn the gimbal", why)
            return
        aim = GimbalCommand()
        aim.CopyFrom(vehicle.aim)
        aim.timestamp.CopyFrom(stamp(self._model.sim_time))
        match asked:
            case AimGimbal(axis="pan"):
                aim.pan = float(np.clip(np.radians(asked.degrees), -gimbal.pan_max, gimbal.pan_max))
            case AimGimbal():
                aim.tilt = float(np.clip(np.radians(asked.degrees), gimbal.tilt_min, gimbal.tilt_max))
            case GimbalMode(_, _, mode) if mode in GIMBAL_MODES:
                aim.mode = GIMBAL_MODES[mode]
        vehicle.aim = out.gimbal[vehicle.name] = aim

    def _run(self, t: float, session: BrowserSession, action: RunClock | SetRate | LaunchMission, out: Outbox) -> None:
        """What concerns the simulation as a whole: anybody may ask for it, and what loses the run wants a second click."""
        request: Message
        match action:
            case RunClock(_, what):
                name, request = "clock_request", ClockRequest(action=CLOCK_ACTIONS[what])
            case SetRate(_, rate):
                name, request = "clock_request", ClockRequest(action=ClockRequest.SET_RATE, rate=rate)
            case LaunchMission(_, mission):
                name, request = "launch", LaunchRequest(mission=mission, source=SOURCE)
        key = f"{name} {getattr(action, 'what', getattr(action, 'mission', ''))}"
        loses = isinstance(action, LaunchMission) or (isinstance(action, RunClock) and action.what == "reset")
        if loses and not session.confirms("", key, t):
            session.to_confirm = ("", key, t)
            return
        session.to_confirm = None
        self._orders.open(t, None, request)
        out.calls.setdefault(name, []).append(request)

    def _plan(self, t: float, session: BrowserSession, action: OfPlan, out: Outbox) -> None:
        """Edits, uploads and item jumps of a mission; all of them are the controlling operator's."""
        vehicle = self._model.vehicles.get(action.vehicle)
        if vehicle is None:
            return
        match action:
            case PlanUpload():
                why = vehicle.outlook.fault if vehicle.outlook is not None else ""
                risky = not why and vehicle.status is not None and vehicle.status.armed and vehicle.status.mode == Mode.MODE_MISSION
                if risky and not session.confirms(vehicle.name, "upload", t):
                    session.to_confirm = (vehicle.name, "upload", t)
                    return
                session.to_confirm = None
                request: Message = self.planning.upload(vehicle)
                name = "set_mission"
            case PlanGoTo(_, _, index):
                request, name, why = self.planning.go_to(index), "current", ""
            case _ if why := self._reason_against(session, vehicle):
                self._orders.refuse(t, vehicle, "edit the mission", why)
                return
            case _:
                session.pointed = None
                self.planning.edit(vehicle, action)
                return
        if self._begin(t, session, vehicle.name, request, why) is not None:
            out.call(name, vehicle.name, request)
        elif isinstance(request, MissionRequest):
            self.planning.refused(vehicle)

    def _stop(self, t: float, session: BrowserSession, engaged: bool, out: Outbox) -> None:
        if engaged:
            self.by_hand.leave(t)
        now_ns = round(self._model.sim_time * 1e9)
        stops = self._model.stops
        out.stop.append(self._voice.engage(now_ns, "pressed on the page") if engaged else self._voice.release(now_ns, stops))
        text = f"STOP ALL {'engaged' if engaged else 'released'} on the page by {called(session.operator)}"
        self._model.note("", text, Event.WARNING if engaged else Event.NOTICE, of_operator=True)

    def _click(self, t: float, session: BrowserSession, point: tuple[float, float] | None, out: Outbox) -> None:
        """Opens the menu of the place that was clicked, or is the second click that it waits for."""
        before, vehicle = session.pointed, self._model.vehicles.get(session.vehicle)
        if point is None or vehicle is None:
            session.pointed = None
        elif before is not None and before.tool == "face":
            yaw = float(np.arctan2(point[1] - before.y, point[0] - before.x))
            self._go(t, session, before, yaw, out)
        elif before is not None and before.tool == "measure":
            before.to = point
        else:
            session.pointed = Pointed(*point, session.vehicle)
            if not vehicle.flies and self._is_on_floor(point):
                preview = PreviewRequest(position=Vector3(x=point[0], y=point[1]), source=SOURCE)
                out.call("preview", vehicle.name, preview)

    def _point(self, t: float, session: BrowserSession, tool: str, out: Outbox) -> None:
        pointed = session.pointed
        if pointed is None or tool not in TOOLS:
            session.pointed = None
        elif tool == "go":
            self._go(t, session, pointed, float("nan"), out)
        elif tool == "home":
            self._set_home(t, session, pointed, out)
        else:
            pointed.tool = tool

    def _is_on_floor(self, point: tuple[float, float]) -> bool:
        x_min, y_min, x_max, y_max = self._model.site.world.floor
        return x_min - REACH <= point[0] <= x_max + REACH and y_min - REACH <= point[1] <= y_max + REACH

    def _go(self, t: float, session: BrowserSession, at: Pointed, yaw: float, out: Outbox) -> None:
        session.pointed = None
        vehicle = self._model.vehicles.get(at.vehicle)
        height = vehicle.nav.position.z if vehicle is not None and vehicle.flies and vehicle.nav is not None else 0.0
        request = GoalRequest(position=Vector3(x=at.x, y=at.y, z=height), yaw=yaw, source=SOURCE)
        why = self._cannot_go(vehicle, (at.x, at.y)) if vehicle is not None else ""
        if vehicle is None or self._begin(t, session, vehicle.name, request, why) is None:
            return
        vehicle.goal_asked = (at.x, at.y)
        self.by_hand.free(t, vehicle.name)
        self._mode_before.pop(vehicle.name, None)
        if not vehicle.flies and vehicle.status is not None and vehicle.status.mode not in OBEYING_PLANNER:
            self._mode_before[vehicle.name] = vehicle.status.mode
            out.call("mode", vehicle.name, ModeRequest(mode=Mode.MODE_MISSION, source=SOURCE))
        out.call("goal", vehicle.name, request)

    def _cannot_go(self, vehicle: VehicleModel, point: tuple[float, float]) -> str:
        """Why a goal would be accepted and yet nothing would move, and the mend; empty when it would."""
        if not vehicle.flies and not self._is_on_floor(point):
            return "too far from the floor"
        return self._cannot_move(vehicle)

    def _cannot_move(self, vehicle: VehicleModel) -> str:
        if self._model.stopped:
            return STOPPED
        if vehicle.status is not None and not vehicle.status.armed:
            return f"{vehicle.name} is disarmed: arm it first"
        return ""

    def _set_home(self, t: float, session: BrowserSession, at: Pointed, out: Outbox) -> None:
        session.pointed = None
        vehicle = self._model.vehicles.get(at.vehicle)
        height = vehicle.status.home.z if vehicle is not None and vehicle.status is not None else 0.0
        request = VehicleCommandRequest(home=HomeCommand(position=Vector3(x=at.x, y=at.y, z=height)), source=SOURCE)
        if self._begin(t, session, at.vehicle, request) is not None:
            out.call("vehicle_command", at.vehicle, request)

    def _take_wheel(self, t: float, session: BrowserSession, name: str, out: Outbox) -> None:
        """Like ``uvf teleop``, it asks for mode MANUAL; arming stays a matter of two clicks."""
        vehicle, request = self._model.vehicles.get(name), ModeRequest(mode=Mode.MODE_MANUAL, source=SOURCE)
        if session.vehicle != name or vehicle is None or not self.by_hand.can_drive(name):
            return
        if self._begin(t, session, name, request, self._cannot_move(vehicle)) is not None:
            out.call("mode", name, request)
            self._mode_before.pop(name, None)
            self.by_hand.take(t, session.page, name)

    def _negotiate(self, t: float, session: BrowserSession, asked: RequestControl | AnswerControl) -> None:
        """Asks for control, gives it away or keeps it."""
        control, vehicle = self._model.control, self._model.vehicles.get(asked.vehicle)
        if vehicle is None or not session.operator:
            return
        match asked:
            case RequestControl():
                control.ask(t, vehicle.name, session.operator)
                self._model.note(vehicle.name, f"{called(session.operator)} asks for control", Event.NOTICE, of_operator=True)
            case AnswerControl(_, _, give) if control.holders.get(vehicle.name) == session.operator and vehicle.name in control.asking:
                if give:
                    self._give(t, vehicle, control.asking[vehicle.name][0])
                else:
                    control.keep(vehicle.name)
                    self._model.note(vehicle.name, f"{called(session.operator)} keeps control", Event.NOTICE, of_operator=True)

    def _hand_over(self, t: float) -> None:
        for name, operator in self._model.control.due(t, self._model.present):
            if name in self._model.vehicles:
                self._give(t, self._model.vehicles[name], operator)

    def _give(self, t: float, vehicle: VehicleModel, operator: str) -> None:
        self.by_hand.free(t, vehicle.name)
        self._model.control.take(vehicle.name, operator)
        line = self._model.note(vehicle.name, f"{called(operator)} controls it from now on", Event.NOTICE, of_operator=True)
        self._model.log.tell(t, line)

    def hear(self, t: float, answers: Sequence[Answer[Any, Any]]) -> None:
        """Takes the answers to earlier requests at ``t`` [s, wall]."""
        for answer in answers:
            vehicle = self._model.vehicles.get(answer.vehicle)
            if isinstance(answer.request, ClockRequest | LaunchRequest):
                self._orders.settle(t, None, answer)
            if vehicle is None:
                continue
            if isinstance(answer.request, PreviewRequest):
                self._browsing.preview(vehicle.name, answer)
                continue
            accepted = self._orders.settle(t, vehicle, answer)
            if isinstance(answer.request, MissionRequest) and not accepted:
                self.planning.refused(vehicle)
            if isinstance(answer.request, GoalRequest) and not accepted:
                vehicle.goal_asked = None
                self._undo_mode(vehicle.name)

    def _undo_mode(self, vehicle: str) -> None:
        """A goal that is refused changes nothing: the mode that was set for it goes back with the next step."""
        if vehicle in self._mode_before:
            self._back[vehicle] = self._mode_before.pop(vehicle)

    def expire(self, t: float) -> None:
        """Shows orders that were not answered by ``t`` [s, wall] as refused."""
        self._orders.expire(t)
