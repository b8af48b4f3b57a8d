"""Successive loop closure: bank, climb and airspeed commands to surfaces and throttle.

Beard & McLain chapter 6 in its rate form: an outer loop asks for a body rate, a PI with feed-forward gives the surface.
Surface gains hold at the trim airspeed and are scaled with dynamic pressure.
"""

import math
from dataclasses import dataclass

from services.autopilot.air.params import AirParams
from services.autopilot.air.state import Estimate
from uvf.maths.atmosphere import RHO0
from uvf.maths.filters import Integral

G = 9.80665  # m/s^2
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
    """rad with the signs of SurfaceCommand, throttle 0..1."""

    aileron: float
    elevator: float
    rudder: float
    throttle: float


def clip(value: float, limit: float) -> float:
    return min(max(value, -limit), limit)


class Control:
    """The loops and their integrators."""

    def __init__(self) -> None:
        self._roll = Integral(TRIM_LIMIT)
        self._pitch = Integral(TRIM_LIMIT)
        self._slip = Integral(TRIM_LIMIT)
        self._climb = Integral(CLIMB_TRIM_LIMIT)
        self._throttle = Integral(THROTTLE_TRIM_LIMIT)

    def step(self, now: Estimate, wanted: Wanted, params: AirParams, dt: float) -> Surfaces:
        eas = max(now.airspeed, 0.5 * params.trim_airspeed) * math.sqrt(now.density / RHO0)
        scale = (params.trim_airspeed / eas) ** 2
        climb = self._climb_rate(now, wanted, params)
        load = 1 / math.cos(clip(now.roll, FULL_BANK))
        alpha = params.alpha_zero_lift + params.alpha_per_load * load * G / eas**2
        pitch = self._pitch_angle(now, climb, alpha, params, dt)
        return Surfaces(
            self._aileron(now, clip(wanted.bank, params.bank_limit), scale, params, dt),
            self._elevator(now, pitch, alpha, scale, params, dt),
            self._rudder(now, scale, params, dt),
            self._throttle_setting(now, wanted, climb, load, params, dt),
        )

    def _aileron(self, now: Estimate, bank: float, scale: float, params: AirParams, dt: float) -> float:
        rate = clip((bank - now.roll) / params.roll_time, ROLL_RATE_LIMIT)
        error = rate - now.p
        trim = self._roll.step(params.roll_i * error, dt)
        return clip(math.sqrt(scale) * params.roll_ff * rate + scale * (params.roll_p * error + trim), SURFACE_LIMIT)

    def _climb_rate(self, now: Estimate, wanted: Wanted, params: AirParams) -> float:
        asked = wanted.climb + params.altitude_p * (wanted.height - now.height)
        return min(max(asked, -params.sink_max), params.climb_max)

    def _pitch_angle(self, now: Estimate, climb: float, alpha: float, params: AirParams, dt: float) -> float:
        """Path angle plus the part of the angle of attack that lies in the vertical plane."""
        speed = max(now.airspeed, 0.5 * params.trim_airspeed)
        error = (climb - now.climb) / speed
        trim = self._climb.step(params.climb_i * error, dt)
        pitch = math.asin(clip(climb / speed, 0.5)) + alpha * math.cos(now.roll) + params.climb_p * error + trim
        return clip(pitch, params.pitch_limit)

    def _elevator(self, now: Estimate, pitch: float, alpha: float, scale: float, params: AirParams, dt: float) -> float:
        bank = clip(now.roll, FULL_BANK)
        speed = max(now.airspeed, 0.5 * params.trim_airspeed)
        turning = G / speed * math.sin(bank) * math.tan(bank)  # q of a level coordinated turn
        rate = clip((pitch - now.pitch) / params.pitch_time * math.cos(bank), PITCH_RATE_LIMIT) + turning
        error = rate - now.q
        trim = self._pitch.step(params.pitch_i * error, dt)
        balance = params.elev_zero_alpha + params.elev_per_alpha * alpha
        return clip(balance - math.sqrt(scale) * params.pitch_ff * rate - scale * (params.pitch_p * error + trim), SURFACE_LIMIT)

    def _rudder(self, now: Estimate, scale: float, params: AirParams, dt: float) -> float:
        """Damps yaw against the rate of a coordinated turn; takes out the side force slowly."""
        speed = max(now.airspeed, 0.5 * params.trim_airspeed)
        turning = G / speed * math.sin(now.roll) * math.cos(now.pitch)
        trim = self._slip.step(params.slip_i * now.side_force, dt)
        return clip(scale * (params.yaw_damping * (now.r - turning) + trim), SURFACE_LIMIT)

    def _throttle_setting(self, now: Estimate, wanted: Wanted, climb: float, load: float, params: AirParams, dt: float) -> float:
        """The integrator waits while the throttle is at a stop and the error pushes it further."""
        airspeed = min(max(wanted.airspeed, params.min_airspeed), params.max_airspeed)
        error = airspeed - now.airspeed
        ahead = params.trim_throttle + params.throttle_speed * (airspeed - params.trim_airspeed)
        ahead += params.throttle_climb * climb + params.throttle_load * (load * load - 1)
        setting = ahead + params.airspeed_p * error + self._throttle.value
        if (error > 0 and setting < 1) or (error < 0 and setting > 0):
            self._throttle.step(params.airspeed_i * error, dt)
        return min(max(setting, 0.0), 1.0)
