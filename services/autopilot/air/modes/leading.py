"""How an aircraft flies that others follow: it leaves them a reserve of airspeed and of bank."""

import math
from dataclasses import replace

import msgspec

from services.autopilot.air.setpoints import PathSetpoint, Setpoint
from uvf.estimation.state import Estimate
from uvf.models.vehicle.flight_params import AirParams

WIND_TIME = 60.0  # s, over which the wind is averaged
BANK_SHARE = 0.95  # of bank_limit, in a follower's turn: the rest is for keeping to the trail


def reserved(params: AirParams) -> AirParams:
    """Turns that a follower can fly at its highest airspeed: tan(bank) grows with the square of the speed (Beard & McLain 9.3.2)."""
    steepest = math.tan(BANK_SHARE * params.bank_limit) * (params.trim_airspeed / params.max_airspeed) ** 2
    return msgspec.structs.replace(params, turn_bank=min(params.turn_bank, math.atan(steepest)))


class LeaderSpeedFilter:
    """The speed held is the one through the mean wind; gusts pass.

    A leader that answered each gust would change its speed over ground, and its followers, who meet gusts of their own, would have to
    fly the difference of both: their airspeeds would leave their limits.
    """

    def __init__(self) -> None:
        self._north = self._east = 0.0  # m/s, mean wind
        self._known = 0.0  # s

    def step(self, wish: Setpoint, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """The wish with the airspeed of now that the speed asked for means."""
        self._average(now, dt)
        asked = wish.asked
        if not isinstance(asked, PathSetpoint) or asked.throttle is not None:
            return wish
        v_north, v_east = now.ground_speed * math.cos(now.course), now.ground_speed * math.sin(now.course)
        gust = now.airspeed - math.hypot(v_north - self._north, v_east - self._east)
        airspeed = min(max(asked.airspeed + gust, params.min_airspeed), params.max_airspeed)
        return replace(wish, asked=replace(asked, airspeed=airspeed))

    def _average(self, now: Estimate, dt: float) -> None:
        self._known = min(self._known + dt, WIND_TIME)
        share = dt / self._known
        self._north += share * (now.wind_north - self._north)
        self._east += share * (now.wind_east - self._east)
