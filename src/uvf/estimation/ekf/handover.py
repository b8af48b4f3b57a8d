"""When satellites are back the position known jumps; what guidance is told of it moves there within a few seconds."""

import math

import numpy as np

from uvf.estimation.ekf.states import Floats

LOST = 1.0  # s without a fix, from where on a jump is expected
SOFTLY = 2.0  # s
SETTLES = 3.0  # s
FARTHEST = 200.0  # m; beyond, it is somewhere else


class Handover:
    """Fades out jumps of the position: what is still held back from guidance."""

    def __init__(self) -> None:
        self._back: Floats = np.zeros(3)
        self._settling = 0.0  # s, left in which fixes still change much

    @property
    def off(self) -> float:
        """Horizontal distance [m] that is still held back."""
        return math.hypot(self._back[0], self._back[1])

    def take(self, back: Floats, gnss_age: float) -> None:
        """Takes a jump of the position ``back`` (3,) [m], NED, from the new one to the one before.

        gnss_age: [s] without a fix until this one. Held back only after a loss of satellites, and below ``FARTHEST``.
        """
        if gnss_age > LOST:
            self._settling = SETTLES
        if self._settling > 0.0 and math.hypot(back[0], back[1]) < FARTHEST:
            self._back = self._back + back

    def step(self, dt: float) -> Floats:
        """Offset (3,) [m], NED, to add to the position ``dt`` [s] later."""
        self._settling -= dt
        self._back = self._back * math.exp(-dt / SOFTLY)
        return self._back
