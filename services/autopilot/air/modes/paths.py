"""Modes that follow a path: circles, and the legs of a mission."""

import math
from dataclasses import dataclass, replace

from services.autopilot.air.setpoints import FlightPhase, PathSetpoint, Setpoint
from uvf.estimation.state import Estimate
from uvf.guidance.plan_follower import PlanFollower
from uvf.guidance.route import Circle
from uvf.guidance.vector_field import turn_radius
from uvf.models.vehicle.flight_params import AirParams


@dataclass(frozen=True, slots=True)
class LoiterOptions:
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


OWN = LoiterOptions()


class OrbitMode(FlightPhase):
    """Round a circle at its height, for ever."""

    def __init__(self, circle: Circle, how: LoiterOptions) -> None:
        """Without a radius in ``how`` that of the circle follows ``hold_radius``."""
        self.circle = circle
        self.airspeed = how.airspeed
        self._sized = how.radius != 0.0

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Setpoint of this cycle of ``dt`` [s]: along the circle at its height."""
        if not self._sized and self.circle.radius != params.hold_radius:
            self.circle = replace(self.circle, radius=params.hold_radius)
        return Setpoint(PathSetpoint(self.circle.aim(now, params), self.circle.centre.height, 0.0, self.airspeed or params.trim_airspeed))


class PathMode(FlightPhase):
    """The legs and circles of a mission, up to its end or to an item that is not one of them."""

    def __init__(self, navigator: PlanFollower) -> None:
        self._navigator = navigator

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Setpoint of this cycle of ``dt`` [s]: along the leg of the mission."""
        aim, level = self._navigator.step(now, params, dt)
        return Setpoint(PathSetpoint(aim, level.height, level.climb, self._navigator.speed or params.trim_airspeed))
