"""Messages that a service does not take: counted by key, and told once for each reason."""

from collections.abc import Callable, Iterable, Iterator

from schemas.messages import Refusal
from uvf.runtime.messages.validation import escaped

KEYS_MOST = 50
"""Keys that are counted; a stranger can make up any number of them."""
TOLD_MOST = 100  # different lines
LENGTH = 200  # characters of a key or a reason
SHOWN = 20


class Refusals:
    """Counts messages that are not taken, by key, and tells each reason once."""

    def __init__(self, tell: Callable[[str], None]) -> None:
        """tell: takes each different line once."""
        self.count = 0
        self._tell = tell
        self._told: set[str] = set()
        self._by_key: dict[str, Refusal] = {}

    def refuse(self, line: str) -> None:
        """Counts a refused message. line: ``KEY: what is wrong``; what is told of it can be shown anywhere."""
        self.count += 1
        key, _, why = line.partition(": ")
        key, why = (escaped(text[:LENGTH])[:LENGTH] for text in (key, why))
        if key in self._by_key or len(self._by_key) < KEYS_MOST:
            refusal = self._by_key.setdefault(key, Refusal(key=key, why=why))
            refusal.count += 1
        told = f"{key}: {why}" if why else key
        if told not in self._told and len(self._told) < TOLD_MOST:
            self._told.add(told)
            self._tell(told)

    def __iter__(self) -> Iterator[Refusal]:
        return iter(self._by_key.values())


def together(several: Iterable[Refusals]) -> list[Refusal]:
    """Refusals of all instances of a process, by key with the first reason; only the most frequent, those first."""
    sums: dict[str, Refusal] = {}
    for refusal in (r for refusals in several for r in refusals):
        sums.setdefault(refusal.key, Refusal(key=refusal.key, why=refusal.why)).count += refusal.count
    return sorted(sums.values(), key=lambda r: (-r.count, r.key))[:SHOWN]
