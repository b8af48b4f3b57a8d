"""What people ask for on the page, checked here before anything is sent: a page can ask for anything at any time."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from google.protobuf.message import Message
from numpy.typing import NDArray

from schemas.messages import (
    ArmRequest,
    CancelRequest,
    DriveCommand,
    Event,
    GimbalCommand,
    GoalRequest,
    Mode,
    ModeRequest,
    StopCommand,
    Vector3,
)
from services.gcs.actions import (
    Action,
    AimGimbal,
    Arm,
    Cancel,
    ClickGround,
    Join,
    Layer,
    Leave,
    LeaveWheel,
    Looking,
    Rescale,
    Select,
    SetMode,
    ShowCamera,
    Shown,
    Steer,
    StopAll,
    TakeWheel,
    ground_point,
)
from services.gcs.by_hand import ManualDriving
from services.gcs.state.session import ROOTS, BrowserSession
from services.gcs.state.state import LOST_AFTER, Model, Order, VehicleModel
from services.gcs.state.wording import describe, modes_of
from uvf.control.teleop_drive import SCALINGS, TeleopCommand
from uvf.runtime.contract.service import Answer
from uvf.runtime.messages.convert import stamp
from uvf.runtime.state.stop_all import StopVoice

Floats = NDArray[np.float64]

SOURCE = "gcs"
CONFIRM_WITHIN = 5.0  # s
ANSWER_WITHIN = 5.0  # s
REACH = 50.0  # m, how far outside the floor a goal may still lie
OBEYING_PLANNER = (Mode.MODE_MISSION, Mode.MODE_RETURN)


@dataclass
class Outbox:
    """The messages that a step sends, by the service's declared names."""

    stop: list[StopCommand] = field(default_factory=list)
    arm: dict[str, list[Message]] = field(default_factory=dict)
    mode: dict[str, list[Message]] = field(default_factory=dict)
    goal: dict[str, list[Message]] = field(default_factory=dict)
    cancel: dict[str, list[Message]] = field(default_factory=dict)
    drive: dict[str, Message] = field(default_factory=dict)
    gimbal: dict[str, Message] = field(default_factory=dict)


class Commander:
    """Turns actions into requests, and follows each until it is answered."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._voice = StopVoice(SOURCE)
        self._mode_before: dict[str, int] = {}
        self._back: dict[str, int] = {}
        bodies = {v.name: v.member.file.ground for v in model.vehicles.values()}
        self.by_hand = ManualDriving({n: TeleopCommand(b.max_linear, b.max_angular) for n, b in bodies.items() if b is not None})

    def waits_for_confirmation(self, session: BrowserSession, vehicle: str, arm: bool, t: float) -> bool:
        """Whether a second click at ``t`` [s, wall] would arm (or disarm) the vehicle."""
        asked = session.to_confirm
        return asked is not None and asked[:2] == (vehicle, arm) and t - asked[2] <= CONFIRM_WITHIN

    def act(self, t: float, actions: Sequence[Action]) -> Outbox:
        """The messages to send for the actions asked for at ``t`` [s, wall]."""
        out = Outbox()
        for name, before in self._back.items():
            out.mode[name] = [ModeRequest(mode=before, source=SOURCE)]  # type: ignore[arg-type]
        self._back.clear()
        for action in actions:
            match action:
                case Join() | Leave() | Select() | Layer() | ShowCamera() | Looking():
                    self._show(t, action)
                case StopAll(engaged):
                    self._stop(t, engaged, out)
                case ClickGround(vehicle, origin, direction):
                    self._go(t, vehicle, ground_point(origin, direction), out)
                case Arm():
                    self._arm(t, action, out)
                case SetMode(vehicle, mode):
                    self._set_mode(t, vehicle, mode, out)
                case Cancel(vehicle):
                    self._cancel(t, vehicle, out)
                case TakeWheel(page, vehicle):
                    self._take_wheel(t, page, vehicle, out)
                case LeaveWheel(page):
                    self.by_hand.let_go(t, page)
                case Steer(page, forward, left):
                    self.by_hand.steer(t, page, (forward, left))
                case Rescale(page, key) if key in SCALINGS:
                    self.by_hand.rescale(t, page, key)
                case AimGimbal():
                    self._aim(action, out)
        now = stamp(self._model.sim_time)
        for name, (linear, angular) in self.by_hand.commands(t).items():
            out.drive[name] = DriveCommand(timestamp=now, linear=linear, angular=angular)
        return out

    def _show(self, t: float, action: Shown) -> None:
        """What a page changes of its own view; only one that has joined is heard."""
        session = self._model.sessions.get(action.page)
        match action:
            case Join(page):
                self._model.join(page)
            case _ if session is None:
                pass
            case Leave(page):
                self.by_hand.let_go(t, page)
                del self._model.sessions[page]
            case Select(_, name):
                self._select(t, session, name)
            case Layer(_, name, on) if name in ROOTS:
                (session.layers.add if on else session.layers.discard)(name)
            case ShowCamera(_, name):
                session.camera = name
            case Looking():
                session.looked_at = t

    def _select(self, t: float, session: BrowserSession, name: str) -> None:
        if name in self._model.vehicles:
            if name != self.by_hand.held_by(session.page):
                self.by_hand.let_go(t, session.page)
            session.vehicle = name
            session.to_confirm = None

    def _aim(self, asked: AimGimbal, out: Outbox) -> None:
        vehicle = self._model.vehicles.get(asked.vehicle)
        if vehicle is None or vehicle.member.file.sensors.gimbal is None:
            return
        if np.isfinite((asked.pan, asked.tilt)).all():
            vehicle.aim = GimbalCommand(timestamp=stamp(self._model.sim_time), pan=asked.pan, tilt=asked.tilt, mode=asked.mode)
            out.gimbal[vehicle.name] = vehicle.aim

    def _stop(self, t: float, engaged: bool, out: Outbox) -> None:
        if engaged:
            self.by_hand.leave(t)
        now_ns = round(self._model.sim_time * 1e9)
        stops = self._model.stops
        out.stop.append(self._voice.engage(now_ns, "pressed on the page") if engaged else self._voice.release(now_ns, stops))
        word = "engaged" if engaged else "released"
        self._model.note("", f"STOP ALL {word} on this page", Event.WARNING if engaged else Event.NOTICE, of_operator=True)

    def _go(self, t: float, name: str, point: tuple[float, float] | None, out: Outbox) -> None:
        vehicle = self._model.vehicles.get(name)
        if vehicle is None or point is None:
            return
        request = GoalRequest(position=Vector3(x=point[0], y=point[1]), yaw=float("nan"), source=SOURCE)
        x_min, y_min, x_max, y_max = self._model.site.world.floor
        inside = x_min - REACH <= point[0] <= x_max + REACH and y_min - REACH <= point[1] <= y_max + REACH
        if vehicle.flies:
            self._refuse(t, vehicle, describe(request), "a click sends ground vehicles; this one follows its mission")
        elif not inside:
            self._refuse(t, vehicle, describe(request), "too far from the floor")
        elif why := self._cannot_drive(vehicle):
            self._refuse(t, vehicle, describe(request), why)
        elif self._is_reachable(t, vehicle, request):
            vehicle.goal_asked = point
            self.by_hand.free(t, vehicle.name)
            self._mode_before.pop(vehicle.name, None)
            if vehicle.status is not None and vehicle.status.mode not in OBEYING_PLANNER:
                self._mode_before[vehicle.name] = vehicle.status.mode
                out.mode.setdefault(vehicle.name, []).append(ModeRequest(mode=Mode.MODE_MISSION, source=SOURCE))
            out.goal.setdefault(vehicle.name, []).append(request)

    def _cancel(self, t: float, name: str, out: Outbox) -> None:
        vehicle, request = self._model.vehicles.get(name), CancelRequest(source=SOURCE)
        if vehicle is not None and not vehicle.flies and self._is_reachable(t, vehicle, request):
            out.cancel.setdefault(vehicle.name, []).append(request)

    def _take_wheel(self, t: float, page: int, name: str, out: Outbox) -> None:
        """Like ``uvf teleop``, it asks for mode MANUAL; arming stays a matter of two clicks."""
        vehicle, request = self._model.vehicles.get(name), ModeRequest(mode=Mode.MODE_MANUAL, source=SOURCE)
        session = self._model.sessions.get(page)
        if session is None or session.vehicle != name or vehicle is None or not self.by_hand.can_drive(name):
            return
        self.by_hand.let_go(t, page)
        self.by_hand.free(t, name)
        if why := self._cannot_drive(vehicle):
            self._refuse(t, vehicle, "drive by hand", why)
        elif self._is_reachable(t, vehicle, request):
            out.mode.setdefault(vehicle.name, []).append(request)
            self._mode_before.pop(vehicle.name, None)
            self.by_hand.take(t, page, vehicle.name)

    def _cannot_drive(self, vehicle: VehicleModel) -> str:
        """Why a goal would be accepted and yet nothing would move, and the mend; empty when it would."""
        if self._model.stopped:
            return "STOP ALL is engaged: release it first"
        if vehicle.status is not None and not vehicle.status.armed:
            return f"{vehicle.name} is disarmed: arm it first"
        return ""

    def _arm(self, t: float, asked: Arm, out: Outbox) -> None:
        vehicle, session = self._model.vehicles.get(asked.vehicle), self._model.sessions.get(asked.page)
        if vehicle is None or session is None:
            return
        if not self.waits_for_confirmation(session, vehicle.name, asked.arm, t):
            session.to_confirm = (vehicle.name, asked.arm, t)
            return
        session.to_confirm = None
        request = ArmRequest(arm=asked.arm, source=SOURCE)
        if self._is_reachable(t, vehicle, request):
            out.arm.setdefault(vehicle.name, []).append(request)

    def _set_mode(self, t: float, name: str, mode: str, out: Outbox) -> None:
        vehicle = self._model.vehicles.get(name)
        if vehicle is None:
            return
        value = modes_of(vehicle).get(mode)
        request = ModeRequest(mode=value, source=SOURCE)
        if value is not None and self._is_reachable(t, vehicle, request):
            self.by_hand.free(t, vehicle.name)
            out.mode.setdefault(vehicle.name, []).append(request)

    def _is_reachable(self, t: float, vehicle: VehicleModel, request: Message) -> bool:
        """Notes the order, and refuses it at once when nothing has been heard of the vehicle for long."""
        if vehicle.heard is None or t - vehicle.heard > LOST_AFTER:
            self._refuse(t, vehicle, describe(request), "no link to the vehicle")
            return False
        vehicle.order = Order(describe(request), t)
        return True

    def _refuse(self, t: float, vehicle: VehicleModel, text: str, reason: str) -> None:
        self._settle(t, vehicle, Order(text, t, "refused", reason or "no reason given"))

    def _settle(self, t: float, vehicle: VehicleModel, order: Order) -> None:
        """What became of an order: beside the buttons, in the log, and over the scene for a while."""
        vehicle.order = order
        good = order.state == "accepted"
        outcome = order.state if good else f"{order.state}: {order.reason}"
        line = self._model.note(vehicle.name, f"{order.text}: {outcome}", Event.INFO if good else Event.WARNING, of_operator=True)
        self._model.log.tell(t, line, good)

    def hear(self, t: float, answers: Sequence[Answer[Any, Any]]) -> None:
        """Takes the answers to earlier requests at ``t`` [s, wall]."""
        for answer in answers:
            vehicle = self._model.vehicles.get(answer.vehicle)
            if vehicle is None:
                continue
            accepted = answer.reply is not None and answer.reply.accepted
            reason = answer.reason if answer.reply is None else answer.reply.reason
            if isinstance(answer.request, GoalRequest) and not accepted:
                vehicle.goal_asked = None
                self._undo_mode(vehicle.name)
            if accepted:
                self._settle(t, vehicle, Order(describe(answer.request), t, "accepted"))
            else:
                self._refuse(t, vehicle, describe(answer.request), reason)

    def _undo_mode(self, vehicle: str) -> None:
        """A goal that is refused changes nothing: the mode that was set for it goes back with the next step."""
        if vehicle in self._mode_before:
            self._back[vehicle] = self._mode_before.pop(vehicle)

    def expire(self, t: float) -> None:
        """Shows orders that were not answered by ``t`` [s, wall] as refused."""
        for vehicle in self._model.vehicles.values():
            order = vehicle.order
            if order is not None and order.state == "sent" and t - order.at > ANSWER_WITHIN:
                self._refuse(t, vehicle, order.text, "no answer")
