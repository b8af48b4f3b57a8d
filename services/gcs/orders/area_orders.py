"""Fence, rally points and fields to survey: edited on the page, put into force, made into missions."""

from typing import Any

from google.protobuf.message import Message

from schemas.messages import FenceRequest, RallyRequest
from services.gcs.actions.areas import (
    AreaAdd,
    AreaClear,
    AreaDrop,
    AreaMove,
    AreaSet,
    AreaTake,
    AreaUpload,
    FenceActs,
    OfArea,
    SurveyMake,
    ZoneBegin,
    ZoneChoose,
    ZoneEnd,
)
from services.gcs.orders.offers import SOURCE
from services.gcs.orders.orders import OrderBook
from services.gcs.orders.outbox import Outbox
from services.gcs.state.plans.area_draft import AreaDraft, FenceDraft, SurveyDraft
from services.gcs.state.plans.plan_draft import MOST_ITEMS
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.surveying import FieldSurvey, SurveyPlanner
from uvf.models.mission.fence import ACTIONS
from uvf.runtime.messages.plans.mission_files import item_from_file

CIRCLE = {True: 50.0, False: 1.0}
"""m, radius of a new circle of a vehicle that flies, and of one that does not."""


class AreaOrders:
    """Keeps the areas of a model up to date with what is in force and what is drawn."""

    def __init__(self, model: Model, orders: OrderBook, surveys: SurveyPlanner) -> None:
        self._model = model
        self._orders = orders
        self._surveys = surveys
        self._taken: dict[tuple[str, str], Any] = {}

    def advance(self) -> None:
        """Takes over what has come into force where nobody has drawn anything, and missions that have been made of fields."""
        for v in self._model.vehicles.values():
            for part, there in (("fence", v.fence), ("rally", v.rally)):
                key = (v.name, part)
                draft = v.areas.fence if part == "fence" else v.areas.rally
                if not draft.touched and self._taken.get(key, self) is not there:
                    self._taken[key] = there
                    draft.take(there)  # type: ignore[arg-type]
        for name, items, fault in self._surveys.made():
            vehicle = self._model.vehicles.get(name)
            if vehicle is not None:
                vehicle.areas.survey.making, vehicle.areas.survey.fault = False, fault
                if len(items) > MOST_ITEMS:
                    vehicle.areas.survey.fault = f"{len(items)} items, of {MOST_ITEMS} at most: fly higher, or overlap less"
                elif not fault:
                    vehicle.draft.replace([item_from_file(item) for item in items])
                    self._show_mission(name)

    def _show_mission(self, vehicle: str) -> None:
        for session in self._model.sessions.values():
            if session.vehicle == vehicle and session.plan_part == "survey":
                session.plan_part = "mission"

    def ask(self, t: float, session: BrowserSession, action: OfArea, out: Outbox) -> None:
        """Carries out what a page asks for at ``t`` [s, wall]; all of it is the controlling operator's."""
        vehicle = self._model.vehicles.get(action.vehicle)
        if vehicle is None:
            return
        if isinstance(action, AreaUpload):
            self._upload(t, session, vehicle, action, out)
        elif why := self._orders.reason_against(session, vehicle):
            self._orders.refuse(t, vehicle, "draw an area", why)
        elif vehicle.flies or not _is_for_aircraft(action):
            session.pointed = None
            self._edit(vehicle, action)

    def _upload(self, t: float, session: BrowserSession, v: VehicleModel, action: AreaUpload, out: Outbox) -> None:
        if action.part == "fence":
            request: Message = FenceRequest(fence=v.areas.fence.message(), source=SOURCE)
            name, why, draft = "set_fence", v.areas.fence.fault, v.areas.fence
        else:
            request = RallyRequest(rally=v.areas.rally.message(v.flies), source=SOURCE)
            name, why, draft = "set_rally", "", v.areas.rally  # type: ignore[assignment]
        if self._orders.begin(t, session, v.name, request, why) is not None:
            out.call(name, v.name, request)
            draft.touched = False
            self._taken[v.name, action.part] = v.fence if action.part == "fence" else v.rally

    def refused(self, v: VehicleModel, request: Message) -> None:
        """An upload has been refused: what is drawn is not on the vehicle."""
        if isinstance(request, FenceRequest):
            v.areas.fence.touched = True
        elif isinstance(request, RallyRequest):
            v.areas.rally.touched = True

    def _edit(self, v: VehicleModel, action: OfArea) -> None:
        fence = v.areas.fence
        match action:
            case ZoneBegin(_, _, kind):
                fence.begin(kind.endswith("out"), CIRCLE[v.flies] if kind.startswith("circle") else 0.0)
            case ZoneChoose(_, _, ring) if 0 <= ring < len(fence.rings):
                fence.chosen = ring
            case ZoneEnd(_, _, ring):
                fence.end(ring)
            case FenceActs(_, _, name) if name in ACTIONS:
                fence.action = name
                fence.changed()
            case SurveyMake():
                self._make(v)
            case AreaAdd() | AreaMove() | AreaDrop() | AreaSet() | AreaTake() | AreaClear():
                draft = v.areas.of(action.part)
                if draft is not None:
                    self._edit_part(v, draft, action)

    def _edit_part(self, v: VehicleModel, draft: AreaDraft, action: OfArea) -> None:
        match action:
            case AreaAdd(_, _, _, x, y):
                draft.add(x, y)
            case AreaMove(_, _, _, ring, index, x, y):
                draft.move(ring, index, x, y)
            case AreaDrop(_, _, _, ring, index):
                draft.drop(ring, index)
            case AreaSet(_, _, _, name, value):
                _set(draft, name, value)
            case AreaTake():
                draft.touched = False
                self._taken.pop((v.name, action.part), None)
            case AreaClear():
                draft.clear()

    def _make(self, v: VehicleModel) -> None:
        draft, site = v.areas.survey, self._model.site
        corners = draft.rings[0].corners
        if draft.making:
            return
        if len(corners) < 3:
            draft.fault = "a field has at least three corners"
            return
        draft.making, draft.fault = True, ""
        wind = (v.nav.wind.x, v.nav.wind.y) if v.nav is not None else (0.0, 0.0)
        sizes = draft.height, draft.sidelap, draft.frontlap
        self._surveys.begin(v.name, FieldSurvey(str(v.member.folder), str(site.world_folder), list(corners), *sizes, wind))


def _is_for_aircraft(action: OfArea) -> bool:
    match action:
        case SurveyMake() | FenceActs(action="land"):
            return True
        case _:
            return getattr(action, "part", "") == "survey"


def _set(draft: AreaDraft, name: str, value: float | None) -> None:
    """Only what the draft has, and numbers that make sense of it."""
    match draft, name:
        case FenceDraft(), "floor" | "ceiling":
            setattr(draft, name, value)
        case FenceDraft(), "radius" if value is not None and value > 0 and 0 <= draft.chosen < len(draft.rings):
            draft.rings[draft.chosen].radius = value
        case SurveyDraft(), "sidelap" | "frontlap" if value is not None and 0 <= value <= 0.95:
            setattr(draft, name, value)
        case _, "height" if value is not None and hasattr(draft, "height"):
            setattr(draft, name, value)
        case _:
            return
    draft.changed()
