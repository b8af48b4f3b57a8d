"""Pressures: what the air data say without the filter."""

import math

from uvf.estimation.sensor_inputs import Pressures
from uvf.maths import atmosphere
from uvf.maths.filters import LowPass

PRESSURE_TIME = 0.08  # s
SMOOTHER = 2.0  # than the least error asks for: a surface would move with each error
SLOWEST = 1.0  # m/s


class AirData:
    """The newest pressures and their low-passes. Without any, density stays as it was."""

    def __init__(self, noise: float) -> None:
        """noise: of a sample of the differential pressure [Pa]."""
        self._noise = noise
        self._static, self._differential = LowPass(PRESSURE_TIME), LowPass(PRESSURE_TIME)
        self.density = atmosphere.RHO0
        self.pressures: Pressures | None = None
        self.fresh = False
        """Whether they are new in this cycle."""
        self._taken = -1.0  # s
        self._smooth: float | None = None  # m/s

    def take(self, pressures: Pressures | None, t: float, dt: float) -> None:
        """Takes the pressures of the cycle at ``t`` [s], ``dt`` [s] after the last."""
        self.pressures = pressures
        self.fresh = False
        if pressures is None:
            self._smooth = None
            return
        taken = t - pressures.age
        self.fresh, self._taken = taken > self._taken + 1e-6, taken
        self.density = atmosphere.density(self._static.step(pressures.static, dt), pressures.temperature)
        self._differential.step(pressures.differential, dt)

    def airspeed(self, bias: float) -> float:
        """True airspeed [m/s]; bias of the differential pressure [Pa]."""
        return atmosphere.airspeed((self._differential.value or 0.0) - bias, self.density)

    def smooth(self, bias: float, gained: float, walk: float, dt: float) -> float:
        """True airspeed [m/s] without the pressures' noise: a complementary filter of them and ``gained`` [m/s^2] along the airspeed.

        bias: of the differential pressure [Pa]; walk: of the wind along the flight [m/s/sqrt(s)]; dt: [s] since the last call. The time
        constant is a multiple of the noise over the walk, which is that of the steady Kalman filter: in calm air the noise is kept out,
        in turbulence gusts are let through.
        """
        measured = self.airspeed(bias)
        if self._smooth is None:
            self._smooth = measured
        noise = self._noise / (self.density * max(measured, SLOWEST))
        share = 1 - math.exp(-dt * walk / (SMOOTHER * noise * math.sqrt(dt)))
        self._smooth += gained * dt + share * (measured - self._smooth)
        return self._smooth
