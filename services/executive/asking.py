"""Requests to vehicles whose answers come in later steps; a refusal may pass, so each is asked again for a while."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from google.protobuf.message import Message

from uvf.runtime.contract.service import Answer

AGAIN = 1.0  # s between two tries
CANCEL = "cancel"
PATIENCE = 15.0  # s: an aircraft has no fix at first, a rover no map


@dataclass(eq=False)
class PendingRequest:
    """One thing that is asked of a vehicle, until it is accepted or has been refused for too long."""

    name: str
    """As the service's outputs call the request."""
    vehicle: str
    message: Message
    patience: float = PATIENCE
    """s, for which refusals are not the last word."""
    reply: Any = None
    """The reply that accepts it, or the last one that does not."""
    reason: str = ""
    """Why it was refused last."""
    accepted: bool = False
    refused: bool = False
    asked_at: float | None = None
    first_asked: float = 0.0
    due: float = 0.0


@dataclass
class PendingRequests:
    """All requests of the executive that have no answer yet."""

    _open: list[PendingRequest] = field(default_factory=list)

    def ask(self, name: str, vehicle: str, message: Message, patience: float = PATIENCE, due: float = 0.0) -> PendingRequest:
        """A new request; it goes out with this step, or at ``due`` [s]."""
        ticket = PendingRequest(name, vehicle, message, patience, due=due)
        self._open.append(ticket)
        return ticket

    def drop(self, ticket: PendingRequest | None) -> None:
        """Asks no more; an answer that still comes is not heeded."""
        if ticket in self._open:
            self._open.remove(ticket)

    def hear(self, t: float, answers: dict[str, Sequence[Answer[Any, Any]]]) -> None:
        """Takes the answers at ``t`` [s], by the name of the request."""
        for name, given in answers.items():
            for answer in given:
                ticket = next((each for each in self._open if each.name == name and each.message is answer.request), None)
                if ticket is not None:
                    self._settle(t, ticket, answer)

    def _settle(self, t: float, ticket: PendingRequest, answer: Answer[Any, Any]) -> None:
        ticket.asked_at, ticket.due, ticket.reply = None, t + AGAIN, answer.reply
        ticket.accepted = answer.reply is not None and answer.reply.accepted
        ticket.reason = "" if ticket.accepted else answer.reason if answer.reply is None else answer.reply.reason
        ticket.refused = not ticket.accepted and t - ticket.first_asked >= ticket.patience
        if ticket.accepted or ticket.refused:
            self._open.remove(ticket)

    def due(self, t: float) -> dict[str, dict[str, list[Message]]]:
        """What is to be sent at ``t`` [s], by request and vehicle."""
        sent: dict[str, dict[str, list[Message]]] = {}
        cancelling = {ticket.vehicle for ticket in self._open if ticket.name == CANCEL}
        for ticket in self._open:
            waits = ticket.vehicle in cancelling and ticket.name != CANCEL  # or the vehicle would cancel what it is asked for next
            if ticket.asked_at is None and t >= ticket.due and not waits:
                ticket.first_asked = ticket.first_asked or t
                ticket.asked_at = t
                again = type(ticket.message)()
                again.CopyFrom(ticket.message)
                ticket.message = again  # so that a late answer to an earlier try is not taken for that of this one
                sent.setdefault(ticket.name, {}).setdefault(ticket.vehicle, []).append(again)
        return sent
