"""One cycle of the loops and what several of them need of it."""

import math
from dataclasses import dataclass
from functools import cached_property

from services.autopilot.air.params import AirParams
from services.autopilot.air.state import Estimate
from uvf.maths.atmosphere import RHO0
from uvf.maths.geodesy import GRAVITY

FULL_BANK = 1.2  # rad; beyond it load factors are not compensated


def clip(value: float, limit: float) -> float:
    return min(max(value, -limit), limit)


@dataclass(frozen=True)
class Cycle:
    """The estimate and the parameters of now, and what follows from them."""

    now: Estimate
    params: AirParams
    dt: float  # s

    @cached_property
    def speed(self) -> float:
        """m/s true airspeed, not so low that it makes no sense to divide by it."""
        return max(self.now.airspeed, 0.5 * self.params.trim_airspeed)

    @cached_property
    def eas(self) -> float:
        """m/s."""
        return self.speed * math.sqrt(self.now.density / RHO0)

    @cached_property
    def scale(self) -> float:
        """Dynamic pressure at the trim airspeed over that of now."""
        return (self.params.trim_airspeed / self.eas) ** 2

    @cached_property
    def load(self) -> float:
        """Load factor of a level turn with this bank."""
        return 1 / math.cos(clip(self.now.roll, FULL_BANK))

    @cached_property
    def alpha(self) -> float:
        """rad, the angle of attack that carries this load."""
        return self.params.alpha_zero_lift + self.params.alpha_per_load * self.load * GRAVITY / self.eas**2
