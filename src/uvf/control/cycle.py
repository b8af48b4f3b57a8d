"""One cycle of the loops and what several of them need of it."""

import math

from uvf.estimation.state import Estimate
from uvf.maths.atmosphere import RHO0
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

FULL_BANK = 1.2  # rad; beyond it load factors are not compensated
STEEPEST = 0.5  # sine of a path
LEAST = 1e-6  # of what is divided by: parameters that make no wing must not end the autopilot


def clip(value: float, limit: float) -> float:
    """``value`` within +-``limit``, both in the same unit, as [rad] or [-]."""
    return min(max(value, -limit), limit)


class Cycle:
    """The estimate and the parameters of a cycle of ``dt`` [s], and what follows from them, computed once for all loops."""

    def __init__(self, now: Estimate, params: AirParams, dt: float) -> None:
        self.now, self.params, self.dt = now, params, dt
        self.speed = max(now.airspeed, 0.5 * params.trim_airspeed)
        """True airspeed [m/s], not so low that it makes no sense to divide by it."""
        self.eas = self.speed * math.sqrt(now.density / RHO0)
        """Equivalent airspeed [m/s]."""
        self.scale = (params.trim_airspeed / self.eas) ** 2
        """Dynamic pressure at the trim airspeed over that of now [-]."""
        roll = clip(now.roll, FULL_BANK)
        self.load = 1 / math.cos(roll)
        """Load factor [-] of a level turn with this bank."""
        self.alpha = self.alpha_with(self.load)
        """Angle of attack [rad] that carries this load."""
        self.lift_time = max(params.alpha_per_load * self.speed / self.eas**2, LEAST)
        """V / L_alpha [s]: how late the path turns after the angle of attack."""
        lifting, per_load = max(params.alpha_max - params.alpha_zero_lift, LEAST), max(params.alpha_per_load, LEAST)
        lifted = lifting * self.eas**2 / (per_load * GRAVITY)
        self.load_limit = min(lifted, params.load_max)
        """Load factor [-] that the wing carries at ``alpha_max`` now, and no more than ``load_max``."""
        self._stalled = math.sqrt(per_load * GRAVITY / lifting) * self.speed / self.eas
        self.stalled = self._stalled * math.sqrt(self.load)
        """True airspeed [m/s] at which the load of now takes ``alpha_max``."""
        self.slowest = self.slowest_with(self.load)
        """The lowest airspeed [m/s] to ask for with the load of now."""
        self.alpha_felt = params.alpha_zero_lift + params.alpha_per_load * now.lift / self.eas**2
        """Angle of attack [rad] of the lift that is felt."""
        self.highest_pitch = min(now.pitch + (params.alpha_max - self.alpha_felt) * math.cos(roll), params.pitch_limit)
        """Pitch [rad] at which the angle of attack will be ``alpha_max``, and no more than ``pitch_limit``.

        The angle of attack of now is that of the lift that is felt: a kinematic one would take a downdraught for a stall.
        """

    def alpha_with(self, load: float) -> float:
        """Angle of attack [rad] that carries a load factor [-]."""
        return self.params.alpha_zero_lift + self.params.alpha_per_load * load * GRAVITY / self.eas**2

    def slowest_with(self, load: float) -> float:
        """The lowest airspeed [m/s] to ask for with a load factor [-]."""
        return max(self.params.min_airspeed, self._stalled * math.sqrt(load))

    def bank_with(self, upward: float) -> float:
        """Most bank [rad] at which ``load_limit`` leaves lift for an acceleration upward [m/s^2], too.

        Without one it is that of a level turn: the stall speed in the turn stays below the airspeed.
        """
        return min(math.acos(min((1 + upward / GRAVITY) / self.load_limit, 1.0)), self.params.bank_limit)
