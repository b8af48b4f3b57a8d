"""Where Return leads: home, or a rally point that is nearer; of those that can be circled within the fence, if any can."""

import math
from collections.abc import Sequence

from uvf.estimation.state import Estimate
from uvf.guidance.fence_plan import place_fault
from uvf.guidance.route import Circle, Place
from uvf.models.mission.fence import Fencing
from uvf.models.vehicle.flight_params import AirParams


def return_point(now: Estimate, home: Place, rally: Sequence[Place], fencing: Fencing, params: AirParams) -> Place:
    """The place to circle over, no lower than ``return_altitude`` above home; home without any that lies within the fence."""
    places = [_over(place, home, params) for place in (home, *rally)]
    kept = [place for place in places if is_within(Circle(place, params.hold_radius), fencing, params)]
    return min(kept or places[:1], key=lambda place: math.hypot(place.north - now.north, place.east - now.east))


def lowest_over(to: Place, rally: Sequence[Place]) -> float:
    """m, world: a rally point is not flown over lower than it says."""
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
