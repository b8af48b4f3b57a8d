"""Whether the pressures can be believed: frozen ones, and a pitot pressure that goes neither with ground speed and wind nor with the lift.

Ground speed alone would take a front of wind for a fault; so the airspeed that the lift at this angle of attack tells of is asked too.
"""

import math
from dataclasses import dataclass, replace

from uvf.estimation.sensor_inputs import Pressures
from uvf.estimation.state import Estimate
from uvf.maths import atmosphere
from uvf.maths.filters import LowPass, RunningMean
from uvf.models.vehicle.flight_params import AirParams

FROZEN = 50  # readings that are the same to the last bit: real ones have noise
SMOOTHED = 0.5  # s, of the comparison: a gust is no fault
AGREES = 5.0  # s of agreement before the sensor is watched, and before it is believed again
WIND_TIME = 30.0  # s, behind which the wind that counts follows the one that is estimated
SHEAR, SHEAR_HEIGHT = 0.35, 20.0  # of the wind, that an aircraft may lose or meet on its way down or up; m of height for all of it
GUSTS, GUST_TIMES = 5.0, (10.0, 60.0)  # standard deviations of the comparison, as it has been of late, that are no fault; s
ROUGH_TIME = 2.0  # s of rough air that are taken for granted at first, for little time tells nothing
MOST_GUST = 2.5  # m/s, that a deviation counts for at most: a fault does not hide itself
NEVER_A_GUST = 0.85  # of the airspeed that is expected
JUMP_TIME, JUMP = 0.1, 0.15  # s within which, of trim_airspeed: no gust of a turbulence is so steep
JUMP_LASTS = 0.3  # s after which it is looked whether the lift has gone with the square of the airspeed, as it does in a front of wind
FRONT_LIFTS = 0.25  # of that: what the filter of the lift and the heaving aircraft leave of it
LIFT_FELT, LEAST_LIFT = 0.04, 3.0  # s; m/s^2, from which on it tells something
JUMP_LEFT = 0.67  # of a jump, that counts as the limit until the sensor agrees again
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


class JumpWatch:
    """Looks for a reading of airspeed that jumps while neither the ground velocity nor the lift does: gusts cannot hide that."""

    def __init__(self) -> None:
        self._measured, self._gap, self._lift = LowPass(JUMP_TIME), LowPass(JUMP_TIME), LowPass(LIFT_FELT)
        self._from: tuple[float, float, float] | None = None
        self._felt: list[float] = []
        self._left = 0.0  # s

    def step(self, measured: float, gap: float, lift: float, least: float, dt: float) -> float:
        """The jump [m/s] that has just been found to be a fault, 0 for none.

        Airspeed [m/s] and its gap to the one expected [m/s], lift [m/s^2]; ``least`` [m/s] that is a jump.
        """
        last, last_gap, carried = self._measured.value, self._gap.value, self._lift.value
        speed, gap, lift = self._measured.step(measured, dt), self._gap.step(gap, dt), self._lift.step(lift, dt)
        if self._from is not None:
            self._felt.append(lift)
            self._left -= dt
            return self._fault(speed, gap, least) if self._left <= 0.0 else 0.0
        if last is not None and last_gap is not None and carried is not None and abs(measured - last) > least:
            self._from, self._felt, self._left = (last, last_gap, carried), [lift], JUMP_LASTS
        return 0.0

    def _fault(self, speed: float, gap: float, least: float) -> float:
        assert self._from is not None
        (last, last_gap, carried), self._from = self._from, None
        jump = gap - last_gap
        if abs(jump) < least or carried < LEAST_LIFT:
            return 0.0
        of_front = (speed / max(last, least)) ** 2 - 1.0
        felt = (max(self._felt) if jump > 0 else min(self._felt)) / carried - 1.0
        return jump if felt * of_front < FRONT_LIFTS * of_front**2 else 0.0


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
        self._power = [RunningMean(time, MOST_GUST**2, ROUGH_TIME) for time in GUST_TIMES]  # m^2/s^2
        self._jumps = JumpWatch()
        self._wind: tuple[float, float] | None = None
        self._wind_height = 0.0  # m
        self._limit = 0.0  # m/s
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
        self.gap, self._limit, self._agreed, self._watched, self._wind = 0.0, 0.0, 0.0, False, None
        self._jumps = JumpWatch()

    def _checked(self, pressures: Pressures, flying: FlightState, params: AirParams, dt: float) -> Pressures:
        now = flying.now
        density = atmosphere.density(pressures.static, pressures.temperature)
        if flying.gnss_age > UNFIXED:
            expected = params.trim_airspeed
            self._jumps = JumpWatch()  # what was before the gap is no beginning of a jump
        else:
            expected = self._expected(now, dt)
            measured = atmosphere.airspeed(pressures.differential, density)
            gap, lifted = self._smoothed.step(measured - expected, dt), lift_airspeed(now, params)
            if lifted is not None:
                self._by_lift.step(measured - lifted, dt)
            jump = self._jumps.step(measured, measured - expected, now.lift, JUMP * params.trim_airspeed, dt)
            if not self.gap:
                allowed = self._gusts(gap, expected, params, dt) + self._shear(now.height)
                self._limit = JUMP_LEFT * abs(jump) if jump else allowed
            self._judge(gap, jump, params, dt)
        return replace(pressures, differential=0.5 * density * expected**2) if self.gap else pressures

    def _expected(self, now: Estimate, dt: float) -> float:
        """m/s, of the ground velocity less the wind as it was while the sensor was right."""
        wind = (now.wind_north, now.wind_east)
        if self._wind is None or not self._watched:
            self._wind, self._wind_height = wind, now.height
        elif not self.gap:
            part = dt / WIND_TIME
            self._wind = tuple(w + part * (new - w) for w, new in zip(self._wind, wind, strict=True))  # type: ignore[assignment]
            self._wind_height += part * (now.height - self._wind_height)
        wn, we = self._wind  # type: ignore[misc]
        north, east = now.ground_speed * math.cos(now.course) - wn, now.ground_speed * math.sin(now.course) - we
        return math.hypot(north, east, now.climb)

    def _gusts(self, gap: float, expected: float, params: AirParams, dt: float) -> float:
        """m/s, up to which a gap may be gusts.

        They are known from the mean of their squares, of the last minute or of the last seconds: whichever air was rougher.
        """
        for power in self._power:
            power.step(min(abs(gap), MOST_GUST) ** 2, dt)
        least = params.airspeed_gap * params.trim_airspeed
        return max(least, min(GUSTS * math.sqrt(max(power.value for power in self._power)), NEVER_A_GUST * expected))

    def _shear(self, height: float) -> float:
        """m/s, that the wind may be other at this height [m] than at the one where it was met."""
        share = min(abs(height - self._wind_height) / SHEAR_HEIGHT, 1.0)
        return SHEAR * share * math.hypot(*self._wind or (0.0, 0.0))

    def _judge(self, gap: float, jump: float, params: AirParams, dt: float) -> None:
        """Believed until off by more than the limit, and by the lift too, jumps or stands still; again after 5 s within half of it."""
        against = abs(self._by_lift.value or 0.0) > LIFT_SHARE * params.trim_airspeed
        jumped = bool(jump) and not self.gap  # once it is not believed, a jump is that back
        agrees = abs(gap) < 0.5 * self._limit and not self._frozen[1] and not jumped
        self._agreed = self._agreed + dt if agrees else 0.0
        if self._agreed > AGREES:
            self._watched, self.gap = True, 0.0
        elif self._watched and (jumped or (abs(gap) > self._limit and (against or self.gap)) or self._frozen[1]):
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
