"""Small filters on single numbers."""

import math


class LowPass:
    """First-order low-pass, exact for an input held over the step; starts at its first sample."""

    def __init__(self, time_constant: float) -> None:
        self._time_constant = time_constant  # s
        self.value: float | None = None

    def step(self, sample: float, dt: float) -> float:
        """Filtered value, in the unit of ``sample``, ``dt`` [s] after the last step."""
        if self.value is None:
            self.value = sample
        self.value += (1 - math.exp(-dt / self._time_constant)) * (sample - self.value)
        return self.value


class RunningMean:
    """Mean of all samples so far, and once ``time`` [s] is over of about as long ago as that."""

    def __init__(self, time: float, value: float, known: float) -> None:
        self.value = value
        """In the unit of the samples; at first what is taken for granted, as if seen for ``known`` [s]."""
        self._time, self._known = time, known

    def step(self, sample: float, dt: float) -> float:
        """The mean with a sample that lasted ``dt`` [s]."""
        self._known = min(self._known + dt, self._time)
        self.value += dt / self._known * (sample - self.value)
        return self.value


class Integral:
    """Integral that is kept within +-limit, in the unit of the rate times seconds."""

    def __init__(self, limit: float) -> None:
        self._limit = limit
        self.value = 0.0

    def step(self, rate: float, dt: float) -> float:
        """Adds ``rate`` [unit/s] over ``dt`` [s] and returns the bounded integral [unit]."""
        self.value = min(max(self.value + rate * dt, -self._limit), self._limit)
        return self.value
