"""Gates of innovations: what to do about a sensor that contradicts the state for long."""


class Gate:
    """The newest test ratio of a sensor, and for how long all its measurements have been refused."""

    def __init__(self, patience: float) -> None:
        """patience: s, after which the state is taken to be wrong, not the sensor."""
        self._patience = patience
        self.ratio = 0.0
        self._refused = 0.0  # s

    def exhausted(self, ratio: float, dt: float) -> bool:
        """Takes the test ratio [-] of a measurement ``dt`` [s] after the last; whether it is time to reset the state to the sensor."""
        self.ratio = ratio
        self._refused = self._refused + dt if ratio > 1.0 else 0.0
        if self._refused < self._patience:
            return False
        self._refused = 0.0
        return True


class Every:
    """Tells when a period has passed."""

    def __init__(self, period: float) -> None:
        self._period = period  # s
        self._last = -period

    def due(self, t: float) -> bool:
        """Whether the period has passed at ``t`` [s] since it last had; if so the next one begins."""
        if t - self._last < self._period - 1e-6:
            return False
        self._last = t
        return True
