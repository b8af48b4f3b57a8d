"""The airspeed that is flown: what somebody asks for in flight, and what a leader leaves to those behind it."""

import math
from dataclasses import replace

import msgspec

from services.autopilot.air.setpoints import PathSetpoint, Setpoint
from uvf.estimation.state import Estimate
from uvf.models.vehicle.flight_params import AirParams


class SpeedOverride:
    """Nothing, an airspeed, or a speed over ground."""

    def __init__(self) -> None:
        self._speed = 0.0  # m/s
        self._over_ground = False
        self._given: float | None = None
        """m/s, airspeed, of the cycle before."""

    def take(self, speed: float, over_ground: bool) -> None:
        """speed: m/s; 0 = cruise."""
        self._speed, self._over_ground, self._given = speed, over_ground, 0.0

    def begin(self, anew: bool) -> None:
        """Another path is flown; ``anew``: in another mode."""
        if anew:
            self._speed, self._given = 0.0, None
        elif self._given is not None:
            self._given = 0.0

    def of(self, now: Estimate, params: AirParams, present: float) -> float:
        """m/s, airspeed to fly, 0 = cruise. present: the one in force, of which a change since the cycle before is a new wish."""
        if self._given is None or (self._given and present != self._given):
            self._speed, self._given = 0.0, None
            return present
        self._given = airspeed_over_ground(now, self._speed, params) if self._over_ground and self._speed else self._speed
        return self._given

    @staticmethod
    def fault(now: Estimate, speed: float, over_ground: bool, params: AirParams) -> str:
        """Why this speed [m/s] cannot be flown; empty if it can, over ground in one direction at least."""
        wind = math.hypot(now.wind_north, now.wind_east) if over_ground else 0.0
        low, high = max(params.min_airspeed - wind, 0.1), params.max_airspeed + wind
        if speed == 0 or low <= speed <= high:
            return ""
        return f"{speed:g} m/s {'over ground ' if over_ground else ''}cannot be flown: {low:.3g} to {high:.3g} m/s can"


def airspeed_over_ground(now: Estimate, speed: float, params: AirParams) -> float:
    """m/s, airspeed that makes this speed over ground [m/s] on the course of now (the wind triangle), as far as it can be flown."""
    along = now.wind_north * math.cos(now.course) + now.wind_east * math.sin(now.course)
    across = now.wind_east * math.cos(now.course) - now.wind_north * math.sin(now.course)
    return min(max(math.hypot(speed - along, across), params.min_airspeed), params.max_airspeed)


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
        """The setpoint with the airspeed [m/s] of now that the speed asked for means, in a cycle of ``dt`` [s]."""
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
