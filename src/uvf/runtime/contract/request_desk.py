"""The requests that one service instance serves: queued, decoded, handed to a step, answered or refused."""

from collections import deque
from collections.abc import Callable, Mapping
from typing import Any

from google.protobuf.message import Message

from schemas.limits import TEXT
from schemas.topics import Qos, Request
from uvf.runtime.bus.interface import Query
from uvf.runtime.bus.wire import Malformed, decode
from uvf.runtime.contract.service import Later, Service

QUERIES_MOST = 256


class ContractError(Exception):
    """A service returned something that it did not declare."""


Put = Callable[[str, type[Message], Qos, bytes, int], None]


class RequestDesk:
    """Queues, decodes and answers the requests of one service instance.

    put: sends both halves of what was answered as messages of their own, so that logs hold them.
    """

    def __init__(self, service: type[Service], put: Put, malformed: Callable[[str], None]) -> None:
        self._type = service
        self._put = put
        self._malformed = malformed
        self._queries: dict[str, deque[Query]] = {name: deque() for name in service.requests}
        self._in_hand: dict[str, list[Query]] = {}
        """Those that the step under way is to answer."""
        self._open: list[tuple[Query, Request[Any, Any], Later[Any]]] = []
        """Requests that a later step answers."""

    def queue(self, name: str, query: Query) -> None:
        """Adds a request to those of this name; refuses it when too many wait."""
        if len(self._queries[name]) >= QUERIES_MOST:
            query.refuse(f"{self._type.name}: {QUERIES_MOST} requests wait already")
        else:
            self._queries[name].append(query)

    def waiting(self, name: str) -> int:
        """Number of requests of this name that wait."""
        return len(self._queries[name])

    def refuse_all(self, reason: str) -> None:
        """Refuses all requests, also those in hand and those that a later step was to answer."""
        for waiting in self._queries.values():
            while waiting:
                waiting.popleft().refuse(reason)
        for queries in self._in_hand.values():
            for query in queries:
                query.refuse(reason)
        self._in_hand = {}
        for query, _, _ in self._open:
            query.refuse(reason)
        self._open.clear()

    def take(self, is_due: Callable[[int], bool]) -> dict[str, Any]:
        """Requests that are due now, decoded, as ``step`` sees them by name."""
        requests: dict[str, Any] = {}
        self._in_hand = {}
        for name, request in self._type.requests.items():
            by_owner = self._type.scope == "world" and request.per_vehicle
            if not self._queries[name]:
                requests[name] = {} if by_owner else []
                continue
            good = self._decodable(name, request, is_due)
            if by_owner:
                good.sort(key=lambda pair: pair[0].key.split("/")[1])
                by_vehicle: dict[str, list[Message]] = {}
                for query, message in good:
                    by_vehicle.setdefault(query.key.split("/")[1], []).append(message)
                requests[name] = by_vehicle
            else:
                requests[name] = [message for _, message in good]
            self._in_hand[name] = [query for query, _ in good]
        return requests

    def _decodable(self, name: str, request: Request[Any, Any], is_due: Callable[[int], bool]) -> list[tuple[Query, Message]]:
        due = [query for query in self._queries[name] if is_due(query.stamp_ns)]
        self._queries[name] = deque(query for query in self._queries[name] if not is_due(query.stamp_ns))
        good = []
        for query in due:
            try:
                good.append((query, decode(query.key, query.payload, request.message)))
            except Malformed as error:
                self._malformed(str(error))
                reply = request.reply(accepted=False, reason=str(error))
                query.answer(_bytes_of(reply), query.stamp_ns)
        return good

    def reply(self, outputs: Mapping[str, Any], t_ns: int) -> None:
        """Answers the requests in hand with a step's replies, and what has waited for this step. Raises ContractError."""
        for name, request in self._type.requests.items():
            self._reply(name, request, self._in_hand.pop(name, []), outputs.get(name, ()), t_ns)
        still = []
        for query, request, later in self._open:
            if later.reply is None:
                still.append((query, request, later))
            else:
                self.answer(query, request, later.reply, t_ns)
        self._open = still

    def _reply(self, name: str, request: Request[Any, Any], queries: list[Query], replies: Any, t_ns: int) -> None:
        if not queries and not replies:
            return
        flat = [r for owner in sorted(replies) for r in replies[owner]] if isinstance(replies, Mapping) else list(replies)
        if len(flat) != len(queries):
            for query in queries:
                query.refuse(f"{self._type.name} gave no answer to it")
            raise ContractError(f"{self._type.name}: {len(queries)} requests '{name}' but {len(flat)} replies")
        for query, reply in zip(queries, flat, strict=True):
            if isinstance(reply, Later):
                self._open.append((query, request, reply))
            else:
                self.answer(query, request, reply, t_ns)

    def refuse_due(self, reason: str, is_due: Callable[[int], bool], t_ns: int) -> None:
        """Refuses the requests that are due now."""
        for name, request in self._type.requests.items():
            for query, _ in self._decodable(name, request, is_due):
                self.answer(query, request, request.reply(accepted=False, reason=reason), t_ns)

    def answer(self, query: Query, request: Request[Any, Any], reply: Message, t_ns: int) -> None:
        """Answers one request, and publishes it and its reply for logs, stamped ``t_ns`` [ns]."""
        payload = _bytes_of(reply)
        query.answer(payload, t_ns)
        self._put(f"{query.key}/request", request.message, Qos.EVENT, query.payload, t_ns)
        self._put(f"{query.key}/reply", request.reply, Qos.EVENT, payload, t_ns)


def _bytes_of(reply: Any) -> bytes:
    """With a reason that is short enough to be taken: of one that is too long nothing would arrive."""
    if len(reply.reason) > TEXT:
        whole, reply = reply, type(reply)()
        reply.CopyFrom(whole)
        reply.reason = f"{whole.reason[: TEXT - 1]}…"
    payload: bytes = reply.SerializeToString(deterministic=True)
    return payload
