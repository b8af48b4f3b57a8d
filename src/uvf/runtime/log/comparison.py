"""What a service put out in a log and what it puts out now, compared as both come."""

import heapq
import re
from array import array
from collections import Counter, deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeGuard

from google.protobuf.message import DecodeError, Message

from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.step_times import NS
from uvf.runtime.messages.topic_lookup import topic_of

TOLERANCE = 1e-9
FLOAT = re.compile(r"-?\d+\.\d+(e-?\d+)?|-?\d+e-?\d+")

Which = tuple[str, int, int]
"""Key, stamp [ns] and how many of that key and stamp came before: sequence numbers start over with each writer."""


@dataclass(frozen=True)
class Difference:
    """A field that came out otherwise than in the log."""

    key: str
    stamp_ns: int
    field: str
    logged: str
    now: str

    def __str__(self) -> str:
        return f"{self.stamp_ns / NS:.3f} s {self.key}: {self.field}: was {self.logged}, is {self.now}"


class Comparison:
    """Pairs the messages of a log with those made now by key and stamp; holds them only until the step that makes them is over.

    since: only messages stamped later [ns] are compared.
    """

    def __init__(self, since: int, tolerance: float = TOLERANCE) -> None:
        self._since = since
        self._tolerance = tolerance
        self._logged: deque[tuple[Which, Sample]] = deque()
        self._made: dict[Which, tuple[int, Sample]] = {}
        self._counts: tuple[Counter[tuple[str, int]], Counter[tuple[str, int]]] = (Counter(), Counter())
        self._made_count = 0
        self._surplus: dict[str, array[int]] = {}
        """Messages that are not in the log, by key: for each, how many were made before it, stamp and number."""

    def add_logged(self, sample: Sample) -> None:
        """Adds a message of the log, in the order of their stamps."""
        if sample.stamp_ns > self._since:
            self._logged.append((self._which(sample, self._counts[0]), sample))

    def add_made(self, sample: Sample) -> None:
        """Adds a message that the service puts out now."""
        if sample.stamp_ns > self._since:
            self._made[self._which(sample, self._counts[1])] = (self._made_count, sample)
            self._made_count += 1

    @staticmethod
    def _which(sample: Sample, counts: Counter[tuple[str, int]]) -> Which:
        pair = sample.key, sample.stamp_ns
        counts[pair] += 1
        return *pair, counts[pair]

    def differences(self, before_ns: float) -> Iterator[Difference]:
        """Differences in messages stamped before ``before_ns`` [ns] that were not compared yet; all must have been added, and all made."""
        while self._logged and self._logged[0][1].stamp_ns < before_ns:
            which, old = self._logged.popleft()
            _, new = self._made.pop(which, (0, None))
            if new is None:
                yield Difference(old.key, old.stamp_ns, "message", f"number {old.seq}", "missing")
            elif new.payload != old.payload:
                yield from _fields(old, new, self._tolerance)
        for which in [which for which in self._made if which[1] < before_ns]:
            n, new = self._made.pop(which)
            self._surplus.setdefault(new.key, array("Q")).extend((n, new.stamp_ns, new.seq))
        for counts in self._counts:
            for pair in [pair for pair in counts if pair[1] < before_ns]:
                del counts[pair]

    def rest(self) -> Iterator[Difference]:
        """Differences at the end, when nothing comes any more: with all messages that are not in the log, as they were made."""
        yield from self.differences(float("inf"))
        for _, key, stamp_ns, seq in heapq.merge(*(_rows(key, numbers) for key, numbers in self._surplus.items())):
            yield Difference(key, stamp_ns, "message", "missing", f"number {seq}")


def _rows(key: str, numbers: Sequence[int]) -> Iterator[tuple[int, str, int, int]]:
    each = iter(numbers)
    for n, stamp_ns, seq in zip(each, each, each, strict=True):
        yield n, key, stamp_ns, seq


def _fields(old: Sample, new: Sample, tolerance: float) -> Iterator[Difference]:
    topic = topic_of(old.key)
    if topic is None:
        return
    try:
        logged = topic.message.FromString(old.payload)
    except DecodeError:  # somebody else has put it there
        yield Difference(old.key, old.stamp_ns, "message", "broken bytes", f"number {new.seq}")
        return
    for name, a, b in differing(logged, topic.message.FromString(new.payload), tolerance):
        yield Difference(old.key, old.stamp_ns, name, a, b)


def differing(a: Message, b: Message, tolerance: float, prefix: str = "") -> Iterator[tuple[str, str, str]]:
    """(field, value in a, value in b) of every leaf that differs by more than ``tolerance``, absolute [unit of the field]."""
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
