"""The outer level of control: height or climb rate, and airspeed, to pitch and throttle."""

import math

from services.autopilot.air.commands import Wanted
from services.autopilot.air.cycle import Cycle, clip
from services.autopilot.air.params import AirParams
from services.autopilot.air.state import Estimate
from uvf.maths.filters import Integral

CLIMB_TRIM_LIMIT = 0.15  # rad, of the integrator on pitch
THROTTLE_TRIM_LIMIT = 0.4


class PathLoops:
    """Climb and airspeed with their integrators."""

    def __init__(self) -> None:
        self._climb = Integral(CLIMB_TRIM_LIMIT)
        self._throttle = Integral(THROTTLE_TRIM_LIMIT)

    def begin(self, cycle: Cycle, wanted: Wanted, pitch: float, throttle: float) -> None:
        """The integrators start so that the first step asks for this pitch [rad] and throttle, as far as their limits allow."""
        self._climb.value = self._throttle.value = 0.0
        climb = climb_rate(cycle, wanted)
        self._climb.value = clip(pitch - self._pitch_angle(cycle, climb), CLIMB_TRIM_LIMIT)
        self._throttle.value = clip(throttle - self._setting(cycle, self._airspeed(cycle, wanted), climb), THROTTLE_TRIM_LIMIT)

    def step(self, cycle: Cycle, wanted: Wanted) -> tuple[float, float]:
        """Pitch [rad] and throttle."""
        climb = climb_rate(cycle, wanted)
        error = (climb - cycle.now.climb) / cycle.speed
        self._climb.step(cycle.params.climb_i * error, cycle.dt)
        return self._pitch_angle(cycle, climb), self._throttle_setting(cycle, wanted, climb)

    def _pitch_angle(self, cycle: Cycle, climb: float) -> float:
        """Path angle plus the part of the angle of attack that lies in the vertical plane."""
        now, params = cycle.now, cycle.params
        error = (climb - now.climb) / cycle.speed
        path = math.asin(clip(climb / cycle.speed, 0.5))
        return clip(path + cycle.alpha * math.cos(now.roll) + params.climb_p * error + self._climb.value, params.pitch_limit)

    def _throttle_setting(self, cycle: Cycle, wanted: Wanted, climb: float) -> float:
        """The integrator waits while the throttle is at a stop and the error pushes it further."""
        airspeed = self._airspeed(cycle, wanted)
        error = airspeed - cycle.now.airspeed
        setting = self._setting(cycle, airspeed, climb)
        if (error > 0 and setting < 1) or (error < 0 and setting > 0):
            self._throttle.step(cycle.params.airspeed_i * error, cycle.dt)
        return min(max(setting, 0.0), 1.0)

    def _setting(self, cycle: Cycle, airspeed: float, climb: float) -> float:
        params = cycle.params
        ahead = params.trim_throttle + params.throttle_speed * (airspeed - params.trim_airspeed)
        ahead += params.throttle_climb * climb + params.throttle_load * (cycle.load**2 - 1)
        return ahead + params.airspeed_p * (airspeed - cycle.now.airspeed) + self._throttle.value

    @staticmethod
    def _airspeed(cycle: Cycle, wanted: Wanted) -> float:
        return min(max(wanted.airspeed, cycle.params.min_airspeed), cycle.params.max_airspeed)


def climb_rate(cycle: Cycle, wanted: Wanted) -> float:
    """m/s, towards the height asked for, if one is, within the limits of climb and sink."""
    params = cycle.params
    higher = 0.0 if wanted.height is None else wanted.height - cycle.now.height
    return min(max(wanted.climb + params.altitude_p * higher, -params.sink_max), params.climb_max)


def climb_at(now: Estimate, params: AirParams) -> float:
    """m/s that full throttle may be spent on: the fastest climb at cruise, none at the lowest airspeed."""
    spare = (now.airspeed - params.min_airspeed) / (params.trim_airspeed - params.min_airspeed)
    return params.climb_max * min(max(spare, 0.0), 1.0)
