"""Requests that a service has sent, and the answers that have come for its next step."""

from collections import deque
from collections.abc import Callable, Collection
from typing import Any

from google.protobuf.message import Message

from schemas.topics import Request
from uvf.runtime.bus.interface import Bus
from uvf.runtime.bus.wire import Malformed, decode
from uvf.runtime.contract.service import Answer


class OpenCalls:
    """Of one instance."""

    def __init__(self, names: Collection[str], bus: Bus) -> None:
        """names: of the service's calls."""
        self.epoch = 0
        self._bus = bus
        self._answers: dict[str, deque[tuple[int, Answer[Any, Any]]]] = {name: deque() for name in names}

    def send(self, name: str, request: Request[Any, Any], owner: str, message: Message, stamp: int) -> None:
        """Sends a request stamped ``stamp`` [ns]; an answer that comes in another epoch is not heeded."""
        asked_in = self.epoch

        def on_reply(reply: bytes | None, reason: str, at_ns: int) -> None:
            if asked_in != self.epoch:
                return
            try:
                decoded = decode(request.at(owner), reply, request.reply) if reply is not None else None
            except Malformed as error:
                decoded, reason = None, str(error)
            self._answers[name].append((at_ns, Answer(owner, message, decoded, reason)))

        self._bus.call(request.at(owner), message.SerializeToString(deterministic=True), stamp, on_reply)

    def fail(self, name: str, owner: str, message: Message, stamp: int, reason: str) -> None:
        """Lets a request go unanswered, which is known at ``stamp`` [ns]."""
        self._answers[name].append((stamp, Answer(owner, message, None, reason)))

    def take(self, names: Collection[str], is_readable: Callable[[int], bool]) -> dict[str, list[Answer[Any, Any]]]:
        """The answers to the calls of these names whose stamps [ns] are readable; they come once."""
        taken: dict[str, list[Answer[Any, Any]]] = {}
        for name in names:
            waiting = self._answers[name]
            taken[name] = [answer for stamp, answer in waiting if is_readable(stamp)]
            self._answers[name] = deque(each for each in waiting if not is_readable(each[0]))
        return taken

    def clear(self) -> None:
        """Forgets all answers."""
        for answers in self._answers.values():
            answers.clear()
