"""What has happened, for people to read: the log, and the notices that stand on the page for a while."""

from collections import deque
from collections.abc import Iterator
from typing import NamedTuple

from schemas.messages import Event

KEPT = 60  # lines of each class
NOTICES = 4
TOLD_FOR = 6.0  # s, wall
WARNED_FOR = 12.0  # s, wall
ALARMED_FOR = 30.0  # s, wall


class EventLine(NamedTuple):
    """One line of the event log."""

    t: float  # s, simulation time
    severity: int  # as in uvf.v1.Event
    vehicle: str  # or "" for the system
    text: str
    of_operator: bool = False
    """Asked for on the page, or what became of it."""

    @property
    def kind(self) -> str:
        """The class by which the log is kept and filtered."""
        if self.of_operator:
            return "operator"
        if self.severity >= Event.WARNING:
            return "warning"
        return "notice" if self.severity == Event.NOTICE else "routine"


class Notice(NamedTuple):
    """A line shown over the scene for a while."""

    line: EventLine
    good: bool
    until: float  # s, wall


class EventHistory:
    """The newest lines of each class in rings of their own, so that many of one displace none of another."""

    def __init__(self) -> None:
        self._kept: dict[str, deque[tuple[int, EventLine]]] = {}
        self._notices: deque[Notice] = deque(maxlen=NOTICES)
        self.count = 0

    def write(self, line: EventLine) -> None:
        """Appends a line to the log."""
        self._kept.setdefault(line.kind, deque(maxlen=KEPT)).append((self.count, line))
        self.count += 1

    def tell(self, t: float, line: EventLine, good: bool = False) -> None:
        """Shows a line on the page too, from ``t`` [s, wall] on, the longer the more severe it is."""
        time = TOLD_FOR if good else WARNED_FOR if line.severity <= Event.WARNING else ALARMED_FOR
        self._notices.append(Notice(line, good, t + time))

    def notices(self, t: float) -> list[Notice]:
        """The notices to be shown at ``t`` [s, wall], newest first."""
        return [notice for notice in reversed(self._notices) if notice.until > t]

    def since(self, count: int) -> list[EventLine]:
        """The lines that have been written since ``count`` was what it is, oldest first; long ones ago may be missing."""
        return [line for n, line in sorted(pair for kept in self._kept.values() for pair in kept) if n >= count]

    def __iter__(self) -> Iterator[EventLine]:
        """Oldest first."""
        return (line for _, line in sorted(pair for kept in self._kept.values() for pair in kept))
