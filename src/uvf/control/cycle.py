"""One cycle of the loops and what several of them need of it."""

import math
from dataclasses import dataclass
from functools import cached_property

from uvf.estimation.state import Estimate
from uvf.maths.atmosphere import RHO0
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

FULL_BANK = 1.2  # rad; beyond it load factors are not compensated
STEEPEST = 0.5  # sine of a path


def clip(value: float, limit: float) -> float:
    """``value`` limited to +-``limit``, both in one unit, e.g. [rad] or [m/s]."""
    return min(max(value, -limit), limit)


@dataclass(frozen=True)
class Cycle:
    """The estimate and the parameters of one control cycle, and the quantities that several loops derive from them."""

    now: Estimate
    params: AirParams
    dt: float  # s

    @cached_property
    def speed(self) -> float:
        """True airspeed [m/s], at least half of ``trim_airspeed``, so that it is safe to divide by."""
        return max(self.now.airspeed, 0.5 * self.params.trim_airspeed)

    @cached_property
    def eas(self) -> float:
        """Equivalent airspeed [m/s]."""
        return self.speed * math.sqrt(self.now.density / RHO0)

    @cached_property
    def scale(self) -> float:
        """Dynamic pressure at the trim airspeed over the present one [-], by which surface gains are scaled."""
        return (self.params.trim_airspeed / self.eas) ** 2

    @cached_property
    def load(self) -> float:
        """Load factor [-] of a level turn at the present bank."""
        return 1 / math.cos(clip(self.now.roll, FULL_BANK))

    @cached_property
    def alpha(self) -> float:
        """Angle of attack [rad] at which the wing carries ``load``."""
        return self.params.alpha_zero_lift + self.params.alpha_per_load * self.load * GRAVITY / self.eas**2

    @cached_property
    def load_limit(self) -> float:
        """Largest load factor [-]: what the wing carries at ``alpha_max`` at this airspeed, at most ``load_max``."""
        params = self.params
        lifted = (params.alpha_max - params.alpha_zero_lift) * self.eas**2 / (params.alpha_per_load * GRAVITY)
        return min(lifted, params.load_max)

    @cached_property
    def bank_limit(self) -> float:
        """Largest bank [rad] of a level turn within ``load_limit``: the stall speed in the turn stays below the airspeed."""
        return min(math.acos(min(1 / self.load_limit, 1.0)), self.params.bank_limit)

    @cached_property
    def slowest(self) -> float:
        """Lowest true airspeed [m/s] to ask for at the present load factor."""
        return max(self.params.min_airspeed, self.stalled)

    @cached_property
    def stalled(self) -> float:
        """True airspeed [m/s] at which the present load factor takes ``alpha_max``."""
        params = self.params
        eas = math.sqrt(params.alpha_per_load * self.load * GRAVITY / (params.alpha_max - params.alpha_zero_lift))
        return eas * self.speed / self.eas

    @cached_property
    def highest_pitch(self) -> float:
        """Pitch [rad] at which the angle of attack reaches ``alpha_max``, at most ``pitch_limit``.

        The present angle of attack is that of the lift that is felt: a kinematic one would take a downdraught for a stall.
        """
        params = self.params
        felt = params.alpha_zero_lift + params.alpha_per_load * self.now.lift / self.eas**2
        room = (params.alpha_max - felt) * math.cos(clip(self.now.roll, FULL_BANK))
        return min(self.now.pitch + room, params.pitch_limit)
