"""One vehicle's end of the link: what goes out, and for whom it is done."""

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

from google.protobuf.message import Message

from services.autopilot.mavlink.connection.asking import ANSWER_WITHIN, Asking, Done
from services.autopilot.mavlink.connection.facts import VehicleInfo, VehicleState
from services.autopilot.mavlink.connection.refusals import plain
from services.autopilot.mavlink.connection.statustext import TextBudget, TextLimiter, chunks, counted_from_one
from services.autopilot.mavlink.connection.vibration import Vibration
from uvf.mavlink import dialect as mav
from uvf.mavlink.endpoint import Peer
from uvf.runtime.contract.service import Answer

HELD_FOR = 1.0  # s, wall: as long a station that steers may be silent before another one may


class Sender(NamedTuple):
    """Who sent a message: the peer's address, and the system and component that answers go to."""

    peer: Peer
    system: int
    component: int


class SpokenText(NamedTuple):
    """A status text before it is split into STATUSTEXT messages."""

    severity: int
    text: str


class Out(NamedTuple):
    """An outgoing message or text and its receiver."""

    what: mav.MAVLink_message | SpokenText
    to: Peer | None
    """None = every peer."""


@dataclass
class Awaited:
    """A condition that is waited for until ``until`` [s, wall]."""

    condition: Callable[[], bool]
    done: Done
    until: float


class Holder:
    """Admits only one station to steer: the first one, until it has been silent for a while."""

    def __init__(self, line: "VehicleConnection", otherwise: str) -> None:
        """otherwise: what another one is told."""
        self._line, self._otherwise = line, otherwise
        self._holder: Sender | None = None
        self._heard = -math.inf

    def admits(self, sender: Sender) -> bool:
        """Whether this sender may steer now; another one is told who does."""
        holder, free = self._holder, self._line.t - self._heard > HELD_FOR
        if holder is not None and not free and sender != holder:
            self._line.text(mav.MAV_SEVERITY_WARNING, f"{self._otherwise}: {named(holder, sender)} steers", sender.peer)
            return False
        self._holder, self._heard = sender, self._line.t
        return True


def named(station: Sender, to: Sender) -> str:
    """A station in words for another one, which may have the same system id."""
    if station.system != to.system:
        return f"station {station.system}"
    return f"another station {station.system} (at {station.peer[0]}:{station.peer[1]})"


class VehicleConnection:
    """The state shared by the protocols of one vehicle; ``t`` [s, wall] is set before each step's work."""

    def __init__(self, facts: VehicleInfo) -> None:
        self.facts = facts
        imu = facts.sensors.imu
        self.latest = VehicleState(vibration=Vibration(imu.accel_range if imu is not None else math.inf))
        self.t = 0.0
        self.alone: Collection[Peer] = ()
        """Who hears this vehicle and no other."""
        self.files: Mapping[str, bytes] = {}
        """What can be read over MAVLink FTP, by path."""
        self.outbox: list[Out] = []
        self.commands: dict[str, Message] = {}
        """Output -> the newest command of sticks or setpoints, until the service takes it."""
        self._speaker: Peer | None = None
        """Whose message, or whose request's answer, is being dealt with; None for what this end does by itself."""
        self._asking = Asking()
        self._awaited: list[Awaited] = []
        self._limiter = TextLimiter()
        self._budget = TextBudget()

    def send(self, message: mav.MAVLink_message, to: Peer | None = None) -> None:
        """Queues a message for one peer, or for all."""
        self.outbox.append(Out(message, to))

    def tells(self, number: int, peer: Peer) -> bool:
        """Whether a peer gets messages of this id: ADSB_VEHICLE goes only to those who do not hear the other vehicles themselves."""
        return number != mav.MAVLINK_MSG_ID_ADSB_VEHICLE or peer in self.alone

    def text(self, severity: int, text: str, to: Peer | None = None) -> None:
        """Queues a STATUSTEXT; the same text to the same peers at most every 10 s. Item numbers count from 1, as on a station's map."""
        text = counted_from_one(text)
        if self._limiter.admits(self.t, (text, to)):
            self.outbox.append(Out(SpokenText(severity, text), to))

    @contextmanager
    def hearing(self, speaker: Peer | None) -> Iterator[None]:
        """Context in which requests and texts are made on behalf of a peer."""
        before, self._speaker = self._speaker, speaker
        try:
            yield
        finally:
            self._speaker = before

    def _for_speaker(self, done: Done) -> Done:
        """What follows from an answer is still done for who has asked."""
        speaker = self._speaker

        def told(accepted: bool, reason: str) -> None:
            """In words for people: the border's are for who writes services."""
            with self.hearing(speaker):
                done(accepted, plain(reason))

        return told

    def refusal(self, what: str) -> Done:
        """A callback for ``ask`` where the protocol has no answer of its own: a refusal is sent as text to whoever has asked."""
        to = self._speaker

        def done(accepted: bool, reason: str) -> None:
            if not accepted:
                self.text(mav.MAV_SEVERITY_WARNING, f"{what} refused: {reason or 'no reason given'}", to)

        return done

    def ask(self, call: str, request: Message, done: Done) -> None:
        """Sends a request to a service; ``done`` hears the answer, or why there is none: at once while the simulation is paused."""
        if self.latest.is_paused:
            done(False, "the simulation is paused")
            return
        self._asking.ask(self.t, self._speaker, call, request, self._for_speaker(done))

    def answered(self, answer: Answer[Any, Any]) -> None:
        """Passes an answer on to whoever asked."""
        self._asking.answered(answer)

    def when(self, condition: Callable[[], bool], done: Done) -> None:
        """Calls ``done`` once a condition has come true, or when it has not in time."""
        self._awaited.append(Awaited(condition, self._for_speaker(done), self.t + ANSWER_WITHIN))

    def settle(self) -> None:
        """Resolves conditions that have come true, and ends what was not answered in time."""
        waiting, self._awaited = self._awaited, []
        for awaited in waiting:
            if awaited.condition():
                awaited.done(True, "")
            elif self.t >= awaited.until:
                awaited.done(False, "the autopilot did not follow")
            else:
                self._awaited.append(awaited)
        self._asking.settle(self.t)

    def take_out(self, peers: Sequence[Peer]) -> list[tuple[mav.MAVLink_message, list[Peer]]]:
        """Takes the outgoing messages with their receivers; ``peers`` get what is meant for all."""
        out, self.outbox = self.outbox, []
        found: list[tuple[mav.MAVLink_message, list[Peer]]] = []
        for what, to in out:
            receivers = list(peers) if to is None else [to]
            if isinstance(what, SpokenText):
                found += self._chunks(what, self._budget.admitted(self.t, what.severity, receivers))
            else:
                found.append((what, receivers))
        for peer, count in self._budget.left_out(self.t):
            found += self._chunks(SpokenText(mav.MAV_SEVERITY_WARNING, f"{count} texts left out"), [peer])
        return found

    def _chunks(self, said: SpokenText, receivers: list[Peer]) -> list[tuple[mav.MAVLink_message, list[Peer]]]:
        return [(chunk, receivers) for chunk in chunks(said.severity, said.text, self._limiter.next_id())] if receivers else []

    def take_requests(self) -> list[tuple[str, Message]]:
        """Takes the requests to be sent to services: (name of the call, request)."""
        return self._asking.take_requests()
