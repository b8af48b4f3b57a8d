"""What people ask for on the page, checked here before anything is sent: a page can ask for anything at any time."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from google.protobuf.message import Message

from schemas.messages import (
    ClockRequest,
    Event,
    GimbalCommand,
    GoalRequest,
    LaunchRequest,
    MappingRequest,
    MissionRequest,
    Mode,
    ModeRequest,
    PreviewRequest,
    WindRequest,
)
from services.gcs.actions.areas import OfArea
from services.gcs.actions.maps import OfMap
from services.gcs.actions.page import (
    AimGimbal,
    AnswerControl,
    ClickGround,
    Command,
    GimbalMode,
    LaunchMission,
    LeaveWheel,
    PageAction,
    Point,
    ReleaseStop,
    RequestControl,
    Rescale,
    RunClock,
    SetRate,
    SetWind,
    Steer,
    StopAll,
    TakeWheel,
    ground_point,
)
from services.gcs.actions.plans import OfPlan, PlanGoTo, PlanUpload
from services.gcs.actions.times import OfTime
from services.gcs.orders.area_orders import AreaOrders
from services.gcs.orders.browsing import Browsing
from services.gcs.orders.by_hand import ManualDriving
from services.gcs.orders.handover import ControlHandover
from services.gcs.orders.map_orders import MapOrders
from services.gcs.orders.offers import SOURCE, cannot_move, offer_of
from services.gcs.orders.orders import OrderBook
from services.gcs.orders.outbox import Outbox
from services.gcs.orders.place_orders import PlaceOrders
from services.gcs.orders.planning import Planning
from services.gcs.orders.run_orders import RunOrders
from services.gcs.orders.time_travel import TimeTravel
from services.gcs.state.control import called
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.wording import GIMBAL_MODES
from services.gcs.surveying import SurveyPlanner
from uvf.control.teleop_drive import SCALINGS
from uvf.maths.kinematics import Twist
from uvf.runtime.contract.service import Answer
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.wheels import drive_command
from uvf.runtime.state.stop_all import StopVoice

ALSO_IN_THE_PAST = (OfTime, StopAll, AnswerControl, LeaveWheel)
"""What a page that shows the past may ask for."""


class Commander:
    """Turns actions into requests, and follows each until it is answered."""

    def __init__(self, model: Model, time: TimeTravel, surveys: SurveyPlanner) -> None:
        self._model = model
        self.time = time
        self._voice = StopVoice(SOURCE)
        bodies = {v.name: v.member.file.ground for v in model.vehicles.values()}
        self.by_hand = ManualDriving({n: b.max_twist for n, b in bodies.items() if b is not None})
        self._browsing = Browsing(model, self.by_hand)
        self._orders = OrderBook(model)
        self._maps = MapOrders(self._orders)
        self._places = PlaceOrders(model, self._orders, self.by_hand, self._maps)
        self._handover = ControlHandover(model, self.by_hand)
        self._run = RunOrders(self._orders)
        self._planning = Planning(model)
        self._areas = AreaOrders(model, self._orders, surveys)

    def act(self, t: float, actions: Sequence[PageAction]) -> Outbox:
        """The messages to send for the actions asked for at ``t`` [s, wall]."""
        out = Outbox()
        self._places.begin(out)
        for action in actions:
            if not self._browsing.shows(t, action):
                session = self._model.sessions.get(action.page)
                if session is not None:
                    self._heed(t, session, action, out)
        self._handover.hand_over(t)
        now = stamp(self._model.sim_time)
        for name, command in self.by_hand.commands(t).items():
            out.drive[name] = drive_command(command, now)
        return out

    def _heed(self, t: float, session: BrowserSession, action: PageAction, out: Outbox) -> None:
        if session.past is not None and not isinstance(action, ALSO_IN_THE_PAST):
            if isinstance(action, Command):
                self._orders.refuse(t, self._model.vehicles.get(action.vehicle), action.key, "this page shows the past: press LIVE first")
            return
        match action:
            case OfTime():
                self.time.ask(t, session, action)
                if session.past is not None:
                    self.by_hand.let_go(t, session.page)
            case StopAll():
                self._stop(t, session, True, out)
            case ReleaseStop():
                self._stop(t, session, False, out)
            case ClickGround(_, origin, direction):
                self._places.click(t, session, ground_point(origin, direction), out)
            case Point(_, tool):
                self._places.point(t, session, tool, out)
            case Command(_, vehicle, key):
                self._command(t, session, vehicle, key, out)
            case RequestControl() | AnswerControl():
                self._handover.negotiate(t, session, action)
            case TakeWheel(page, vehicle):
                self._take_wheel(t, session, vehicle, out)
            case LeaveWheel(page):
                self.by_hand.let_go(t, page)
            case Steer() | Rescale():
                self._drive(t, session, action)
            case AimGimbal() | GimbalMode():
                self._aim(t, session, action, out)
            case RunClock() | SetRate() | SetWind() | LaunchMission():
                self._run.ask(t, session, action, out)
            case OfMap():
                self._maps.ask(t, session, action, out)
            case OfArea():
                self._areas.ask(t, session, action, out)
            case OfPlan():
                self._plan(t, session, action, out)

    def _command(self, t: float, session: BrowserSession, name: str, key: str, out: Outbox) -> None:
        vehicle = self._model.vehicles.get(name)
        offer = offer_of(self._model, vehicle, key) if vehicle is not None else None
        if vehicle is None or offer is None:
            return
        if offer.risky and not offer.why_not and not self._orders.is_sure(t, session, name, key, offer.request):
            return
        session.to_confirm = None
        if self._orders.begin(t, session, name, offer.request, offer.why_not) is not None:
            if offer.name == "mode":
                self._places.forget_mode(name)
                if key != "manual":
                    self.by_hand.free(t, name)
            out.call(offer.name, name, offer.request)

    def _aim(self, t: float, session: BrowserSession, asked: AimGimbal | GimbalMode, out: Outbox) -> None:
        vehicle = self._model.vehicles.get(asked.vehicle)
        gimbal = vehicle.member.file.sensors.gimbal if vehicle is not None else None
        if vehicle is None or gimbal is None:
            return
        if why := self._orders.reason_against(session, vehicle):
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

    def _plan(self, t: float, session: BrowserSession, action: OfPlan, out: Outbox) -> None:
        """Edits, uploads and item jumps of a mission; all of them are the controlling operator's."""
        vehicle = self._model.vehicles.get(action.vehicle)
        if vehicle is None:
            return
        match action:
            case PlanUpload():
                why = self._planning.fault(vehicle)
                risky = not why and vehicle.status is not None and vehicle.status.armed and vehicle.status.mode == Mode.MODE_MISSION
                request: Message = self._planning.upload(vehicle)
                name = "set_mission"
                if risky and not self._orders.is_sure(t, session, vehicle.name, "upload", request):
                    return
                session.to_confirm = None
            case PlanGoTo(_, _, index):
                request, name, why = self._planning.go_to(index), "current", ""
            case _ if why := self._orders.reason_against(session, vehicle):
                self._orders.refuse(t, vehicle, "edit the mission", why)
                return
            case _:
                session.pointed = None
                self._planning.edit(vehicle, action)
                return
        if self._orders.begin(t, session, vehicle.name, request, why) is not None:
            out.call(name, vehicle.name, request)
            if isinstance(request, MissionRequest):
                self._planning.sent(vehicle)

    def _stop(self, t: float, session: BrowserSession, engaged: bool, out: Outbox) -> None:
        if engaged:
            self.by_hand.leave(t)
        now_ns = round(self._model.sim_time * 1e9)
        stops = self._model.stops
        out.stop.append(self._voice.engage(now_ns, "pressed on the page") if engaged else self._voice.release(now_ns, stops))
        text = f"STOP ALL {'engaged' if engaged else 'released'} on the page by {called(session.operator)}"
        self._model.note("", text, Event.WARNING if engaged else Event.NOTICE, of_operator=True)

    def _drive(self, t: float, session: BrowserSession, action: Steer | Rescale) -> None:
        """Who has lost control of the vehicle meanwhile drives it no longer."""
        vehicle = self._model.vehicles.get(self.by_hand.held_by(session.page))
        if vehicle is not None and self._orders.reason_against(session, vehicle):
            self.by_hand.let_go(t, session.page)
        elif isinstance(action, Steer):
            self.by_hand.steer(t, session.page, Twist(action.forward, action.turn, action.aside))
        elif action.key in SCALINGS:
            self.by_hand.rescale(t, session.page, action.key)

    def _take_wheel(self, t: float, session: BrowserSession, name: str, out: Outbox) -> None:
        """Like ``uvf teleop``, it asks for mode MANUAL; arming stays a matter of two clicks."""
        vehicle, request = self._model.vehicles.get(name), ModeRequest(mode=Mode.MODE_MANUAL, source=SOURCE)
        if session.vehicle != name or vehicle is None or not self.by_hand.can_drive(name):
            return
        if self._orders.begin(t, session, name, request, cannot_move(self._model, vehicle)) is not None:
            out.call("mode", name, request)
            self._places.forget_mode(name)
            self.by_hand.take(t, session.page, name)

    def hear(self, t: float, answers: Sequence[Answer[Any, Any]]) -> None:
        """Takes the answers to earlier requests at ``t`` [s, wall]."""
        for answer in answers:
            vehicle = self._model.vehicles.get(answer.vehicle)
            if isinstance(answer.request, ClockRequest | LaunchRequest | WindRequest):
                self._orders.settle(t, None, answer)
            if vehicle is None:
                continue
            if isinstance(answer.request, PreviewRequest):
                self._browsing.preview(vehicle.name, answer)
                continue
            accepted = self._orders.settle(t, vehicle, answer)
            if isinstance(answer.request, MissionRequest) and not accepted:
                self._planning.refused(vehicle)
            if accepted and isinstance(answer.request, MappingRequest):
                self._maps.settled(vehicle, answer.request)
            if not accepted:
                self._areas.refused(vehicle, answer.request)
            if isinstance(answer.request, GoalRequest) and not accepted:
                self._places.refused(vehicle)

    def advance(self) -> None:
        """Goes on with what is worked out over several steps."""
        self._planning.advance()
        self._areas.advance()

    def expire(self, t: float) -> None:
        """Shows orders that were not answered by ``t`` [s, wall] as refused."""
        self._orders.expire(t)
