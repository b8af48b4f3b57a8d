"""What an import left out or changed, and why."""

NAMED = 4  # of each kind; the rest is counted


class Notes:
    """What an import has to tell: each reason once, with the things that it concerns."""

    def __init__(self) -> None:
        self._found: dict[str, list[str]] = {}

    def add(self, reason: str, thing: str = "") -> None:
        """Notes that ``reason`` applies to ``thing``."""
        self._found.setdefault(reason, []).append(thing)

    def lines(self) -> list[str]:
        """One line for each reason."""
        return [_line(reason, [t for t in things if t]) for reason, things in self._found.items()]


def _line(reason: str, things: list[str]) -> str:
    if not things:
        return reason
    names = list(dict.fromkeys(things))
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return f"{reason}: {', '.join(names[:NAMED])}{more}"
