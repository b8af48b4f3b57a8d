"""Who of several senders of one kind of command is let through: by fixed ranks, and among equals whoever holds already.

A sender is the ``<source>`` in the key that it writes to, whatever its messages say of themselves.
"""

from collections.abc import Collection

Order = tuple[tuple[str, ...], ...]
"""Ranks of sources, the highest first; those of one rank are equals. Who is in none is not let through."""
DISARMED_OFFBOARD = "it is disarmed: arm it before mode Offboard, in which others move it at once"
OFFBOARD: Order = (("offboard",), ("client", "mavlink"))
"""In mode Offboard, of any vehicle: a program on board first; then programs elsewhere, over the bus or over MAVLink."""
SAME_WITHIN = 10.0  # s: what happens again within that time is an alternation that has been told of


def in_turn(sources: Collection[str]) -> Order:
    """The order in which each source is a rank of its own, the first one the highest."""
    return tuple((source,) for source in sources)


def holder(fresh: Collection[str], order: Order, held: str) -> str:
    """The source in force of those ``fresh``, by rank; among equals the one that was in force, ``held``. "" = none."""
    for rank in order:
        present = [source for source in rank if source in fresh]
        if present:
            return held if held in present else present[0]
    return ""


class Once:
    """Reports an occurrence when it begins, but not again while it goes on or alternates."""

    def __init__(self) -> None:
        self._last: dict[str, float] = {}

    def is_new(self, t: float, what: str) -> bool:
        """Whether it has not occurred within ``SAME_WITHIN`` before ``t`` [s]; what: one of few texts."""
        last = self._last.get(what)
        self._last[what] = t
        return last is None or not 0 <= t - last < SAME_WITHIN


class Multiplexer:
    """Selects the source of one kind of command, and reports changes of it."""

    def __init__(self, what: str, order: Order) -> None:
        """what: as it is told of, in the plural."""
        self._what, self._order = what, order
        self.holder = ""
        self.waiting: tuple[str, ...] = ()
        """Who else sends."""
        self._before = ""
        self._once = Once()

    def pick(self, fresh: Collection[str]) -> str:
        """The source in force; called in each cycle."""
        self._before = self.holder
        self.holder = holder(fresh, self._order, self.holder)
        self.waiting = tuple(s for rank in self._order for s in rank if s in fresh and s != self.holder)
        return self.holder

    def news(self, t: float) -> list[tuple[str, str]]:
        """(occurrence, cause) to be reported in this cycle at ``t`` [s]: a hand-over, or another source that sends.

        Call it in cycles in which the commands are in force.
        """
        told = [(f"{self._what} of {source} wait", f"{self.holder} {self._why_not(source)}") for source in self.waiting]
        before, now = self._before, self.holder
        if before and now and before != now:
            why = f"{now} comes before {before}" if before in self.waiting else f"{before} is silent"
            told = [(f"{self._what} from {now}, no longer from {before}", why)] + [each for each in told if before not in each[0]]
        return [each for each in told if self._once.is_new(t, each[0])]

    def _why_not(self, source: str) -> str:
        are_equal = any(source in rank and self.holder in rank for rank in self._order)
        return "was there first" if are_equal else "comes before"
