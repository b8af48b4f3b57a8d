"""What the page does not take in from the bus, counted and told of once a kind: names that are none, more vehicles than it can show."""

from collections.abc import Callable

MOST_COUNTED = 1000
LENGTH = 64  # letters by which two of them are told apart


class PageRefusals:
    """Counts what the page does not show. tell: takes a line for the log."""

    def __init__(self, tell: Callable[[str], None]) -> None:
        self._tell = tell
        self._seen: dict[str, set[str]] = {}

    def add(self, kind: str, name: str, line: str) -> None:
        """Counts a name of a kind (plural, as in ``names``); ``line`` is reported with the first of its kind."""
        seen = self._seen.setdefault(kind, set())
        if not seen:
            self._tell(f"{line}; further ones are only counted")
        if len(seen) < MOST_COUNTED:
            seen.add(name[:LENGTH])

    def __str__(self) -> str:
        """``2 names, 1000+ vehicles``; empty when nothing was refused."""
        return ", ".join(f"{len(seen)}{'+' if len(seen) == MOST_COUNTED else ''} {kind}" for kind, seen in sorted(self._seen.items()))
