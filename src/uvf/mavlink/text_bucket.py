"""How many texts one side takes from the other: as many as somebody can read, whoever sends them."""

from dataclasses import dataclass

TEXTS_PER_SECOND, TEXTS_AT_ONCE = 20.0, 50.0


@dataclass
class TextBucket:
    """Token bucket that limits texts; t: [s], when it was last refilled; left: texts that may go through at once."""

    t: float
    left: float = TEXTS_AT_ONCE

    def refill(self, t: float) -> None:
        """Adds what ``TEXTS_PER_SECOND`` gives up to ``t`` [s], to at most ``TEXTS_AT_ONCE``."""
        self.left = min(self.left + TEXTS_PER_SECOND * (t - self.t), TEXTS_AT_ONCE)
        self.t = t

    def take(self, t: float) -> bool:
        """Whether one more text goes through at ``t`` [s]; if so it is counted."""
        self.refill(t)
        if self.left < 1.0:
            return False
        self.left -= 1.0
        return True

    @property
    def is_full(self) -> bool:
        """Whether as many texts as ever may go through at once."""
        return self.left >= TEXTS_AT_ONCE
