"""What became of the requests that were made to vehicles: sent, accepted, or refused and why."""

from typing import Any

from google.protobuf.message import Message

from schemas.messages import Event
from services.gcs.state.control import called
from services.gcs.state.session import OLD_AFTER, BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import LOST_AFTER, Order, VehicleModel
from services.gcs.state.wording import describe
from uvf.runtime.contract.service import Answer

ANSWER_WITHIN = 5.0  # s


class OrderBook:
    """Writes each order to its vehicle, its outcome into the log, and shows it over the scene for a while."""

    def __init__(self, model: Model) -> None:
        self._model = model

    def open(self, t: float, vehicle: VehicleModel | None, request: Message) -> bool:
        """Notes an order at ``t`` [s, wall]; refuses it at once when nothing has been heard of the vehicle for long.

        vehicle: None for the system, here and below.
        """
        if vehicle is None:
            self._model.order = Order(describe(request), t)
            return True
        if vehicle.heard is None or t - vehicle.heard > LOST_AFTER:
            self.refuse(t, vehicle, describe(request), "no link to the vehicle")
            return False
        vehicle.order = Order(describe(request), t)
        return True

    def reason_against(self, session: BrowserSession, v: VehicleModel) -> str:
        """Why this page may not command the vehicle: another operator controls it."""
        return self._model.control.reason_against(v.name, session.operator, self._model.present)

    def _takes_control(self, session: BrowserSession, v: VehicleModel) -> None:
        if self._model.control.take(v.name, session.operator):
            self._model.note(v.name, f"{called(session.operator)} controls it", Event.NOTICE, of_operator=True)

    def begin(self, t: float, session: BrowserSession, name: str, request: Message, why_not: str = "") -> VehicleModel | None:
        """The vehicle, if the request may be sent to it from this page; else it is refused at once, with the reason."""
        vehicle = self._model.vehicles.get(name)
        if vehicle is None:
            return None
        why = self.reason_against(session, vehicle) or why_not
        if why:
            self.refuse(t, vehicle, describe(request), why)
            return None
        if not self.open(t, vehicle, request):
            return None
        self._takes_control(session, vehicle)
        return vehicle

    def is_sure(self, t: float, session: BrowserSession, name: str, key: str, request: Message) -> bool:
        """Whether this click at ``t`` [s, wall] is the second one for what cannot be undone; a page that shows what is old is refused.

        name: of the vehicle, "" for the system.
        """
        if session.behind(t) > OLD_AFTER:
            why = f"this page shows what is {session.behind(t):.0f} s old: wait until it is live"
            self.refuse(t, self._model.vehicles.get(name), describe(request), why)
            return False
        return session.confirm(name, key, t)

    def refuse(self, t: float, vehicle: VehicleModel | None, text: str, reason: str) -> None:
        """Ends an order at ``t`` [s, wall] that is not carried out."""
        self._end(t, vehicle, Order(text, t, "refused", reason or "no reason given"))

    def settle(self, t: float, vehicle: VehicleModel | None, answer: Answer[Any, Any]) -> bool:
        """Takes a vehicle's answer at ``t`` [s, wall]; returns whether it has accepted."""
        accepted = answer.reply is not None and answer.reply.accepted
        if accepted:
            self._end(t, vehicle, Order(describe(answer.request), t, "accepted"))
        else:
            self.refuse(t, vehicle, describe(answer.request), answer.reason if answer.reply is None else answer.reply.reason)
        return accepted

    def _end(self, t: float, vehicle: VehicleModel | None, order: Order) -> None:
        (self._model if vehicle is None else vehicle).order = order
        good = order.state == "accepted"
        outcome = order.state if good else f"{order.state}: {order.reason}"
        who, severity = vehicle.name if vehicle is not None else "", Event.INFO if good else Event.WARNING
        line = self._model.note(who, f"{order.text}: {outcome}", severity, of_operator=True)
        self._model.log.tell(t, line, good)

    def expire(self, t: float) -> None:
        """Shows orders that were not answered by ``t`` [s, wall] as refused."""
        waiting: list[tuple[VehicleModel | None, Order | None]] = [(None, self._model.order)]
        waiting += [(vehicle, vehicle.order) for vehicle in self._model.vehicles.values()]
        for vehicle, order in waiting:
            if order is not None and order.state == "sent" and t - order.at > ANSWER_WITHIN:
                self.refuse(t, vehicle, order.text, "no answer")
