"""A final approach that a mission lays down: off a circle along its tangent, or straight on from a waypoint."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.route import Place
from uvf.guidance.vector_field import turn_radius
from uvf.models.vehicle.flight_params import AirParams

SHORTEST = 8.0  # s at the lowest airspeed
STEEPEST = 0.16  # rad
OF_IDLE = 0.8  # of the sink without power: what is left over is for a tailwind
TIGHTEST_ORBIT = 0.6  # of the radius at turn_bank; smaller wishes are widened to that
ON_THE_WAY = (ItemKind.WAYPOINT, ItemKind.ORBIT)


@dataclass(frozen=True, slots=True)
class Approach:
    """Final approach to ``place``, where the wheels touch: on ``course`` [rad] from ``length`` [m] before it at ``height`` [m, world].

    ``radius`` [m] of the circle that it leaves, positive clockwise; 0: it begins at a waypoint.
    """

    place: Place
    course: float
    length: float
    height: float
    radius: float = 0.0

    @property
    def slope(self) -> float:
        """Tangent of the glide path's angle [-], positive downwards."""
        return (self.height - self.place.height) / max(self.length, 1.0)


def orbit_radius(item: PlanItem, params: AirParams) -> float:
    """Radius [m], positive clockwise, of the circle that is flown for an item."""
    wanted = item.radius or params.hold_radius
    tightest = TIGHTEST_ORBIT * turn_radius(params.trim_airspeed, params.turn_bank)
    return math.copysign(max(abs(wanted), tightest), wanted)


def laid_down(items: Sequence[PlanItem], index: int, params: AirParams) -> Approach | None:
    """The approach that the mission prescribes for the landing at ``index``.

    From a circle down to an altitude right before it, or from a waypoint of its landing pattern. None where the mission leaves it to
    the aircraft, and where no tangent leads from the circle to the place.
    """
    place, before = items[index].place, _before(items, index)
    if before is None:
        return None
    item = items[before]
    distance, course = _way(item.place, place)
    if item.kind is ItemKind.WAYPOINT:
        return Approach(place, course, distance, item.place.height)
    radius = orbit_radius(item, params)
    if distance <= abs(radius):
        return None
    course = math.remainder(course + math.asin(radius / distance), math.tau)
    return Approach(place, course, math.sqrt(distance**2 - radius**2), item.place.height, radius)


def approach_fault(items: Sequence[PlanItem], index: int, params: AirParams) -> str:
    """Why the approach prescribed for the landing at ``index`` cannot be flown, and how to mend it; empty if it can."""
    before = _before(items, index)
    if before is None:
        return ""
    found = laid_down(items, index, params)
    if found is None:
        distance, _ = _way(items[before].place, items[index].place)
        radius = abs(orbit_radius(items[before], params))
        return f"lies within the circle of item {before}, which leads to it: {distance:.0f} m of {radius:.0f} m"
    return _fault(found, before, params)


def _way(start: Place, end: Place) -> tuple[float, float]:
    """Distance [m] and course [rad]."""
    north, east = end.north - start.north, end.east - start.east
    return math.hypot(north, east), math.atan2(east, north)


def _before(items: Sequence[PlanItem], index: int) -> int | None:
    """What the final approach begins at, if an item says so."""
    for k in range(index - 1, -1, -1):
        item = items[k]
        if item.kind in ON_THE_WAY:
            circle = item.kind is ItemKind.ORBIT and item.to_altitude
            return k if circle or (item.flies_through and _is_of_pattern(items[:k])) else None
        if item.kind in (ItemKind.LAND, ItemKind.TAKEOFF, ItemKind.RETURN, ItemKind.LAND_START):
            return None
    return None


def _is_of_pattern(before: Sequence[PlanItem]) -> bool:
    """Whether a landing pattern has begun that no landing has ended yet."""
    marks = (item.kind for item in reversed(before) if item.kind in (ItemKind.LAND_START, ItemKind.LAND))
    return next(marks, ItemKind.LAND) is ItemKind.LAND_START


def _fault(approach: Approach, begin: int, params: AirParams) -> str:
    shortest = SHORTEST * params.min_airspeed
    if approach.length < shortest:
        return f"has a final approach of {approach.length:.0f} m from item {begin}: {math.ceil(shortest)} m at least"
    steepest = min(math.tan(STEEPEST), OF_IDLE * params.idle_sink / params.trim_airspeed)
    if approach.slope > max(steepest, math.tan(params.glide_slope)):
        lower = approach.place.height + steepest * approach.length
        angle, most = (math.degrees(math.atan(v)) for v in (approach.slope, steepest))
        return f"is approached at {angle:.1f} degrees, {most:.1f} at most: put item {begin} at {lower:.0f} m or further away"
    if approach.slope <= 0:
        return f"lies no lower than item {begin}, from where it is approached"
    return ""


def with_courses(items: Sequence[PlanItem]) -> list[PlanItem]:
    """The items, with the course of its final approach for each waypoint that one begins at and that has none."""
    found = list(items)
    for index in (i for i, item in enumerate(items) if item.kind is ItemKind.LAND):
        before = _before(items, index)
        if before is not None and items[before].kind is ItemKind.WAYPOINT and items[before].course is None:
            _, course = _way(items[before].place, items[index].place)
            found[before] = replace(items[before], course=course)
    return found
