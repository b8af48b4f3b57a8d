"""What an autopilot says and the bridge does not take: each kind is told once, all are counted."""

from collections import Counter
from collections.abc import Callable

from schemas.messages import Event

KINDS_MOST = 50
MEND = "the bridge goes on without it; look at what the autopilot sends"


class LinkRefusals:
    """Counts what is refused on the link, and reports the first of each kind."""

    def __init__(self, say: Callable[[Event.Severity, str], None]) -> None:
        self.counts: Counter[str] = Counter()
        """By what is refused: messages, or parts of them."""
        self._say = say

    def refuse(self, what: str, why: str) -> None:
        """Counts a refusal. what: one of few words; why: may hold numbers."""
        if what not in self.counts and len(self.counts) >= KINDS_MOST:
            return
        self.counts[what] += 1
        if self.counts[what] == 1:
            self._say(Event.WARNING, f"{what} is not taken: {why}; {MEND}")
