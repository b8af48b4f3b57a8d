"""Pressures: what the air data say without the filter."""

from uvf.estimation.sensor_inputs import Pressures
from uvf.maths import atmosphere
from uvf.maths.filters import LowPass

PRESSURE_TIME = 0.08  # s


class AirData:
    """The newest pressures and their low-passes. Without any, density stays as it was."""

    def __init__(self) -> None:
        self._static, self._differential = LowPass(PRESSURE_TIME), LowPass(PRESSURE_TIME)
        self.density = atmosphere.RHO0
        self.pressures: Pressures | None = None
        self.fresh = False
        """Whether they are new in this cycle."""
        self._taken = -1.0  # s

    def take(self, pressures: Pressures | None, t: float, dt: float) -> None:
        """Takes the pressures of the cycle at ``t`` [s], ``dt`` [s] after the last."""
        self.pressures = pressures
        self.fresh = False
        if pressures is None:
            return
        taken = t - pressures.age
        self.fresh, self._taken = taken > self._taken + 1e-6, taken
        self.density = atmosphere.density(self._static.step(pressures.static, dt), pressures.temperature)
        self._differential.step(pressures.differential, dt)

    def airspeed(self, bias: float) -> float:
        """True airspeed [m/s]; bias of the differential pressure [Pa]."""
        return atmosphere.airspeed((self._differential.value or 0.0) - bias, self.density)
