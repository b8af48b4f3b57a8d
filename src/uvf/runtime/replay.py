"""A log put to use again: onto the bus at its own pace, or into one service whose outputs are compared."""

import contextlib
import re
import tempfile
import time
from collections import defaultdict, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeGuard

from google.protobuf.message import Message

from schemas.topics import SYSTEM, Qos
from uvf.runtime.bus import Bus, LocalBus, Publisher, Query, Sample, matches
from uvf.runtime.clock import NS, first_step_after
from uvf.runtime.params import BadInput
from uvf.runtime.recording import log_attachments, log_begin, read_log, topic_of
from uvf.runtime.shell import Shell
from uvf.runtime.site import Host, Site, load_site

TOLERANCE = 1e-9
FLOAT = re.compile(r"-?\d+\.\d+(e-?\d+)?|-?\d+e-?\d+")


@contextlib.contextmanager
def logged_site(log: Path) -> Iterator[Site]:
    """The mission that a log was recorded of, with its world and vehicles as they were then. Raises BadInput."""
    files = log_attachments(log)
    mission = next((name for name in files if name.startswith("missions/")), None)
    if mission is None:
        raise BadInput(f"log {log}: no mission is attached to it; name the one that it was recorded of with --mission")
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, data in files.items():
            path = (root / name).resolve()
            if path.is_relative_to(root.resolve()):
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(data)
        try:
            site = load_site(root / mission, root)
        except BadInput as error:
            why = str(error).replace(f"{folder}/", "")
            raise BadInput(f"log {log}: the mission in it is of another version ({why}); name one with --mission") from error
        yield site


def onto_bus(log: Path, bus: Bus, rate: float = 1.0, go_on: Callable[[], bool] = lambda: True) -> int:
    """Publishes a log's messages at ``rate`` times real time; returns how many. Raises BadInput.

    What stands at the head of a log that did not begin with the run is said at once.
    """
    publishers: dict[str, Publisher] = {}
    begin, begun = log_begin(log), time.monotonic()
    count = 0
    for sample in read_log(log):
        while go_on() and (wait := begun + (sample.stamp_ns - begin) / NS / rate - time.monotonic()) > 0:
            time.sleep(min(wait, 0.1))
        if not go_on():
            break
        if sample.key not in publishers:
            topic = topic_of(sample.key)
            publishers[sample.key] = bus.publisher(sample.key, sample.type_name, topic.qos if topic else Qos.SENSOR)
        publishers[sample.key].put(sample.payload, sample.stamp_ns)
        count += 1
    return count


@dataclass(frozen=True)
class Difference:
    """One field that came out otherwise than in the log."""

    key: str
    stamp_ns: int
    field: str
    logged: str
    now: str

    def __str__(self) -> str:
        return f"{self.stamp_ns / NS:.3f} s {self.key}: {self.field}: was {self.logged}, is {self.now}"


def into_service(log: Path, host: Host, tolerance: float = TOLERANCE) -> Iterator[Difference]:
    """Feeds inputs, requests and answers of a log to one service and yields each field that it puts out otherwise.

    Raises BadInput.
    """
    owners = (host.vehicle,) if host.vehicle else host.writes_for or (SYSTEM,)
    served = [request.at(owner) for request in host.service.requests.values() for owner in owners]
    writes = [topic.at(owner) for topic in host.service.outputs.values() for owner in owners if topic.logged]
    writes += [f"{key}/{half}" for key in served for half in ("request", "reply")]
    samples = list(read_log(log))
    own = [s for s in samples if _any(writes, s.key)]
    bus = LocalBus()
    made: list[Sample] = []
    for key in writes:
        bus.subscribe(key, Qos.STATE, made.append)
    _answer_from_log(bus, [request.at(owner) for request in host.service.calls.values() for owner in owners], samples)
    shell = Shell(host, bus)
    begin = log_begin(log)
    if begin:
        _take_up(shell, samples, begin)
    feed = [s for s in samples if not _any(writes, s.key)] + [s for s in own if s.key.endswith("/request")]
    play(shell, bus, sorted(feed, key=lambda s: s.stamp_ns), max((s.stamp_ns for s in samples), default=0))
    shell.service.close()
    # Of the steps before, whose outputs may come late, none has been run here.
    since = begin + round(host.service.latency * NS) if begin else -1
    yield from _compare((s for s in own if s.stamp_ns > since), (s for s in made if s.stamp_ns > since), tolerance)


def _take_up(shell: Shell, samples: Iterable[Sample], begin: int) -> None:
    """In a log that begins within a run, the service begins like one that is started again there."""
    left = {s.key: s.payload for s in samples if s.stamp_ns <= begin}
    shell.recall(left.get)
    shell.n = first_step_after(begin, shell.type.hz)


def _any(keys: Iterable[str], key: str) -> bool:
    return any(matches(wanted, key) for wanted in keys)


def _answer_from_log(bus: LocalBus, asked: Iterable[str], samples: Sequence[Sample]) -> None:
    """Whatever the service asks is answered as it was then."""
    for key in asked:
        replies = deque(s for s in samples if s.key == f"{key}/reply")

        def answer(query: Query, replies: deque[Sample] = replies) -> None:
            if replies:
                reply = replies.popleft()
                query.answer(reply.payload, reply.stamp_ns)
            else:
                query.refuse("the log holds no answer")

        bus.serve(key, answer)


def play(shell: Shell, bus: LocalBus, feed: Sequence[Sample], end_ns: int) -> None:
    """Steps a service up to ``end_ns``; feed: all that it may hear, by stamp.

    A recorded request carries the stamp of the step that answered it: it was there before that step.
    """
    waiting = deque(feed)
    while shell.due_ns <= end_ns:
        while waiting and waiting[0].stamp_ns < shell.due_ns + waiting[0].key.endswith("/request"):
            sample = waiting.popleft()
            if sample.key.endswith("/request"):
                bus.call(sample.key.removesuffix("/request"), sample.payload, sample.stamp_ns - 1, lambda *reply: None)
            elif not sample.key.endswith("/reply"):
                topic = topic_of(sample.key)
                bus.deliver(sample.key, sample.type_name, topic.qos if topic else Qos.STATE, sample.payload, sample.stamp_ns)
        shell.advance()


def _compare(logged: Iterable[Sample], made: Iterable[Sample], tolerance: float) -> Iterator[Difference]:
    """Messages are paired by stamp, for numbers start over with each writer."""
    now = _numbered(made)
    for which, old in _numbered(logged).items():
        new = now.pop(which, None)
        if new is None:
            yield Difference(old.key, old.stamp_ns, "message", f"number {old.seq}", "missing")
        elif new.payload != old.payload:
            yield from _fields(old, new, tolerance)
    for new in now.values():
        yield Difference(new.key, new.stamp_ns, "message", "missing", f"number {new.seq}")


def _numbered(samples: Iterable[Sample]) -> dict[tuple[str, int, int], Sample]:
    """By key, stamp [ns] and how many of that key and stamp came before."""
    found: dict[tuple[str, int, int], Sample] = {}
    count: defaultdict[tuple[str, int], int] = defaultdict(int)
    for sample in samples:
        found[(sample.key, sample.stamp_ns, count[sample.key, sample.stamp_ns])] = sample
        count[sample.key, sample.stamp_ns] += 1
    return found


def _fields(old: Sample, new: Sample, tolerance: float) -> Iterator[Difference]:
    topic = topic_of(old.key)
    if topic is None:
        return
    for name, a, b in differing(topic.message.FromString(old.payload), topic.message.FromString(new.payload), tolerance):
        yield Difference(old.key, old.stamp_ns, name, a, b)


def differing(a: Message, b: Message, tolerance: float, prefix: str = "") -> Iterator[tuple[str, str, str]]:
    """(field, value in a, value in b) of every leaf that differs by more than ``tolerance`` (floats: absolute)."""
    for field in a.DESCRIPTOR.fields:
        x, y, name = getattr(a, field.name), getattr(b, field.name), f"{prefix}{field.name}"
        if isinstance(x, Message):
            yield from differing(x, y, tolerance, f"{name}.")
        elif _is_list(x) and len(x) == len(y) and field.message_type is not None:
            for i, (p, q) in enumerate(zip(x, y, strict=True)):
                yield from differing(p, q, tolerance, f"{name}[{i}].")
        elif x != y and not _near(x, y, tolerance):
            yield name, str(x)[:60], str(y)[:60]


def _near(x: object, y: object, tolerance: float) -> bool:
    """Whether both are floats, lists of these, or such as text, that differ by no more."""
    if isinstance(x, str) and isinstance(y, str):
        return FLOAT.fullmatch(x) is not None and FLOAT.fullmatch(y) is not None and abs(float(x) - float(y)) <= tolerance
    if _is_list(x) and _is_list(y):
        return len(x) == len(y) and all(p == q or _near(p, q, tolerance) for p, q in zip(x, y, strict=True))
    return isinstance(x, float) and isinstance(y, float) and abs(x - y) <= tolerance


def _is_list(value: object) -> TypeGuard[Sequence[Any]]:
    return isinstance(value, Sequence) and not isinstance(value, str | bytes)
