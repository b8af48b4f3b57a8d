"""How many texts one side takes from the other: as many as somebody can read, whoever sends them."""

from dataclasses import dataclass

TEXTS_PER_SECOND, TEXTS_AT_ONCE = 20.0, 50.0


@dataclass
class TextBucket:
    """A token bucket; t [s]: when it was filled up last."""

    t: float
    left: float = TEXTS_AT_ONCE

    def refill(self, t: float) -> None:
        self.left = min(self.left + TEXTS_PER_SECOND * (t - self.t), TEXTS_AT_ONCE)
        self.t = t

    def take(self, t: float) -> bool:
        """Whether one more goes through at ``t``."""
        self.refill(t)
        if self.left < 1.0:
            return False
        self.left -= 1.0
        return True

    @property
    def is_full(self) -> bool:
        return self.left >= TEXTS_AT_ONCE
