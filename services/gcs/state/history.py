"""The last ten minutes of what the ground station has heard, from which any moment of them can be shown again."""

from bisect import bisect_right
from collections import deque
from collections.abc import Iterable, Mapping, Set
from typing import NamedTuple

import numpy as np
from google.protobuf.message import Message
from numpy.typing import NDArray

from schemas.messages import CompressedImage, Grid, OctreeMap
from services.gcs.state.event_log import EventLine

Floats = NDArray[np.float64]
Key = tuple[str, str]
"""(kind, vehicle or "")."""

LENGTH = 600.0  # s
BUDGET = 256_000_000  # bytes of messages; with more vehicles or larger maps the history is shorter
STRETCH = 5.0  # s
CLOCK, OBJECTS, WINDSOCKS = "clock", "objects", "windsocks"
OF_NOBODY = (CLOCK, OBJECTS, WINDSOCKS)
"""Kinds that are not of a vehicle."""
THINNED: Mapping[type[Message], float] = {CompressedImage: 0.5, Grid: 2.0, OctreeMap: 10.0}
"""Least time [s] between two that are kept of these, which are large."""
EVENTS_MOST = 2000


class Kept(NamedTuple):
    """A message as it was heard."""

    t: float  # s, wall
    key: Key
    type: type[Message]
    payload: bytes

    @property
    def message(self) -> Message:
        """The message, made anew."""
        made = self.type()
        made.ParseFromString(self.payload)
        return made


class Stretch(NamedTuple):
    """A few seconds of the history."""

    begin: float  # s, wall
    before: Mapping[Key, Kept]
    """The newest message of each kind when it began."""
    kept: list[Kept]


class TimedLine(NamedTuple):
    """A line of the event log, and when it was written."""

    t: float  # s, wall
    line: EventLine


class RecentHistory:
    """Messages of the last ``length`` [s], as long as they fit into ``budget`` [bytes]; times are wall clock [s], rising."""

    def __init__(self, length: float = LENGTH, budget: int = BUDGET) -> None:
        self._length = length
        self._budget = budget
        self._stretches: deque[Stretch] = deque()
        self._size = 0
        self._newest: dict[Key, Kept] = {}
        self._last: dict[Key, Message] = {}
        self._lines: deque[TimedLine] = deque(maxlen=EVENTS_MOST)
        self._ways: dict[str, deque[tuple[float, Floats]]] = {}

    def hear(self, t: float, what: str, messages: Mapping[str, Message]) -> None:
        """Keeps the newest message of one kind of each vehicle; one that is not new is ignored."""
        for name, message in messages.items():
            key = (what, name)
            if self._last.get(key) is message:
                continue
            before = self._newest.get(key)
            if before is not None and t - before.t < THINNED.get(type(message), 0.0):
                continue
            self._last[key] = message
            self._keep(Kept(t, key, type(message), message.SerializeToString()))

    def _keep(self, kept: Kept) -> None:
        if not self._stretches or kept.t - self._stretches[-1].begin >= STRETCH:
            self._stretches.append(Stretch(kept.t, dict(self._newest), []))
        self._stretches[-1].kept.append(kept)
        self._size += len(kept.payload)
        self._newest[kept.key] = kept
        self._forget(kept.t)

    def _forget(self, t: float) -> None:
        """Whole stretches only: each begins with all that was known then."""
        while len(self._stretches) > 1 and (t - self._stretches[1].begin >= self._length or self._size > self._budget):
            self._size -= sum(len(kept.payload) for kept in self._stretches.popleft().kept)
            begin = self._stretches[0].begin
            while self._lines and self._lines[0].t < begin:
                self._lines.popleft()
            for way in self._ways.values():
                while way and way[0][0] < begin:
                    way.popleft()

    def only(self, vehicles: Set[str]) -> None:
        """Lets go of what was heard of other vehicles than these; the moments before still have it."""
        for known in (self._newest, self._last):
            for key in [key for key in known if key[1] not in vehicles and key[0] not in OF_NOBODY]:
                del known[key]
        for name in [name for name, way in self._ways.items() if not way and name not in vehicles]:
            del self._ways[name]

    def note(self, t: float, lines: Iterable[EventLine]) -> None:
        """Keeps lines of the event log."""
        self._lines.extend(TimedLine(t, line) for line in lines)

    def go(self, t: float, name: str, position: Floats, spacing: float) -> None:
        """Keeps where a vehicle is: positions (3,) [m, world] at least ``spacing`` [m] apart."""
        way = self._ways.setdefault(name, deque())
        if not way or float(np.abs(position - way[-1][1]).max()) >= spacing:
            way.append((t, position))

    @property
    def begin(self) -> float | None:
        """When the history begins; None while it is empty."""
        return self._stretches[0].begin if self._stretches else None

    def at(self, t: float) -> Mapping[Key, Kept]:
        """The newest message of each kind at ``t``."""
        n = bisect_right(self._stretches, t, key=lambda stretch: stretch.begin)
        if n == 0:
            return {}
        found = dict(self._stretches[n - 1].before)
        for kept in self._stretches[n - 1].kept:
            if kept.t > t:
                break
            found[kept.key] = kept
        return found

    def lines(self, until: float) -> list[TimedLine]:
        """Lines of the event log up to ``until``."""
        return [timed for timed in self._lines if timed.t <= until]

    def ticks(self, until: float) -> list[TimedLine]:
        """Those of the lines that a time bar marks: what an operator did, and what is more than routine."""
        return [timed for timed in self.lines(until) if timed.line.kind != "routine"]

    def way(self, name: str, until: float) -> list[Floats]:
        """Positions (3,) [m, world] of a vehicle up to ``until``."""
        return [position for t, position in self._ways.get(name, ()) if t <= until]
