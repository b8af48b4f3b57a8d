"""Modes that follow a path: circles, and the legs of a mission."""

import math
from dataclasses import dataclass, replace

from services.autopilot.air.setpoints import Phase, Track, Wish
from uvf.estimation.state import Estimate
from uvf.guidance.plan_follower import Navigator
from uvf.guidance.route import Circle
from uvf.guidance.vector_field import turn_radius
from uvf.models.vehicle.flight_params import AirParams


@dataclass(frozen=True, slots=True)
class Round:
    """How a place is circled: radius [m], positive clockwise, and airspeed [m/s]; 0 = the vehicle's own."""

    radius: float = 0.0
    airspeed: float = 0.0

    def fault(self, params: AirParams) -> str:
        """Why it cannot be flown; empty if it can."""
        if not (math.isfinite(self.radius) and math.isfinite(self.airspeed)):
            return "the circle is none: its numbers are not finite"
        if self.airspeed and not params.min_airspeed <= self.airspeed <= params.max_airspeed:
            return f"{self.airspeed:g} m/s cannot be flown: {params.min_airspeed:g} to {params.max_airspeed:g} m/s can"
        tightest = turn_radius(self.airspeed or params.trim_airspeed, params.turn_bank)
        if self.radius and abs(self.radius) < tightest:
            return f"a circle of {abs(self.radius):g} m is too tight at this airspeed: {math.ceil(tightest)} m is not"
        return ""


OWN = Round()


class Circling(Phase):
    """Round a circle at its height, for ever."""

    def __init__(self, circle: Circle, how: Round) -> None:
        """Without a radius in ``how`` that of the circle follows ``hold_radius``."""
        self.circle = circle
        self.airspeed = how.airspeed
        self._sized = how.radius != 0.0

    def step(self, now: Estimate, params: AirParams, dt: float) -> Wish:
        if not self._sized and self.circle.radius != params.hold_radius:
            self.circle = replace(self.circle, radius=params.hold_radius)
        return Wish(Track(self.circle.aim(now, params), self.circle.centre.height, 0.0, self.airspeed or params.trim_airspeed))


class Following(Phase):
    """The legs and circles of a mission, up to its end or to an item that is not one of them."""

    def __init__(self, navigator: Navigator) -> None:
        self._navigator = navigator

    def step(self, now: Estimate, params: AirParams, dt: float) -> Wish:
        aim, level = self._navigator.step(now, params, dt)
        return Wish(Track(aim, level.height, level.climb, self._navigator.speed or params.trim_airspeed))
