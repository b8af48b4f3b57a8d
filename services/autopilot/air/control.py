"""Successive loop closure: bank, climb and airspeed commands to surfaces and throttle.

Beard & McLain chapter 6 in its rate form: an outer loop asks for a body rate, a PI with feed-forward gives the surface.
Surface gains hold at the trim airspeed and are scaled with dynamic pressure.
"""

import math
from dataclasses import dataclass
from functools import cached_property

from services.autopilot.air.params import AirParams
from services.autopilot.air.state import Estimate
from uvf.maths.atmosphere import RHO0
from uvf.maths.filters import Integral
from uvf.maths.geodesy import GRAVITY

ROLL_RATE_LIMIT = 1.6  # rad/s
PITCH_RATE_LIMIT = 0.8  # rad/s
SURFACE_LIMIT = 0.5  # rad
TRIM_LIMIT = 0.2  # rad, of an integrator on a surface
CLIMB_TRIM_LIMIT = 0.15  # rad, of the integrator on pitch
THROTTLE_TRIM_LIMIT = 0.4
FULL_BANK = 1.2  # rad; beyond it load factors are not compensated


@dataclass(frozen=True, slots=True)
class Wanted:
    """What guidance asks for."""

    bank: float  # rad
    height: float  # m
    climb: float  # m/s, of the path
    airspeed: float  # m/s


@dataclass(frozen=True, slots=True)
class Surfaces:
    """rad with the signs of SurfaceCommand, throttle and brake 0..1."""

    aileron: float
    elevator: float
    rudder: float
    throttle: float
    flap: float = 0.0
    brake: float = 0.0


def clip(value: float, limit: float) -> float:
    return min(max(value, -limit), limit)


@dataclass(frozen=True)
class Cycle:
    """One cycle of the loops and what several of them need of it."""

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


class Control:
    """The loops and their integrators."""

    def __init__(self) -> None:
        self._roll = Integral(TRIM_LIMIT)
        self._pitch = Integral(TRIM_LIMIT)
        self._slip = Integral(TRIM_LIMIT)
        self._climb = Integral(CLIMB_TRIM_LIMIT)
        self._throttle = Integral(THROTTLE_TRIM_LIMIT)

    def step(self, now: Estimate, wanted: Wanted, params: AirParams, dt: float) -> Surfaces:
        cycle = Cycle(now, params, dt)
        climb = _climb_rate(cycle, wanted)
        pitch = self._pitch_angle(cycle, climb)
        return Surfaces(
            self._aileron(cycle, clip(wanted.bank, params.bank_limit)),
            self._elevator(cycle, pitch),
            self._rudder(cycle),
            self._throttle_setting(cycle, wanted.airspeed, climb),
        )

    def _aileron(self, cycle: Cycle, bank: float) -> float:
        now, params = cycle.now, cycle.params
        rate = clip((bank - now.roll) / params.roll_time, ROLL_RATE_LIMIT)
        error = rate - now.p
        trim = self._roll.step(params.roll_i * error, cycle.dt)
        return clip(math.sqrt(cycle.scale) * params.roll_ff * rate + cycle.scale * (params.roll_p * error + trim), SURFACE_LIMIT)

    def _pitch_angle(self, cycle: Cycle, climb: float) -> float:
        """Path angle plus the part of the angle of attack that lies in the vertical plane."""
        now, params = cycle.now, cycle.params
        error = (climb - now.climb) / cycle.speed
        trim = self._climb.step(params.climb_i * error, cycle.dt)
        path = math.asin(clip(climb / cycle.speed, 0.5))
        return clip(path + cycle.alpha * math.cos(now.roll) + params.climb_p * error + trim, params.pitch_limit)

    def _elevator(self, cycle: Cycle, pitch: float) -> float:
        now, params = cycle.now, cycle.params
        bank = clip(now.roll, FULL_BANK)
        turning = GRAVITY / cycle.speed * math.sin(bank) * math.tan(bank)  # q of a level coordinated turn
        rate = clip((pitch - now.pitch) / params.pitch_time * math.cos(bank), PITCH_RATE_LIMIT) + turning
        error = rate - now.q
        trim = self._pitch.step(params.pitch_i * error, cycle.dt)
        balance = params.elev_zero_alpha + params.elev_per_alpha * cycle.alpha
        moving = math.sqrt(cycle.scale) * params.pitch_ff * rate + cycle.scale * (params.pitch_p * error + trim)
        return clip(balance - moving, SURFACE_LIMIT)

    def _rudder(self, cycle: Cycle) -> float:
        """Damps yaw against the rate of a coordinated turn; takes out the side force slowly."""
        now, params = cycle.now, cycle.params
        turning = GRAVITY / cycle.speed * math.sin(now.roll) * math.cos(now.pitch)
        trim = self._slip.step(params.slip_i * now.side_force, cycle.dt)
        return clip(cycle.scale * (params.yaw_damping * (now.r - turning) + trim), SURFACE_LIMIT)

    def _throttle_setting(self, cycle: Cycle, wanted: float, climb: float) -> float:
        """The integrator waits while the throttle is at a stop and the error pushes it further."""
        params = cycle.params
        airspeed = min(max(wanted, params.min_airspeed), params.max_airspeed)
        error = airspeed - cycle.now.airspeed
        ahead = params.trim_throttle + params.throttle_speed * (airspeed - params.trim_airspeed)
        ahead += params.throttle_climb * climb + params.throttle_load * (cycle.load**2 - 1)
        setting = ahead + params.airspeed_p * error + self._throttle.value
        if (error > 0 and setting < 1) or (error < 0 and setting > 0):
            self._throttle.step(params.airspeed_i * error, cycle.dt)
        return min(max(setting, 0.0), 1.0)


def _climb_rate(cycle: Cycle, wanted: Wanted) -> float:
    """m/s, towards the height asked for within the limits of climb and sink."""
    params = cycle.params
    asked = wanted.climb + params.altitude_p * (wanted.height - cycle.now.height)
    return min(max(asked, -params.sink_max), params.climb_max)
