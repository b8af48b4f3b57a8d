"""The missions that are drawn on the page: edited, flown ahead of time, and put into force."""

from schemas.messages import Mission, MissionItem, MissionRequest, SetCurrentRequest, Vector3
from services.gcs.actions.plans import (
    FILE_MOST,
    OfPlan,
    PlanAdd,
    PlanChoose,
    PlanClear,
    PlanLoad,
    PlanMove,
    PlanRemove,
    PlanSet,
    PlanShift,
    PlanTake,
)
from services.gcs.orders.offers import SOURCE
from services.gcs.state.plans.plan_draft import PLACED, PlanDraft
from services.gcs.state.plans.plan_file import read_plan, take_areas
from services.gcs.state.plans.plan_outlook import PlanOutlook, outlook_of
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel
from uvf.guidance.mission_preview import PreviewFlight
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.plans.plan_items import plan_items

FIRST_HEIGHT = 60.0  # m, of a first waypoint where nothing tells a better one
STEPS = 12  # of the flight ahead, with each step of the page: some milliseconds
LOAD_EVERY = 2.0  # s between two plan files, whoever loads them: to read one takes some tenths of a second at most
SOON = 4  # steps of the page after an edit, before which nothing is flown ahead: who drags a waypoint edits ten times a second


class Planning:
    """Keeps the drafts of a model up to date, and flies ahead those that somebody looks at."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._taken: dict[str, Mission | None] = {}
        self._flights: dict[str, PreviewFlight] = {}
        self._waits: dict[str, int] = {}
        self._loaded = -LOAD_EVERY

    def draft(self, v: VehicleModel) -> PlanDraft:
        """The draft of a vehicle; while nobody has touched it, it is what is in force there."""
        if v.draft.touched or v.mission is self._taken.get(v.name):
            return v.draft
        self._taken[v.name] = v.mission
        v.draft.take(v.mission)
        return v.draft

    def edit(self, v: VehicleModel, action: OfPlan) -> None:
        """Carries out an edit."""
        draft = self.draft(v)
        match action:
            case PlanAdd(_, _, kind, x, y):
                draft.add(kind, (x, y, self._height(v)))
            case PlanSet(_, _, index, name, value):
                draft.set(index, name, value)
            case PlanMove(_, _, index, x, y):
                draft.move(index, x, y)
            case PlanRemove(_, _, index):
                draft.remove(index)
            case PlanShift(_, _, index, by):
                draft.shift(index, by)
            case PlanChoose(_, _, index):
                draft.chosen = index if draft.chosen != index else -1
            case PlanTake():
                draft.take(v.mission)
            case PlanLoad(_, _, name, text):
                self._load(v, draft, name, text)
            case PlanClear():
                draft.clear()

    def _load(self, v: VehicleModel, draft: PlanDraft, name: str, text: str) -> None:
        """All of a file or nothing of it."""
        if self._model.wall - self._loaded < LOAD_EVERY:
            v.file_fault = f"file '{name}': another one has just been read: load it again"
            return
        self._loaded = self._model.wall
        try:
            if len(text) > FILE_MOST:
                raise BadInput(f"file '{name}': longer than {FILE_MOST} characters: it is no plan of this page")
            file = read_plan(text, f"file '{name}'")
        except BadInput as error:
            v.file_fault = str(error)
            return
        v.file_fault = ""
        draft.replace(file.items)
        take_areas(file, v.areas.fence, v.areas.rally)

    def _height(self, v: VehicleModel) -> float:
        """m, world, of a new item: as the last one, or as the vehicle."""
        if not v.flies:
            return 0.0
        heights = [item.position.z for item in v.draft.items if item.kind in PLACED]
        here = v.nav.position.z if v.nav is not None and v.nav.position.z > FIRST_HEIGHT / 2 else FIRST_HEIGHT
        return heights[-1] if heights else round(here)

    def upload(self, v: VehicleModel) -> MissionRequest:
        """The request that puts the draft into force."""
        return MissionRequest(mission=Mission(items=[_as_sent(item) for item in self.draft(v).items]), source=SOURCE)

    def sent(self, v: VehicleModel) -> None:
        """The draft is on its way: what is accepted comes back as the mission in force."""
        v.draft.touched = False
        self._taken[v.name] = v.mission

    def refused(self, v: VehicleModel) -> None:
        """The upload has been refused: the draft is not on the vehicle."""
        v.draft.touched = True

    def go_to(self, index: int) -> SetCurrentRequest:
        """The request that goes on with an item."""
        return SetCurrentRequest(index=index, source=SOURCE)

    def advance(self) -> None:
        """Flies the drafts ahead that somebody looks at, some steps further."""
        for name in {session.vehicle for session in self._model.sessions.values() if session.tab == "plan"}:
            vehicle = self._model.vehicles.get(name)
            if vehicle is not None:
                self._advance(vehicle)

    def _advance(self, v: VehicleModel) -> None:
        draft = self.draft(v)
        if v.outlook is None or v.outlook.edits != draft.edits:
            v.outlook = outlook_of(draft, v.flies)
            self._waits[v.name] = SOON
            self._flights.pop(v.name, None)
        if self._waits[v.name] > 0:
            self._waits[v.name] -= 1
        elif not v.outlook.is_checked:
            v.outlook.check(draft, self._params(v))
        else:
            self._fly(v, v.outlook)

    def fault(self, v: VehicleModel) -> str:
        """Why what is drawn cannot be flown; empty if it can, or if nobody looks at it."""
        if v.outlook is not None and not v.outlook.is_checked:
            v.outlook.check(self.draft(v), self._params(v))
        return v.outlook.fault if v.outlook is not None else ""

    def _params(self, v: VehicleModel) -> AirParams:
        """Of an aircraft; the standard ones where its file's make no sense."""
        try:
            return v.member.params("autopilot_air", AirParams)
        except BadInput:
            return AirParams()

    def _fly(self, v: VehicleModel, outlook: PlanOutlook) -> None:
        """Only what could be flown is, and only to its end."""
        if outlook.fault or outlook.is_flown:
            return
        if v.name not in self._flights:
            wind = (v.nav.wind.y, v.nav.wind.x) if v.nav is not None else (0.0, 0.0)
            self._flights[v.name] = PreviewFlight(plan_items(v.draft.items), self._params(v), wind)
        flight = self._flights[v.name]
        outlook.is_flown = flight.advance(STEPS)
        outlook.show(flight.so_far)


def _as_sent(item: MissionItem) -> MissionItem:
    sent = MissionItem()
    sent.CopyFrom(item)
    sent.ClearField("origin")
    if sent.kind in PLACED and not sent.HasField("position"):
        sent.position.CopyFrom(Vector3())
    return sent
