"""Whether the pressures can be believed: frozen ones, and a pitot pressure that goes neither with ground speed and wind nor with the lift.

Ground speed alone would take a front of wind for a fault; so the airspeed that the lift at this angle of attack tells of is asked too.
"""

import math
from dataclasses import dataclass, replace

from uvf.estimation.sensor_inputs import Pressures
from uvf.estimation.state import Estimate
from uvf.maths import atmosphere
from uvf.maths.filters import LowPass
from uvf.models.vehicle.flight_params import AirParams

FROZEN = 50  # readings that are the same to the last bit: real ones have noise
SMOOTHED = 0.5  # s, of the comparison: a gust is no fault
AGREES = 5.0  # s of agreement before the sensor is watched, and before it is believed again
WIND_TIME = 30.0  # s, behind which the wind that counts follows the one that is estimated
SHEAR = 0.35  # of the wind, that an aircraft may lose or meet on its way down or up: no fault of a sensor
GUSTS, GUST_TIMES = 5.0, (10.0, 60.0)  # standard deviations of the comparison, as it has been of late, that are no fault; s
ROUGH_TIME = 2.0  # s of rough air that are taken for granted at first, for little time tells nothing
MOST_GUST = 2.5  # m/s, that a deviation counts for at most: a fault does not hide itself
NEVER_A_GUST = 0.85  # of the airspeed that is expected
LIFT_TIME = 2.0  # s, of the comparison with the lift: updraughts turn the angle of attack
LIFT_SHARE = 0.15  # of trim_airspeed, from which on the lift contradicts too
LEAST_ALPHA, MOST_BANK = 0.03, 0.9  # rad, over that of no lift; rad: within these the lift tells the airspeed
UNFIXED = 2.0  # s without a fix: nothing to compare with


class Frozen:
    """Counts how often a value has come again unchanged."""

    def __init__(self) -> None:
        self._last: object = None
        self._times = 0

    def same(self, value: object, limit: int) -> bool:
        """Whether this new reading is the ``limit``-th repetition of the same value, or a later one."""
        self._times = self._times + 1 if value == self._last else 0
        self._last = value
        return self._times >= limit


@dataclass(frozen=True, slots=True)
class FlightState:
    """The last estimate, and how far it can be relied on."""

    now: Estimate
    gnss_age: float  # s
    airborne: bool


class GustPower:
    """Mean square of gusts, of all that has been flown and after ``time`` [s] of about as long ago as that."""

    def __init__(self, time: float) -> None:
        self.mean = MOST_GUST**2  # m^2/s^2
        self._time, self._known = time, ROUGH_TIME

    def step(self, gust: float, dt: float) -> None:
        """Takes a gust [m/s] that was met for ``dt`` [s]."""
        self._known = min(self._known + dt, self._time)
        self.mean += dt / self._known * (min(gust, MOST_GUST) ** 2 - self.mean)


class AirDataCheck:
    """Passes on the pressures that can be believed; replaces a pitot pressure that cannot by that of ground speed and wind."""

    def __init__(self) -> None:
        self.gap = 0.0
        """m/s, measured less expected airspeed while the sensor is not believed; 0 while it is."""
        self._static, self._pitot = Frozen(), Frozen()
        self._stamp: object = None
        self._frozen = (False, False)
        self._smoothed = LowPass(SMOOTHED)
        self._by_lift = LowPass(LIFT_TIME)
        self._power = [GustPower(time) for time in GUST_TIMES]
        self._wind: tuple[float, float] | None = None
        self._agreed = 0.0  # s
        self._watched = False

    def step(self, read: tuple[object, Pressures] | None, flying: FlightState | None, params: AirParams, dt: float) -> Pressures | None:
        """The pressures as far as they can be believed; None where neither height nor airspeed can be taken from them.

        ``read``: stamp and pressures [Pa, K] of the newest reading, None without one; ``flying``: None before the first estimate;
        ``dt`` [s] since the last cycle. Pressures are only checked in the air.
        """
        if read is None or flying is None or not flying.airborne:
            self._forget()
            return read[1] if read is not None else None
        stamp, pressures = read
        if stamp != self._stamp:
            self._stamp = stamp
            self._frozen = self._static.same(pressures.static, FROZEN), self._pitot.same(pressures.differential, FROZEN)
        if self._frozen[0]:
            return None
        return self._checked(pressures, flying, params, dt)

    def _forget(self) -> None:
        self.gap, self._agreed, self._watched, self._wind = 0.0, 0.0, False, None

    def _checked(self, pressures: Pressures, flying: FlightState, params: AirParams, dt: float) -> Pressures:
        now = flying.now
        density = atmosphere.density(pressures.static, pressures.temperature)
        if flying.gnss_age > UNFIXED:
            expected = params.trim_airspeed
        else:
            expected = self._expected(now, dt)
            measured = atmosphere.airspeed(pressures.differential, density)
            gap = self._smoothed.step(measured - expected, dt)
            if (lifted := lift_airspeed(now, params)) is not None:
                self._by_lift.step(measured - lifted, dt)
            self._judge(gap, self._limit(gap, expected, params, dt), params, dt)
        return replace(pressures, differential=0.5 * density * expected**2) if self.gap else pressures

    def _expected(self, now: Estimate, dt: float) -> float:
        """m/s, of the ground velocity less the wind as it was while the sensor was right."""
        wind = (now.wind_north, now.wind_east)
        if self._wind is None or not self._watched:
            self._wind = wind
        elif not self.gap:
            part = dt / WIND_TIME
            self._wind = tuple(w + part * (new - w) for w, new in zip(self._wind, wind, strict=True))  # type: ignore[assignment]
        wn, we = self._wind  # type: ignore[misc]
        north, east = now.ground_speed * math.cos(now.course) - wn, now.ground_speed * math.sin(now.course) - we
        return math.hypot(north, east, now.climb)

    def _limit(self, gap: float, expected: float, params: AirParams, dt: float) -> float:
        """m/s, up to which it may be gusts and a wind that differs from place to place.

        Gusts are known from the mean of their squares, of the last minute or of the last seconds: whichever air was rougher.
        """
        least = params.airspeed_gap * params.trim_airspeed
        if not self.gap:
            for power in self._power:
                power.step(abs(gap), dt)
        gusts = min(GUSTS * math.sqrt(max(power.mean for power in self._power)), NEVER_A_GUST * expected)
        return max(least, gusts) + SHEAR * math.hypot(*self._wind or (0.0, 0.0))

    def _judge(self, gap: float, limit: float, params: AirParams, dt: float) -> None:
        """Believed until off by more than ``limit`` [m/s], and by the lift too, or stands still; again after 5 s within half of it."""
        against = abs(self._by_lift.value or 0.0) > LIFT_SHARE * params.trim_airspeed
        agrees = abs(gap) < 0.5 * limit and not self._frozen[1]
        self._agreed = self._agreed + dt if agrees else 0.0
        if self._agreed > AGREES:
            self._watched, self.gap = True, 0.0
        elif self._watched and ((abs(gap) > limit and (against or self.gap)) or self._frozen[1]):
            self.gap = gap or math.ulp(1.0)


def lift_airspeed(now: Estimate, params: AirParams) -> float | None:
    """True airspeed [m/s] at which the present angle of attack carries the present lift; None where that tells nothing.

    The angle of attack is that between pitch and path, in air that does not rise or sink.
    """
    path = math.asin(min(max(now.climb / max(now.airspeed, 0.5 * params.trim_airspeed), -0.5), 0.5))
    alpha = (now.pitch - path) / math.cos(min(abs(now.roll), MOST_BANK)) - params.alpha_zero_lift
    if alpha < LEAST_ALPHA or abs(now.roll) > MOST_BANK or now.lift <= 0:
        return None
    return math.sqrt(params.alpha_per_load * now.lift / alpha * atmosphere.RHO0 / now.density)
