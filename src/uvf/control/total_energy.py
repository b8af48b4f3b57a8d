"""The outer level of control: height or climb rate, and airspeed, to pitch and throttle, by their total energy.

After A. A. Lambregts, "Vertical flight path and speed control autopilot design using total energy principles", AIAA 83-2239:
the throttle makes total energy, climb + V V' / g (here in m/s of climb), pitch shares it out between path and speed. What the
throttle does not explain of the power is learnt by an observer in place of an integrator: it sees the throttle that was really set,
so nothing winds up at its stops.

Pitch holds the path, for gusts would shake it through the airspeed, as long as throttle makes the energy that path and airspeed need
together. What it cannot make is taken from the airspeed for a while, then from the path: in a long climb, or with the motor dead,
the airspeed comes first. An aircraft without an engine (``throttle_climb`` 0) always glides so.
"""

import math
from dataclasses import dataclass

from uvf.control.commands import AltitudeAirspeedSetpoint
from uvf.control.cycle import FULL_BANK, STEEPEST, Cycle, clip
from uvf.estimation.state import Estimate
from uvf.maths.filters import Integral
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

CLIMB_TRIM_LIMIT = 0.35  # rad, of the integrator on pitch: as much as an updraught tilts the path, even at the lowest airspeed
FADES, HANDED_OVER = 1.0, 0.005  # s, in which pitch goes over to what the path takes; rad of it that is left when trim is learnt again
ACCELERATION_LIMIT = 2.0  # m/s^2 asked for
TOO_SLOW = 0.95  # of the slowest airspeed asked for: no climb and full throttle
LEAST_SLOPE = 1e-3  # s/m, of throttle per climb


class PowerObserver:
    """Estimates the power besides that of the throttle, as a climb rate [m/s], from the kinetic energy: an observer with a double pole."""

    def __init__(self) -> None:
        self.unexplained = 0.0
        self._height: float | None = None  # m, of the kinetic energy

    def step(self, cycle: Cycle, throttle: float) -> None:
        """Takes one cycle that was flown with ``throttle`` [0..1]."""
        pole, now = cycle.params.power_pole, cycle.now
        height = now.airspeed**2 / (2 * GRAVITY)
        before = height if self._height is None else self._height
        error = height - before
        self._height = before + (made(cycle, throttle) + self.unexplained - now.climb + 2 * pole * error) * cycle.dt
        self.unexplained += pole**2 * error * cycle.dt


@dataclass(frozen=True, slots=True)
class Power:
    """Specific power asked for, as climb rates [m/s]."""

    climb: float
    faster: float  # V V' / g
    reached: float  # the climb, as far as throttle can make both
    in_turn: float  # the same in the turn that is asked for: its bank gives way for no more than this


class EnergyLoops:
    """Total energy control of path and airspeed, with its integrator and power observer."""

    def __init__(self) -> None:
        self._trim = Integral(CLIMB_TRIM_LIMIT)
        self._handed_over = 0.0  # rad of pitch, of what was flown before; it fades
        self._power = PowerObserver()
        self._throttle: float | None = None
        self.lacking = 0.0

    def begin(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint, pitch: float, throttle: float) -> None:
        """Sets the observer, and what fades, so that the first step asks for ``pitch`` [rad] and ``throttle`` [0..1], within limits."""
        self._power, self._trim.value, self._throttle, self._handed_over = PowerObserver(), 0.0, None, 0.0
        if wanted.throttle is None:
            asked = self._asked(cycle, wanted)
            level = level_throttle(cycle, self._airspeed(cycle, wanted))
            self._power.unexplained = asked.climb + asked.faster - (throttle - level) / _slope(cycle)
        self._handed_over = pitch - self._pitch(cycle, self._asked(cycle, wanted).reached)

    def step(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint) -> tuple[float, float]:
        """Pitch [rad], which the inner loop limits, and throttle [0..1] for one cycle."""
        if self._throttle is not None:
            self._power.step(cycle, self._throttle)
        asked = self._asked(cycle, wanted)
        self.lacking = asked.in_turn - cycle.now.climb
        pitch, error = self._pitch(cycle, asked.reached), (asked.reached - cycle.now.climb) / cycle.speed
        higher = cycle.now.pitch < cycle.highest_pitch
        lower = pitch > wanted.lowest_pitch and cycle.now.pitch > -cycle.params.pitch_limit
        settled = abs(self._handed_over) < HANDED_OVER
        if settled and ((error > 0 and higher) or (error < 0 and lower)):
            self._trim.step(cycle.params.climb_i * error, cycle.dt)
        self._handed_over -= self._handed_over * min(cycle.dt / FADES, 1.0)
        level = level_throttle(cycle, self._airspeed(cycle, wanted))
        setting = level + _slope(cycle) * (asked.climb + asked.faster - self._power.unexplained)
        free = min(max(setting, 1 - _room(cycle)), 1.0) if cycle.params.throttle_climb else 0.0
        self._throttle = free if wanted.throttle is None else wanted.throttle
        return max(clip(pitch, math.pi / 2), wanted.lowest_pitch), self._throttle

    def _asked(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint) -> Power:
        """Within what throttle can reach: full, the airspeed comes before the path; idling or given, the highest airspeed does.

        With a given throttle the path is not given up for airspeed: it is closed to land, and then airspeed is what has to go.
        """
        params = cycle.params
        faster = _acceleration(cycle, self._airspeed(cycle, wanted) - cycle.now.airspeed, params.airspeed_p)
        higher = 0.0 if wanted.height is None else wanted.height - cycle.now.height
        climb = min(max(wanted.climb + params.altitude_p * higher, -params.sink_max), params.climb_max * _room(cycle))
        reached = min(max(climb, self._least(cycle, wanted)), self._most(cycle, wanted, cycle.load))
        turn = max(cycle.load, 1 / math.cos(min(abs(wanted.bank), cycle.bank_with(0.0), FULL_BANK)))
        return Power(climb, faster, reached, max(min(reached, self._most(cycle, wanted, turn)), min(reached, 0.0)))

    def _most(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint, load: float) -> float:
        """m/s, the climb that full throttle makes with a load factor [-] while pitch holds the airspeed, less what may be lent."""
        params, full = cycle.params, made(cycle, 1.0) + self._power.unexplained
        drag = params.throttle_load * (load**2 - cycle.load**2) / _slope(cycle) if params.throttle_climb else 0.0
        slowest = min(cycle.slowest_with(load), params.max_airspeed)
        return full - drag - _exchanged(cycle, max(self._airspeed(cycle, wanted), slowest) - _lent(cycle, wanted, slowest))

    def _least(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint) -> float:
        """m/s, the climb that is left with an idling engine, or with the throttle that is given, at the highest airspeed."""
        params, spare = cycle.params, cycle.params.max_airspeed - cycle.now.airspeed
        gain = params.airspeed_pitch_p if spare > 0 else params.airspeed_p
        return made(cycle, wanted.throttle or 0.0) + self._power.unexplained - _acceleration(cycle, spare, gain)

    def _pitch(self, cycle: Cycle, climb: float) -> float:
        """rad: path angle plus the part of the angle of attack that lies in the vertical plane."""
        path = math.asin(clip(climb / cycle.speed, STEEPEST))
        error = (climb - cycle.now.climb) / cycle.speed
        return path + cycle.alpha * math.cos(cycle.now.roll) + cycle.params.climb_p * error + self._trim.value + self._handed_over

    @staticmethod
    def _airspeed(cycle: Cycle, wanted: AltitudeAirspeedSetpoint) -> float:
        return min(max(wanted.airspeed, cycle.slowest), cycle.params.max_airspeed)


def _acceleration(cycle: Cycle, error: float, gain: float) -> float:
    """m/s, the power V V' / g that takes out this error of airspeed [m/s]; gain: [1/s]."""
    return cycle.speed / GRAVITY * clip(gain * error, ACCELERATION_LIMIT)


def _exchanged(cycle: Cycle, airspeed: float) -> float:
    """m/s of climb that goes into this airspeed [m/s] where only pitch can make it: slowly, for pitch must not follow the gusts."""
    return _acceleration(cycle, airspeed - cycle.now.airspeed, cycle.params.airspeed_pitch_p)


def _lent(cycle: Cycle, wanted: AltitudeAirspeedSetpoint, slowest: float) -> float:
    """m/s of airspeed that a climb may take beyond full throttle, for a while: at most half of what is above the ``slowest``.

    The lower it is already, the less, and none from where that airspeed is worth no more height: so a downdraught
    is flown through on the path, while a long climb and a glide come back to the airspeed asked for.
    """
    spare = wanted.airspeed - slowest
    if wanted.height is None or spare <= 0:
        return 0.0
    worth = (wanted.airspeed**2 - slowest**2) / (2 * GRAVITY)
    return spare / 2 * min(max(1 - (wanted.height - cycle.now.height) / worth, 0.0), 1.0)


def _room(cycle: Cycle) -> float:
    """0 when it flies too slow, 1 from the slowest airspeed on that is asked for."""
    return min(max((cycle.now.airspeed / cycle.slowest - TOO_SLOW) / (1 - TOO_SLOW), 0.0), 1.0)


def _slope(cycle: Cycle) -> float:
    return max(cycle.params.throttle_climb, LEAST_SLOPE)


def level_throttle(cycle: Cycle, airspeed: float) -> float:
    """Throttle [-] of level flight at ``airspeed`` [m/s] and the present load factor, not limited to 0..1."""
    params = cycle.params
    return params.trim_throttle + params.throttle_speed * (airspeed - params.trim_airspeed) + params.throttle_load * (cycle.load**2 - 1)


def made(cycle: Cycle, throttle: float) -> float:
    """Climb rate [m/s] that ``throttle`` [0..1] makes beyond level flight at the present airspeed: linear, down to ``idle_sink``.

    Below that less throttle brakes no more. Believing otherwise the observer would take an idling motor for a strong one.
    """
    if not cycle.params.throttle_climb:
        return -cycle.params.idle_sink
    return max((throttle - level_throttle(cycle, cycle.speed)) / _slope(cycle), -cycle.params.idle_sink)


def climb_at(now: Estimate, params: AirParams) -> float:
    """Climb rate [m/s] that full throttle may be spent on: ``climb_max`` from cruise on, falling to 0 at the lowest airspeed."""
    spare = (now.airspeed - params.min_airspeed) / (params.trim_airspeed - params.min_airspeed)
    return params.climb_max * min(max(spare, 0.0), 1.0)
