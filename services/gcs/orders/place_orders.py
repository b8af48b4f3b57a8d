"""What is asked for at a place that was clicked: go there, look whither, make it home, measure."""

import numpy as np

from schemas.messages import GoalRequest, HomeCommand, Mode, ModeRequest, PreviewRequest, Vector3, VehicleCommandRequest
from services.gcs.orders.by_hand import ManualDriving
from services.gcs.orders.map_orders import MapOrders
from services.gcs.orders.offers import SOURCE, cannot_move
from services.gcs.orders.orders import OrderBook
from services.gcs.orders.outbox import Outbox
from services.gcs.state.pointing import TOOLS, Pointed
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel

REACH = 50.0  # m, how far outside the floor a goal of a ground vehicle may lie
OBEYING_PLANNER = (Mode.MODE_MISSION, Mode.MODE_RETURN)


class PlaceOrders:
    """Turns clicks on the ground into requests."""

    def __init__(self, model: Model, orders: OrderBook, by_hand: ManualDriving, maps: MapOrders) -> None:
        self._model = model
        self._orders = orders
        self._by_hand = by_hand
        self._maps = maps
        self._back: dict[str, int] = {}
        self._mode_before: dict[str, int] = {}

    def begin(self, out: Outbox) -> None:
        """Puts the modes back that had been set for goals which were refused."""
        for name, before in self._back.items():
            out.call("mode", name, ModeRequest(mode=before, source=SOURCE))  # type: ignore[arg-type]
        self._back.clear()

    def refused(self, vehicle: VehicleModel) -> None:
        """A goal that is refused changes nothing: the mode that was set for it goes back with the next step."""
        vehicle.goal_asked = None
        if vehicle.name in self._mode_before:
            self._back[vehicle.name] = self._mode_before.pop(vehicle.name)

    def forget_mode(self, vehicle: str) -> None:
        """Another mode has been asked for: the one before a goal does not come back."""
        self._mode_before.pop(vehicle, None)

    def click(self, t: float, session: BrowserSession, point: tuple[float, float] | None, out: Outbox) -> None:
        """Opens the menu of the place that was clicked, or is the second click that it waits for."""
        before, vehicle = session.pointed, self._model.vehicles.get(session.vehicle)
        if point is None or vehicle is None:
            session.pointed = None
        elif before is not None and before.tool in ("here", "face"):
            session.pointed = None
            yaw = float(np.arctan2(point[1] - before.y, point[0] - before.x))
            (self._maps.place if before.tool == "here" else self._go)(t, session, before, yaw, out)
        elif before is not None and before.tool == "measure":
            before.to = point
        else:
            session.pointed = Pointed(*point, session.vehicle)
            if not vehicle.flies and self._is_on_floor(point):
                preview = PreviewRequest(position=Vector3(x=point[0], y=point[1]), source=SOURCE)
                out.call("preview", vehicle.name, preview)

    def point(self, t: float, session: BrowserSession, tool: str, out: Outbox) -> None:
        """Does what was chosen from the menu of the place."""
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
        if vehicle is None or self._orders.begin(t, session, vehicle.name, request, why) is None:
            return
        vehicle.goal_asked = (at.x, at.y)
        self._by_hand.free(t, vehicle.name)
        self._mode_before.pop(vehicle.name, None)
        if not vehicle.flies and vehicle.status is not None and vehicle.status.mode not in OBEYING_PLANNER:
            self._mode_before[vehicle.name] = vehicle.status.mode
            out.call("mode", vehicle.name, ModeRequest(mode=Mode.MODE_MISSION, source=SOURCE))
        out.call("goal", vehicle.name, request)

    def _cannot_go(self, vehicle: VehicleModel, point: tuple[float, float]) -> str:
        """Why a goal would be accepted and yet nothing would move, and the mend; empty when it would."""
        if not vehicle.flies and not self._is_on_floor(point):
            return "too far from the floor"
        return cannot_move(self._model, vehicle)

    def _set_home(self, t: float, session: BrowserSession, at: Pointed, out: Outbox) -> None:
        session.pointed = None
        vehicle = self._model.vehicles.get(at.vehicle)
        height = vehicle.status.home.z if vehicle is not None and vehicle.status is not None else 0.0
        request = VehicleCommandRequest(home=HomeCommand(position=Vector3(x=at.x, y=at.y, z=height)), source=SOURCE)
        if self._orders.begin(t, session, at.vehicle, request) is not None:
            out.call("vehicle_command", at.vehicle, request)
