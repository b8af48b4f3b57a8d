"""Which moment of the past a browser looks at."""

from typing import NamedTuple

RATES = {"× 1": 1.0, "× 4": 4.0, "× 16": 16.0}


class PastChoice(NamedTuple):
    """The moment, and whether time goes on from there."""

    t: float  # s, wall
    running: bool = False
    rate: float = 1.0
