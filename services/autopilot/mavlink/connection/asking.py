"""What was asked of the services and is not answered yet: a share for each peer, so that nobody's flood is another one's refusal."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from google.protobuf.message import Message

from schemas.messages import ArmRequest, Mode, ModeRequest
from uvf.mavlink.endpoint import Peer
from uvf.runtime.contract.service import Answer

ANSWER_WITHIN = 1.9  # s: inside MAVSDK's four tries of 0.5 s and QGroundControl's 3 s
MOST_OF_ONE = 8  # requests of a peer at once that nobody has answered yet
MOST_OWN = 64  # of this end's own, as for parameters that are remembered
MOST = 64  # of all together, beyond which only a peer that has none may ask
MOST_WAITING, MOST_WAITING_OF_ALL = 128, 512  # parameters: a ground station sends a whole file of them within a moment
AT_THE_LIMIT = 256
SAFE = (Mode.MODE_HOLD, Mode.MODE_RETURN)

Done = Callable[[bool, str], None]
"""Called once with (accepted, reason)."""


@dataclass
class Asked:
    """An open request. asker: None for requests of this end itself; until [s, wall]."""

    asker: Peer | None
    call: str
    request: Message
    done: Done
    until: float

    @property
    def is_urgent(self) -> bool:
        """Whether the request makes a vehicle safe (Hold, Return, disarm): it passes whatever else is asked."""
        if isinstance(self.request, ModeRequest):
            return self.request.mode in SAFE
        return isinstance(self.request, ArmRequest) and not self.request.arm

    @property
    def can_wait(self) -> bool:
        """Whether it is a parameter request, which may be queued; other orders could be obsolete when they are carried out."""
        return self.call.endswith("_param")


class Asking:
    """The requests to the services that await an answer, limited for each peer."""

    def __init__(self) -> None:
        self._open: list[Asked] = []
        self._waiting: list[Asked] = []
        self._requests: list[tuple[str, Message]] = []
        """(name of the call, request) to be sent with this step."""

    def __len__(self) -> int:
        return len(self._open) + len(self._waiting)

    def ask(self, t: float, asker: Peer | None, call: str, request: Message, done: Done) -> None:
        """Sends or queues a request at ``t`` [s, wall]; ``done`` hears at once when there are too many."""
        asked = Asked(asker, call, request, done, t + ANSWER_WITHIN)
        if self._may_open(asked) and not (asked.can_wait and self._count(self._waiting, asker)):
            self._send(asked)
        elif asked.can_wait and self._count(self._waiting, asker) < MOST_WAITING and len(self._waiting) < MOST_WAITING_OF_ALL:
            self._waiting.append(asked)
        else:
            done(False, "too much is asked at once")

    def _may_open(self, asked: Asked) -> bool:
        mine = [other for other in self._open if other.asker == asked.asker and other.is_urgent == asked.is_urgent]
        if asked.asker is None:
            return len(mine) < MOST_OWN
        if asked.is_urgent:
            return len(mine) < MOST_OF_ONE
        others = sum(not other.is_urgent and other.asker is not None for other in self._open)
        return len(mine) < MOST_OF_ONE and others < (MOST if mine else AT_THE_LIMIT)

    @staticmethod
    def _count(some: Sequence[Asked], asker: Peer | None) -> int:
        return sum(asked.asker == asker for asked in some)

    def _send(self, asked: Asked) -> None:
        self._open.append(asked)
        self._requests.append((asked.call, asked.request))

    def answered(self, answer: Answer[Any, Any]) -> None:
        """Passes an answer on to whoever asked."""
        asked = next((asked for asked in self._open if asked.request is answer.request), None)
        if asked is None:
            return
        self._open.remove(asked)
        if answer.reply is None:
            asked.done(False, answer.reason or "no answer")
        else:
            asked.done(answer.reply.accepted, answer.reply.reason)

    def settle(self, t: float) -> None:
        """Ends requests not answered by ``t`` [s, wall], and sends those that have waited for their turn."""
        late = [asked for asked in (*self._open, *self._waiting) if t >= asked.until]
        self._open = [asked for asked in self._open if t < asked.until]
        waiting, self._waiting = [asked for asked in self._waiting if t < asked.until], []
        for asked in waiting:
            if self._may_open(asked):
                self._send(asked)
            else:
                self._waiting.append(asked)
        for asked in late:
            asked.done(False, "the autopilot did not answer")

    def take_requests(self) -> list[tuple[str, Message]]:
        """Takes the requests to be sent now: (name of the call, request)."""
        requests, self._requests = self._requests, []
        return requests
