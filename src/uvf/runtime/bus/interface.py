"""What a bus does, and the one inside a process: bytes on keys, each with a sequence number and a stamp."""

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from schemas.topics import Qos


class Sample(NamedTuple):
    """One message as it travels. stamp_ns: simulation time [ns] from which (exclusive) steps may read it.

    epoch: of the sender's clock; 0 where there is but one (a bus inside a process) or none.
    """

    key: str
    type_name: str
    payload: bytes
    stamp_ns: int
    seq: int
    boot: int
    epoch: int = 0


@dataclass
class Query:
    """A request that waits for its answer: ``answer`` or ``refuse`` is called once."""

    key: str
    payload: bytes
    stamp_ns: int
    answer: Callable[[bytes, int], None]
    refuse: Callable[[str], None]


Sink = Callable[[Sample], None]
OnReply = Callable[[bytes | None, str, int], None]
"""Called with the reply's bytes, or None and the reason, and the stamp."""


class Publisher(Protocol):
    """Sends messages on one key."""

    def put(self, payload: bytes, stamp_ns: int) -> int:
        """Sends a message stamped ``stamp_ns`` [ns]; returns its sequence number on the key (from 1)."""


class Bus(Protocol):
    """A message layer; sinks are called in ``poll``, never from a foreign thread."""

    def publisher(self, key: str, type_name: str, qos: Qos) -> Publisher:
        """A publisher of messages of one type on ``key``."""
        ...

    def subscribe(self, key: str, qos: Qos, sink: Sink, depth: int = 1) -> None:
        """Subscribes to ``key``, in which ``*`` stands for one chunk. depth: how many unread messages are kept."""

    def serve(self, key: str, sink: Callable[[Query], None]) -> None:
        """Hands requests on ``key`` to ``sink``, which answers or refuses each once."""
        ...

    def call(self, key: str, payload: bytes, stamp_ns: int, on_reply: OnReply) -> None:
        """Sends a request; ``on_reply`` is called once, with the reply or the reason why there is none."""
        ...

    def poll(self) -> bool:
        """Hands over what has arrived; True when there was too much of it for one call and more waits."""


def matches(expression: str, key: str) -> bool:
    """Whether a key matches an expression whose ``*`` stands for one chunk and ``**`` for any number at the end."""
    wanted, have = expression.split("/"), key.split("/")
    if wanted[-1] == "**":
        wanted, have = wanted[:-1], have[: len(wanted) - 1]
    return len(wanted) == len(have) and all(w in ("*", h) for w, h in zip(wanted, have, strict=True))


class LocalBus:
    """A bus within one process: delivers in order, as bytes; latched topics reach late subscribers."""

    def __init__(self) -> None:
        self._sinks: list[tuple[str, Sink]] = []
        self._by_key: dict[str, list[Sink]] = {}
        self._servers: dict[str, Callable[[Query], None]] = {}
        self._seq: defaultdict[str, int] = defaultdict(int)
        self._latched: dict[str, Sample] = {}

    def publisher(self, key: str, type_name: str, qos: Qos) -> "LocalPublisher":
        """A publisher that delivers at once."""
        return LocalPublisher(self, key, type_name, qos)

    def subscribe(self, key: str, qos: Qos, sink: Sink, depth: int = 1) -> None:
        """Subscribes to ``key``, and hands over the latched messages that match it; ``depth`` has no effect."""
        self._sinks.append((key, sink))
        self._by_key.clear()
        for sample in self._latched.values():
            if matches(key, sample.key):
                sink(sample)

    def serve(self, key: str, sink: Callable[[Query], None]) -> None:
        """Hands requests on ``key`` to ``sink`` at once."""
        self._servers[key] = sink

    def call(self, key: str, payload: bytes, stamp_ns: int, on_reply: OnReply) -> None:
        """Hands a request to its server at once; ``on_reply`` gets the reason where there is none."""
        server = next((sink for wanted, sink in self._servers.items() if matches(wanted, key)), None)
        if server is None:
            on_reply(None, f"nobody answers {key}", stamp_ns)
            return
        server(Query(key, payload, stamp_ns, lambda reply, at: on_reply(reply, "", at), lambda why: on_reply(None, why, stamp_ns)))

    def poll(self) -> bool:
        """Does nothing: everything is handed over at once when it is put."""
        return False

    def deliver(self, key: str, type_name: str, qos: Qos, payload: bytes, stamp_ns: int) -> int:
        """Hands a message to all subscribers of its key; returns its sequence number there."""
        self._seq[key] += 1
        sample = Sample(key, type_name, payload, stamp_ns, self._seq[key], 0)
        if qos is Qos.LATCHED:
            self._latched[key] = sample
        for sink in self._sinks_of(key):
            sink(sample)
        return sample.seq

    def _sinks_of(self, key: str) -> list[Sink]:
        if key not in self._by_key:
            self._by_key[key] = [sink for wanted, sink in self._sinks if matches(wanted, key)]
        return self._by_key[key]


@dataclass
class LocalPublisher:
    """Publisher of a ``LocalBus``."""

    bus: LocalBus
    key: str
    type_name: str
    qos: Qos

    def put(self, payload: bytes, stamp_ns: int) -> int:
        """Delivers a message stamped ``stamp_ns`` [ns]; returns its sequence number on the key (from 1)."""
        return self.bus.deliver(self.key, self.type_name, self.qos, payload, stamp_ns)
