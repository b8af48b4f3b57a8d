"""How fast the wind changes along the flight, where the airspeed shows each gust; the filter lets its wind walk at random as much."""

import math

import numpy as np

from uvf.estimation.ekf.states import Floats

MEMORY = 30.0  # s
WINDOW = 1.0  # s
FIRST, LEAST = 0.3, 0.05  # m/s/sqrt(s)


class GustEstimate:
    """Random walk of the wind along the flight path; walk: [m/s/sqrt(s)], of each component of the wind."""

    def __init__(self) -> None:
        self.walk = FIRST
        self._before: Floats | None = None
        self._passed = 0.0  # s

    def learn(self, wind: Floats, through_air: Floats, dt: float) -> None:
        """Takes wind (2,) and velocity through the air (3,) [m/s], NED, in flight, ``dt`` [s] after the last."""
        self._passed += dt
        if self._before is not None and self._passed < WINDOW:
            return
        if self._before is not None:
            change = float((wind - self._before) @ through_air[:2]) / float(np.linalg.norm(through_air[:2]))
            share = min(self._passed / MEMORY, 1.0)
            self.walk = max(math.sqrt(self.walk**2 + share * (change**2 / self._passed - self.walk**2)), LEAST)
        self._before, self._passed = wind.copy(), 0.0
