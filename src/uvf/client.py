"""Ten-line access for people's own programs: connect, read, command, ask, wait.

import uvf
from schemas import topics
from schemas.messages import DriveCommand

with uvf.connect() as run:
    pose = run.read("burger", topics.POSE)
    run.send("burger", topics.DRIVE.by("client"), DriveCommand(linear=0.2))
"""

import time
from collections import Counter
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Any, TypeVar, cast

from google.protobuf.message import Message

from schemas import topics
from schemas.messages import Clock
from schemas.topics import Request, Topic
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.address import router_from
from uvf.runtime.bus.interface import Publisher, Sample
from uvf.runtime.bus.wire import decode, guarded
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.messages.convert import stamp_ns
from uvf.runtime.state.stop_all import StopBook, StopVoice, told

M = TypeVar("M", bound=Message)
Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)
LOOK = 0.005  # s
TOGETHER = 0.3  # s of simulation time, within which a request reaches all it is asked of


class NoRouter(BadInput, ConnectionError):
    """No system runs at the endpoint."""


def connect(endpoint: str | None = None, timeout: float = 5.0) -> "Client":
    """Joins a running system at ``endpoint``, or UVF_ROUTER.

    Raises NoRouter, a ConnectionError, without a router within ``timeout`` [s], and BadInput for what is no endpoint.
    """
    where = endpoint or router_from()
    try:
        return Client(ZenohBus(where, timeout=timeout))
    except BadInput:
        raise NoRouter(f"no router at {where}: start 'uvf up' first; UVF_ROUTER says where one runs") from None


class Client:
    """A client of the bus for a person's own program; a context manager."""

    def __init__(self, bus: ZenohBus) -> None:
        self._bus = bus
        self._newest: dict[str, Message] = {}
        self.refused: Counter[str] = Counter()
        """Messages by key that were not what the table says."""
        self._count: Counter[str] = Counter()
        self._subscribed: set[str] = set()
        self._publishers: dict[str, Publisher] = {}
        self._watch(topics.CLOCK.at(topics.SYSTEM), topics.CLOCK)
        self._voice, self._stops = StopVoice("client"), StopBook()
        self._stops.follow(bus)

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        # Closing drops what still waits to be sent, as the last word to a vehicle to stand: a round trip to the router flushes them first.
        self._bus.tokens("@node/nobody")
        self._bus.close()

    def _watch(self, key: str, topic: Topic[Any]) -> None:
        if key not in self._subscribed:
            self._subscribed.add(key)
            self._bus.subscribe(key, topic.qos, guarded(topic, self._on_message, lambda _: self.refused.update([key])))

    def _on_message(self, message: Message, sample: Sample) -> None:
        self._newest[sample.key] = message
        self._count[sample.key] += 1

    @property
    def time(self) -> float:
        """Simulation time [s]; 0 before the first tick."""
        return self._clock().t_ns / 1e9

    @property
    def is_paused(self) -> bool:
        """Whether simulation time is paused."""
        return self._clock().state == Clock.PAUSED

    def _clock(self) -> Clock:
        self._bus.poll()
        newest = self._newest.get(topics.CLOCK.at(topics.SYSTEM))
        clock = newest if isinstance(newest, Clock) else Clock()
        # What is sent bears the epoch: what comes of an earlier one is taken for late.
        self._bus.epoch = clock.epoch
        return clock

    def read(self, owner: str, topic: Topic[M], timeout: float = 5.0) -> M:
        """Newest message of a topic; waits for the first one for ``timeout`` [s, wall]. Raises TimeoutError."""
        key = topic.at(owner)
        self._watch(key, topic)
        try:
            self.wait(lambda: key in self._newest, timeout, f"nothing on {key}")
        except TimeoutError as error:
            raise TimeoutError(f"{error}{self._if_unknown(owner)}") from None
        return cast(M, self._newest[key])

    def vehicles(self) -> list[str]:
        """Names of the vehicles whose autopilot is in the running system, sorted."""
        ends = [token.split("/") for token in self._bus.tokens("@ep/**")]
        return sorted({end[1] for end in ends if end[3] == "pub" and end[4].replace("%", "/") == topics.STATUS.at(end[1])})

    def services(self, owner: str) -> list[str]:
        """Names of the services of a vehicle (or of ``sys``) in the running system, sorted. Raises TimeoutError where there are none."""
        found = sorted({token.split("/")[2] for token in self._bus.tokens(f"@node/{owner}/**")})
        if not found:
            raise TimeoutError(f"'{owner}' has no services{self._if_unknown(owner)}")
        return found

    def _if_unknown(self, owner: str) -> str:
        """What there is instead of a vehicle that does not run, else nothing."""
        known = self.vehicles()
        return "" if owner in (topics.SYSTEM, *known) else f": no vehicle '{owner}' is running; {nearest(owner, known)}"

    def heard(self, owner: str, topic: Topic[Any]) -> int:
        """Number of messages of a topic that have come so far."""
        key = topic.at(owner)
        self._watch(key, topic)
        self._bus.poll()
        return self._count[key]

    def wait(self, condition: Callable[[], bool], timeout: float, what: str = "condition not met") -> None:
        """Waits until ``condition()`` holds, for at most ``timeout`` [s, wall]. Raises TimeoutError with ``what``."""
        end = time.monotonic() + timeout
        self._bus.poll()
        while not condition():
            if time.monotonic() > end:
                raise TimeoutError(f"{what} within {timeout:g} s")
            time.sleep(LOOK)
            self._bus.poll()

    def send(self, owner: str, topic: Topic[M], message: M) -> None:
        """Publishes a message, stamped with the simulation time now (in the message too, where it has no stamp of its own)."""
        key, now_ns = topic.at(owner), round(self.time * 1e9)
        if "timestamp" in message.DESCRIPTOR.fields_by_name and not message.HasField("timestamp"):
            message.timestamp.CopyFrom(stamp_ns(now_ns))  # type: ignore[attr-defined]
        if key not in self._publishers:
            self._publishers[key] = self._bus.publisher(key, topic.message.DESCRIPTOR.full_name, topic.qos)
        self._publishers[key].put(message.SerializeToString(deterministic=True), now_ns)

    def stop_all(self, reason: str) -> None:
        """Engages STOP ALL: rovers stand, aircraft hold or stay on the ground, until ``release_stop`` or another operator's release."""
        self.send(topics.SYSTEM, topics.STOP.by("client"), self._voice.engage(round(self.time * 1e9), reason))

    def release_stop(self) -> list[str]:
        """Releases every engagement of STOP ALL that is known here, also those of others; returns who had engaged it."""
        self._bus.poll()
        engagements = self._stops.now.engagements
        self.send(topics.SYSTEM, topics.STOP.by("client"), self._voice.release(round(self.time * 1e9), engagements))
        return [told([one]) for one in engagements]

    def ask(self, owner: str, request: Request[Q, R], message: Q, timeout: float = 5.0) -> R:
        """Sends a request and waits ``timeout`` [s, wall] for its reply.

        Raises TimeoutError, also when nobody answers, and Malformed for what is no reply.
        """
        (reply,) = self.ask_together(owner, [request], message, timeout)
        if reply is None:
            raise TimeoutError(f"nobody answers {request.at(owner)}{self._if_unknown(owner)}")
        return reply

    def ask_together(self, owner: str, requests: Sequence[Request[Q, R]], message: Q, timeout: float = 5.0) -> list[R | None]:
        """Sends a message to several services, who all take it at the same time, and waits ``timeout`` [s, wall] for each reply.

        The reply is None where nobody answers. Raises TimeoutError, and Malformed for what is no reply.
        """
        got: dict[str, tuple[bytes | None, str]] = {}
        payload = message.SerializeToString(deterministic=True)
        ahead = TOGETHER if len(requests) > 1 and not self.is_paused else 0.0
        stamp = round((self.time + ahead) * 1e9)
        for key in (request.at(owner) for request in requests):
            self._bus.call(key, payload, stamp, lambda reply, reason, _, key=key: got.update({key: (reply, reason)}))  # type: ignore[misc]
        for request in requests:
            key = request.at(owner)
            self.wait(lambda key=key: key in got, timeout, f"no answer from {key}")  # type: ignore[misc]
            if got[key][0] is None and not got[key][1].startswith("nobody answers"):
                raise TimeoutError(got[key][1])
        replies = [(request, got[request.at(owner)][0]) for request in requests]
        return [None if reply is None else decode(request.at(owner), reply, request.reply) for request, reply in replies]
