"""The bus between processes: Zenoh sessions, publishers and ring channels. The only file that imports zenoh.

Subscribers are ring channels emptied by ``poll``: a slow service loses its own oldest messages and delays nobody.
"""

import json
import secrets
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from types import TracebackType
from typing import Any

import zenoh
from zenoh import ext

from schemas.topics import PREFIX, TOPICS, Qos
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.address import DEFAULT_ROUTER
from uvf.runtime.bus.backlog import Backlog
from uvf.runtime.bus.envelope import Envelope, GapCounter, unpack
from uvf.runtime.bus.interface import OnReply, Query, Sample, Sink, matches

CALL_TIMEOUT = 5.0  # s, wall
LATE = "Timeout"  # what Zenoh says then, without naming who or what
LEASE_MS = 2000
WAIT_BEFORE_DROP_US = 50_000
BATCHES = 16
"""Messages of a priority that may wait for the network's thread (zenoh: 2; 16 at most): those sent at once take a batch each, and a
step that publishes more of them waited for that thread, a third of slam's time with ten vehicles on two cores."""
RECALL_TIMEOUT = 1.0  # s, wall
SAY_AGAIN = 2.0  # s, wall
EVENT_HISTORY = 100
OVERHEAD = 500  # bytes that a message takes beside its payload, while it waits
QUERIES = 256  # that may wait at a server
AT_ONCE = 2000
"""Messages of one subscription that ``poll`` hands over before it comes to the next: a flood keeps nobody from the rest of his work."""
SENDERS_MOST = 20_000
"""Of latched and event messages that a subscriber to everything knows apart; those silent for longest are forgotten."""

_P, _C = zenoh.Priority, zenoh.CongestionControl
_PRIORITY = {
    Qos.CONTROL: (_P.REAL_TIME, True),
    Qos.LOCKSTEP: (_P.REAL_TIME, True),
    Qos.STATE: (_P.INTERACTIVE_HIGH, True),
    Qos.SENSOR: (_P.DATA_HIGH, False),
    Qos.BULK: (_P.DATA_LOW, False),
    Qos.LATCHED: (_P.DATA, False),
    Qos.EVENT: (_P.DATA, False),
}
_KEPT = {Qos.LATCHED: 1, Qos.EVENT: EVENT_HISTORY}


def _config(mode: str, **settings: Any) -> zenoh.Config:
    config = zenoh.Config()
    config.insert_json5("mode", json.dumps(mode))
    config.insert_json5("scouting/multicast/enabled", "false")
    config.insert_json5("transport/link/tx/lease", str(LEASE_MS))
    config.insert_json5("transport/link/tx/queue/congestion_control/drop/wait_before_drop", str(WAIT_BEFORE_DROP_US))
    for priority in ("real_time", "interactive_high", "data_high"):
        config.insert_json5(f"transport/link/tx/queue/size/{priority}", str(BATCHES))
    for key, value in settings.items():
        config.insert_json5(key.replace("__", "/"), json.dumps(value))
    return config


def open_router(listen: str) -> zenoh.Session:
    """A router session on an endpoint such as ``tcp/127.0.0.1:7447``. Raises BadInput when the port is taken."""
    adminspace = {"enabled": True, "permissions": {"read": True, "write": False}}
    try:
        return zenoh.open(_config("router", listen__endpoints=[listen], adminspace=adminspace))
    except zenoh.ZError as error:
        raise BadInput(
            f"router: cannot listen on {listen}: {_first_line(error)}; another 'uvf up' may be running, or choose UVF_ROUTER"
        ) from error


def _first_line(error: Exception) -> str:
    return str(error).splitlines()[0].partition(" at /")[0]


def kept_key(key: str) -> str:
    """Key on which the state store answers for a key; the ``@`` keeps it out of wildcards."""
    return f"{PREFIX}/@kept/{key.removeprefix(f'{PREFIX}/')}"


class ZenohBus:
    """One client session; use it as a context manager, for a session left open hangs the interpreter at exit."""

    def __init__(self, endpoint: str = DEFAULT_ROUTER, blocking: bool = False, timeout: float = -1) -> None:
        """blocking: lockstep and replay, where nothing may be dropped. timeout [s]: -1 waits for the router for ever."""
        retry = {"period_init_ms": 100, "period_max_ms": 1000}
        timeout_ms = -1 if timeout < 0 else round(timeout * 1000)
        try:
            config = _config("client", connect__endpoints=[endpoint], connect__timeout_ms=timeout_ms, connect__retry=retry)
            self._session = zenoh.open(config)
        except zenoh.ZError as error:
            raise BadInput(f"no router at {endpoint}: {_first_line(error)}; start one with 'uvf up' or 'uvf router'") from error
        self.boot = secrets.randbits(63)
        self.epoch = 0
        """Of the clock that this process follows; marks what it sends."""
        self.counter = GapCounter()
        self._blocking = blocking
        # Released by whoever wakes ``wait``. A SimpleQueue would do, but for CPython 3.11: a signal at the end of its
        # timeout makes it wait for ever.
        self._woken = threading.Lock()
        self._woken.acquire()
        self._waking: list[_Inbound] = []
        self._inbound: list[_Inbound] = []
        self._shared: dict[tuple[str, int], _Inbound] = {}  # by key and depth, of those without a history
        self._servers: list[tuple[Any, Callable[[Query], None]]] = []
        self._calls: list[tuple[Any, OnReply, int, str]] = []
        self._declared: list[Any] = []
        self._latched: list[ZenohPublisher] = []

    def __enter__(self) -> "ZenohBus":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Closes the session."""
        self._session.close()  # type: ignore[no-untyped-call]

    def publisher(self, key: str, type_name: str, qos: Qos) -> "ZenohPublisher":
        """A publisher with Zenoh's settings for the class of service; latched and event topics keep a history."""
        priority, express = _PRIORITY[qos]
        how: dict[str, Any] = {
            "encoding": f"application/protobuf;{type_name}",
            "congestion_control": _C.BLOCK if self._blocking else _C.DROP,
            "priority": priority,
            "express": express,
        }
        if qos in _KEPT:
            # Without sample-miss detection a wildcard subscriber loses part of the history.
            detection = ext.MissDetectionConfig(heartbeat=1.0)  # type: ignore[call-arg]
            cache = ext.CacheConfig(max_samples=_KEPT[qos])
            publisher: Any = ext.declare_advanced_publisher(
                self._session, key, cache=cache, sample_miss_detection=detection, publisher_detection=True, **how
            )
        else:
            publisher = self._session.declare_publisher(key, **how)
        self._declared.append(publisher)
        made = ZenohPublisher(publisher, self)
        if qos is Qos.LATCHED:
            self._latched.append(made)
        return made

    def subscribe(self, key: str, qos: Qos, sink: Sink, depth: int = 1, wake: bool = False) -> None:
        """Subscribes to ``key``. wake: ``wait`` returns when something arrives here; costs the interpreter's lock for each message."""
        plain = not wake and qos not in _KEPT
        if plain and (shared := self._shared.get((key, depth))) is not None:
            shared.sinks.append(sink)  # all instances of a process hear of their team: each message is received once for all
            return
        handler: Any = self._handed_over(key, sink, depth) if wake else zenoh.handlers.RingChannel(depth)
        if qos in _KEPT:
            history = ext.HistoryConfig(max_samples=_KEPT[qos], detect_late_publishers=True)
            recovery = ext.RecoveryConfig(heartbeat=True)  # type: ignore[call-arg]
            made: Any = ext.declare_advanced_subscriber(self._session, key, handler, history=history, recovery=recovery)
        else:
            made = self._session.declare_subscriber(key, handler)
        if wake:
            self._declared.append(made)
        else:
            inbound = _Inbound(key, lambda: None if (sample := made.try_recv()) is None else _arrived(sample), [sink])
            self._inbound.append(inbound)
            if plain:
                self._shared[key, depth] = inbound

    def _handed_over(self, key: str, sink: Sink, depth: int) -> Callable[[zenoh.Sample], None]:
        """Hands a message over to ``poll`` from zenoh's own thread and wakes the loop; does nothing else there.

        An indirect callback (the default) proved faster than a direct one, which makes the network's thread wait for the lock.
        """
        backlog: Backlog[zenoh.Sample] = Backlog(depth, _size)
        self._waking.append(_Inbound(key, lambda: None if (sample := backlog.take()) is None else _arrived(sample), [sink]))

        def hand_over(sample: zenoh.Sample) -> None:
            backlog.push(sample)
            try:  # noqa: SIM105  # a context manager would cost 1 us a message
                self._woken.release()
            except RuntimeError:
                pass  # it is awake already

        return hand_over

    def subscribe_all(self, sink: Sink, depth: int) -> None:
        """Subscribes to everything below ``uvf/``, each message once, with the history of latched and event topics.

        An advanced subscriber on all keys would do, but it drops messages of plain publishers at random.
        """
        seen: dict[tuple[str, int], set[int]] = {}

        def once(sample: Sample) -> None:
            sender = (sample.key, sample.boot)
            numbers = seen[sender] = seen.pop(sender, set())
            if len(seen) > SENDERS_MOST:
                del seen[next(iter(seen))]
            if sample.seq in numbers or (numbers and sample.seq < max(numbers) - 2 * EVENT_HISTORY):
                return
            numbers.add(sample.seq)
            if len(numbers) > 4 * EVENT_HISTORY:
                seen[sender] = {n for n in numbers if n >= sample.seq - 2 * EVENT_HISTORY}
            sink(sample)

        kept = [topic for topic in TOPICS.values() if topic.qos in _KEPT]
        patterns = [topic.by("*").at("*") for topic in kept]

        @lru_cache(maxsize=SENDERS_MOST)
        def is_kept(key: str) -> bool:
            return any(matches(pattern, key) for pattern in patterns)

        # Not a ring channel: that one counts messages, whatever their size, and holds the network's buffers as long as they wait.
        backlog: Backlog[Sample] = Backlog(depth, _size)
        self._declared.append(self._session.declare_subscriber(f"{PREFIX}/**", lambda sample: backlog.push(_arrived(sample))))
        self._inbound.append(_Inbound(f"{PREFIX}/**", backlog.take, [lambda s: (once if is_kept(s.key) else sink)(s)]))
        for topic, pattern in zip(kept, patterns, strict=True):
            self.subscribe(pattern, topic.qos, once, EVENT_HISTORY)

    def behind(self, published: Mapping[str, int]) -> str:
        """A key of which some subscription has not received the given number yet; empty when all have."""
        for inbound in self._inbound:
            for key, seq in published.items():
                if inbound.seen.get(key, 0) < seq and matches(inbound.key, key):
                    return key
        return ""

    def wait(self, timeout: float) -> None:
        """Waits for a message of a waking subscription, or ``timeout`` [s]."""
        self._woken.acquire(timeout=max(timeout, 0.0))

    def serve(self, key: str, sink: Callable[[Query], None]) -> None:
        """Hands requests on ``key`` to ``sink`` in ``poll``."""
        self._servers.append((self._session.declare_queryable(key, zenoh.handlers.FifoChannel(QUERIES), complete=True), sink))

    def call(self, key: str, payload: bytes, stamp_ns: int, on_reply: OnReply) -> None:
        """Sends a request; ``on_reply`` is called in ``poll``, with the reply or the reason why there is none."""
        attachment = Envelope(0, stamp_ns, self.boot, self.epoch).pack()
        replies = self._session.get(key, payload=payload, attachment=attachment, timeout=CALL_TIMEOUT)
        self._calls.append((replies, on_reply, stamp_ns, key))

    def recall(self, key: str) -> bytes | None:
        """Newest message of a kept topic, also of a writer that has died; waits for the state store's answer."""
        replies = self._session.get(kept_key(key), timeout=RECALL_TIMEOUT)
        return next((reply.ok.payload.to_bytes() for reply in replies if reply.ok is not None), None)

    def token(self, key: str) -> None:
        """Declares a liveliness token ``uvf/<key>`` that ends with this session."""
        self._declared.append(self._session.liveliness().declare_token(f"{PREFIX}/{key}"))

    def tokens(self, key: str) -> list[str]:
        """Liveliness tokens that match now, without ``uvf/``."""
        replies = self._session.liveliness().get(f"{PREFIX}/{key}", timeout=2.0)
        return sorted(str(r.ok.key_expr).removeprefix(f"{PREFIX}/") for r in replies if r.ok)

    def poll(self) -> bool:
        """Hands over what has arrived, requests and replies too; True when more messages may wait."""
        for publisher in self._latched:
            publisher.say_again()
        left = [inbound for inbound in (*self._waking, *self._inbound) if not self._empty(inbound)]
        for channel, serve in self._servers:
            for _ in range(QUERIES):
                if (query := channel.try_recv()) is None:
                    break
                serve(_query(query))
        self._poll_calls()
        return bool(left)

    def _empty(self, inbound: "_Inbound") -> bool:
        """Hands over what has arrived; False when more of it may wait."""
        for _ in range(AT_ONCE):
            if (sample := inbound.take()) is None:
                return True
            if sample is NOTHING:
                continue
            self.counter.count(sample.key, sample.boot, sample.seq)
            if self._blocking:
                inbound.seen[sample.key] = max(inbound.seen.get(sample.key, 0), sample.seq)
            for sink in inbound.sinks:
                sink(sample)
        return False

    def _poll_calls(self) -> None:
        waiting = []
        for replies, on_reply, stamp, key in self._calls:
            try:
                reply = replies.try_recv()
            except zenoh.ZError:
                # The channel closes without a reply when no queryable is there.
                on_reply(None, f"nobody answers {key}", stamp)
                continue
            if reply is None:
                waiting.append((replies, on_reply, stamp, key))
            elif reply.ok is not None:
                on_reply(reply.ok.payload.to_bytes(), "", _envelope(reply.ok).stamp_ns)
            else:
                reason = reply.err.payload.to_string()
                on_reply(None, reason if reason not in ("", LATE) else f"no answer from {key} within {CALL_TIMEOUT:g} s", stamp)
        self._calls = waiting


@dataclass
class _Inbound:
    """A subscription; seen: in lockstep, the highest number received of each key."""

    key: str
    take: Callable[[], Sample | None]
    """The next message that has arrived, or None."""
    sinks: list[Sink]
    seen: dict[str, int] = field(default_factory=dict)


NOTHING = Sample("", "", b"", 0, 0, 0, 0)
"""In place of a deletion, which nobody here speaks of."""


def _arrived(sample: zenoh.Sample) -> Sample:
    """A copy: what Zenoh hands over holds the whole buffer in which it came."""
    if sample.kind != zenoh.SampleKind.PUT:
        return NOTHING
    key, type_name = str(sample.key_expr), str(sample.encoding).rpartition(";")[2]
    seq, stamp_ns, boot, epoch = _envelope(sample)
    return Sample(key, type_name, sample.payload.to_bytes(), max(stamp_ns, 0), seq, boot, epoch)


def _size(sample: Sample | zenoh.Sample) -> int:
    return len(sample.payload) + OVERHEAD


def _envelope(carrier: Any) -> Envelope:
    return unpack(carrier.attachment.to_bytes()) if carrier.attachment is not None else Envelope()


def _query(query: zenoh.Query) -> Query:
    key, stamp = str(query.key_expr), _envelope(query).stamp_ns

    def answer(reply: bytes, stamp_ns: int) -> None:
        with query:
            query.reply(key, reply, attachment=Envelope(stamp_ns=stamp_ns).pack())

    def refuse(reason: str) -> None:
        with query:
            query.reply_err(reason.encode())

    return Query(key, query.payload.to_bytes() if query.payload is not None else b"", stamp, answer, refuse)


@dataclass
class ZenohPublisher:
    """Publisher of a ``ZenohBus``."""

    publisher: Any
    bus: ZenohBus
    seq: int = 0
    last: tuple[float, bytes, bytes] | None = None
    """When (s, wall), payload and envelope of what is to be said again."""

    def put(self, payload: bytes, stamp_ns: int) -> int:
        """Sends a message stamped ``stamp_ns`` [ns]; returns its sequence number on the key (from 1)."""
        self.seq += 1
        envelope = Envelope(self.seq, stamp_ns, self.bus.boot, self.bus.epoch).pack()
        self.publisher.put(payload, attachment=envelope)
        self.last = (time.monotonic(), payload, envelope)
        return self.seq

    def say_again(self) -> None:
        """Sends the last latched message once more, if nothing newer has come.

        A message sent right after its publisher was declared was seen to miss a subscriber, history and all.
        It goes with the same envelope, so that nobody takes it for another one.
        """
        if self.last is not None and time.monotonic() - self.last[0] > SAY_AGAIN:
            _, payload, envelope = self.last
            self.publisher.put(payload, attachment=envelope)
            self.last = None
