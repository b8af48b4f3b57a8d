"""What a page changes of its own view only: vehicle, tab, camera, layers; and what it says of itself."""

from dataclasses import replace
from typing import Any

from schemas.messages import PreviewReply
from services.gcs.actions.areas import PlanPart
from services.gcs.actions.page import (
    Beat,
    ChooseView,
    Dress,
    FilterTopics,
    FleetTable,
    Hello,
    Join,
    Layer,
    Leave,
    Looking,
    OpenTab,
    PageAction,
    ScopeTopics,
    Select,
    Shape,
    ShowCamera,
    ShowService,
    ShowTopic,
)
from services.gcs.actions.plots import OfPlot
from services.gcs.orders.by_hand import ManualDriving
from services.gcs.orders.plotting import plot
from services.gcs.state.graph.graph_choice import GraphChoice
from services.gcs.state.plans.area_draft import PARTS
from services.gcs.state.session import ROOTS, VIEWS, BrowserSession
from services.gcs.state.state import Model
from uvf.runtime.contract.service import Answer


class Browsing:
    """Keeps what each browser has chosen; only one that has joined is heard."""

    def __init__(self, model: Model, by_hand: ManualDriving) -> None:
        self._model = model
        self._by_hand = by_hand

    def shows(self, t: float, action: PageAction) -> bool:
        """Carries out an action at ``t`` [s, wall] that changes only what is seen; returns whether it is one."""
        session = self._model.sessions.get(action.page)
        match action:
            case Join(page):
                self._model.join(page)
            case Leave(page) if session is not None:
                self._by_hand.let_go(t, page)
                del self._model.sessions[page]
            case Hello(_, operator, vehicle) if session is not None:
                session.operator = operator
                session.seen = t
                self._select(t, session, vehicle)
            case Select(_, name) if session is not None:
                self._select(t, session, name)
            case _:
                return session is None or self._sets(t, session, action)
        return True

    def _sets(self, t: float, session: BrowserSession, action: PageAction) -> bool:
        match action:
            case OfPlot():
                plot(self._model, session, action)
            case Beat(_, beat):
                session.seen = max(session.seen, min(_number(beat), t))
            case FleetTable(_, on):
                session.table = on
            case OpenTab(_, tab):
                session.tab = tab
            case Dress(_, theme):
                session.theme = theme
            case Shape(_, aspect, touched):
                session.aspect, session.touched = aspect, touched
            case PlanPart(_, label):
                session.plan_part = next((part for part, one in PARTS.items() if one == label), session.plan_part)
                session.pointed = None
            case ChooseView(_, view) if view in VIEWS:
                session.view, session.touched = view, False
                session.views_chosen += 1
            case Layer(_, name, on) if name in ROOTS:
                (session.layers.add if on else session.layers.discard)(name)
            case ShowCamera(_, name):
                session.camera = name
            case Looking():
                session.looked_at = t
            case ChooseView() | Layer():
                pass
            case FilterTopics() | ScopeTopics() | ShowService() | ShowTopic():
                session.graph = _chosen(session.graph, action)
            case _:
                return False
        return True

    def _select(self, t: float, session: BrowserSession, name: str) -> None:
        if name in self._model.vehicles:
            if name != self._by_hand.held_by(session.page):
                self._by_hand.let_go(t, session.page)
            if name != session.vehicle:
                session.pointed = None
                if session.plan_part == "survey" and not self._model.vehicles[name].flies:
                    session.plan_part = "mission"
            session.vehicle = name
            session.to_confirm = None

    def preview(self, vehicle: str, answer: Answer[Any, Any]) -> None:
        """Shows the way that a planner has found to those who have clicked that place."""
        at = answer.request.position
        reply = answer.reply if answer.reply is not None else PreviewReply(accepted=False, reason=answer.reason)
        for session in self._model.sessions.values():
            pointed = session.pointed
            if pointed is not None and pointed.vehicle == vehicle and (pointed.x, pointed.y) == (at.x, at.y):
                pointed.preview = reply


def _chosen(before: GraphChoice, action: PageAction) -> GraphChoice:
    """What is chosen in the tab Graph after the action; what is pressed again is no longer chosen."""
    match action:
        case FilterTopics(_, text):
            return replace(before, text=text.strip())
        case ScopeTopics(_, scope):
            return replace(before, scope=scope)
        case ShowService(_, node, to):
            return replace(before, node="", to="") if (node, to) == (before.node, before.to) else replace(before, node=node, to=to)
        case ShowTopic(_, key):
            return replace(before, topic="" if key == before.topic else key)
    return before


def _number(beat: str) -> float:
    try:
        return float(beat)
    except ValueError:
        return float("-inf")
