"""Mode Return: to a circle over home or a rally point, there down to another height, and after a while to a landing, as PX4's Return.

Without ``descend_alt`` it stays at the height at which it came; without ``land_delay`` it circles until somebody asks for something else.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from services.autopilot.air.modes.paths import OWN, OrbitMode
from services.autopilot.air.setpoints import Setpoint
from uvf.estimation.state import Estimate
from uvf.guidance.fence_plan import place_fault
from uvf.guidance.route import Circle, Place
from uvf.models.mission.fence import Fencing
from uvf.models.vehicle.flight_params import AirParams

AT_HEIGHT = 5.0  # m


class ReturnMode(OrbitMode):
    """Its height follows the parameters until somebody asks for another one."""

    def __init__(self, to: Place, lowest: float, home: float, height: float) -> None:
        """lowest: over this place; home: of home; height: of the aircraft, below which it does not sink on its way. m, world."""
        super().__init__(Circle(replace(to, height=max(height, to.height)), 0.0), OWN)
        self._lowest, self._home, self._began = lowest, home, height
        self._given = self.circle.centre.height
        self._arrived = False
        self._waited = 0.0  # s

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Setpoint of this cycle of ``dt`` [s]: to the circle, down on it, and after ``land_delay`` the end."""
        if self.circle.centre.height == self._given:
            self._given = self._height(params)
            self.circle = replace(self.circle, centre=replace(self.circle.centre, height=self._given))
        wish = super().step(now, params, dt)
        self._arrived = self._arrived or self.circle.is_captured(now)
        there = self._arrived and abs(now.height - self.circle.centre.height) < AT_HEIGHT
        self._waited = self._waited + dt if there else self._waited
        if 0 <= params.land_delay <= self._waited:
            self.ended = "return: lands"
        return wish

    def _height(self, params: AirParams) -> float:
        """m, world."""
        comes = max(self._began, self._lowest, self._home + params.return_altitude)
        if not self._arrived or not params.descend_alt:
            return comes
        return min(comes, max(self._lowest, self._home + params.descend_alt, params.min_altitude))


def return_point(now: Estimate, home: Place, rally: Sequence[Place], fencing: Fencing, params: AirParams) -> Place:
    """The place to circle over, no lower than ``return_altitude`` above home; home without any that lies within the fence."""
    places = [_over(place, home, params) for place in (home, *rally)]
    kept = [place for place in places if is_within(Circle(place, params.hold_radius), fencing, params)]
    return min(kept or places[:1], key=lambda place: math.hypot(place.north - now.north, place.east - now.east))


def lowest_over(to: Place, rally: Sequence[Place]) -> float:
    """Least height [m, world]: a rally point is not flown over lower than it says."""
    return next((place.height for place in rally if place.point == to.point), -math.inf)


def is_within(circle: Circle, fencing: Fencing, params: AirParams) -> bool:
    """Whether it lies within a fence that steers."""
    return not fencing.steers or not place_fault(circle.centre, fencing, params, abs(circle.radius))


def _over(place: Place, home: Place, params: AirParams) -> Place:
    return Place(place.north, place.east, max(place.height, home.height + params.return_altitude))


def fault(rally: Sequence[Place], home: Place, fencing: Fencing, params: AirParams) -> str:
    """Which rally point cannot be returned to; empty if all can."""
    for i, place in enumerate(rally):
        if not all(map(math.isfinite, (*place.point, place.height))):
            return f"item {i} holds a number that is not finite"
        if fencing.steers and (why := place_fault(_over(place, home, params), fencing, params, params.hold_radius)):
            return f"item {i}: {why}"
    return ""
