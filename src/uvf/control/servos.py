"""What the servos of an aircraft reach, and integrators that wait for them."""

import math
from dataclasses import dataclass

from uvf.control.cycle import clip
from uvf.maths.filters import Integral

TRIM_SHARE = 0.45  # of a surface's way that its integrator may take


@dataclass(frozen=True)
class ServoLimits:
    """Deflection and rate limit of a surface."""

    limit: float  # rad
    rate: float = math.inf  # rad/s, the same to both sides
    negative_limit: float | None = None  # rad; None: ``limit``

    @property
    def lowest(self) -> float:
        """The most negative deflection [rad]."""
        return -(self.limit if self.negative_limit is None else self.negative_limit)

    def within(self, deflection: float) -> float:
        """The nearest deflection [rad] within the stops."""
        return min(max(deflection, self.lowest), self.limit)

    def share(self, deflection: float) -> float:
        """Of the way to the stop, -1 to 1; 0 where there is no such surface."""
        full = self.limit if deflection >= 0 else -self.lowest
        return min(max(deflection / full, -1.0), 1.0) if full else 0.0


@dataclass(frozen=True)
class Servos:
    """Limits of the surfaces that the loops move; the flap goes from 0 down to its limit."""

    aileron: ServoLimits
    elevator: ServoLimits
    rudder: ServoLimits
    flap: ServoLimits = ServoLimits(0.0)


SERVOS = Servos(ServoLimits(0.35), ServoLimits(0.35), ServoLimits(0.35))
"""Of an aircraft that says nothing."""


class SurfaceTrim:
    """Integrator of one surface with anti-windup: it waits while the surface is at a stop or the servo lags, and it would push further."""

    def __init__(self, servo: ServoLimits) -> None:
        self._servo = servo
        self._trim = Integral(TRIM_SHARE * min(servo.limit, -servo.lowest))
        self._reached: float | None = None  # rad, where the servo is at best

    @property
    def value(self) -> float:
        """Value of the integrator [rad]."""
        return self._trim.value

    def step(self, moving: float, effect: float, rate: float, dt: float) -> float:
        """Deflection [rad] to command: ``moving`` [rad] plus the integrator times ``effect`` [-], limited to the stops.

        ``rate`` [rad/s] is the integrator's input over ``dt`` [s], unless it has to wait.
        """
        if self._lacks(moving + effect * self._trim.value, dt) * effect * rate <= 0:
            self._trim.step(rate, dt)
        return self._servo.within(moving + effect * self._trim.value)

    def _lacks(self, asked: float, dt: float) -> float:
        """rad that the surface cannot give of what is asked."""
        target, most = self._servo.within(asked), self._servo.rate * dt
        if self._reached is None or abs(target - self._reached) <= most:
            self._reached = target  # not by adding the difference, whose rounding would be taken for something that is lacking
        else:
            self._reached += clip(target - self._reached, most)
        return asked - self._reached
