"""Small filters on single numbers."""

import math


class LowPass:
    """First-order low-pass, exact for an input held over the step; starts at its first sample."""

    def __init__(self, time_constant: float) -> None:
        self._time_constant = time_constant  # s
        self.value: float | None = None

    def step(self, sample: float, dt: float) -> float:
        """The filtered value ``dt`` [s] later."""
        if self.value is None:
            self.value = sample
        self.value += (1 - math.exp(-dt / self._time_constant)) * (sample - self.value)
        return self.value


class Integral:
    """Integral within +-limit."""

    def __init__(self, limit: float) -> None:
        self._limit = limit
        self.value = 0.0

    def step(self, rate: float, dt: float) -> float:
        self.value = min(max(self.value + rate * dt, -self._limit), self._limit)
        return self.value
