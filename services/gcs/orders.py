"""What became of the requests that were made to vehicles: sent, accepted, or refused and why."""

from typing import Any

from google.protobuf.message import Message

from schemas.messages import Event
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
