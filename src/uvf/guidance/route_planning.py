"""What is flown between the items of a mission, planned ahead: legs, the corners between them, curves between given courses.

A waypoint is passed in one of three ways: at its course, if it has one; by a corner that rounds it (``corners``); or, where corners
do not fit, along a curve that leaves the one leg and joins the other, past several waypoints if the legs between are short (``bypass``).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from uvf.guidance import bypass, corners
from uvf.guidance.approach import orbit_radius
from uvf.guidance.clothoid_dubins import smooth_dubins_path, turned_onto, turned_onto_circle
from uvf.guidance.flight_plan import OFF_PATH, NextItem, PlanItem, following
from uvf.guidance.route import Circle, Curve, Leg, Place
from uvf.guidance.vector_field import Point
from uvf.models.vehicle.flight_params import AirParams

LEAVING = 0.6  # of a leg, for the corner at its beginning at most; it needs more than that at its end
MOST_PASSED = 4  # waypoints, by one curve


Bend = corners.Corner | Curve


class PathStart(NamedTuple):
    """How a piece begins: course [rad] and curvature [1/m]."""

    course: float
    bend: float = 0.0


@dataclass(frozen=True)
class RoutePlanner:
    """Plans the pieces of a route for one airspeed in one wind."""

    items: Sequence[PlanItem]
    params: AirParams
    wind: Point  # m/s north and east, the way it blows to
    speed: float  # m/s

    @property
    def flying(self) -> corners.CornerLimits:
        """Limits of corners at this airspeed and in this wind, with ``turn_bank``."""
        return corners.CornerLimits(self.speed, self.wind, self.params.turn_bank, self.params.roll_in)

    def towards(self, stop: NextItem, start: Place, begin: PathStart | None = None, entry: Bend | None = None) -> Leg | Curve | Circle:
        """The piece from ``start`` to the item of ``stop``; it begins as ``begin`` says, or else goes straight there."""
        item = self._item(stop)
        if not item.flies_through:
            return (self._onto_circle(start, begin, item) if begin is not None else None) or self._circle(item)
        if begin is not None and item.course is not None:
            return self._between(start, begin, item)
        leg = Leg(start, item.place, entry)
        if begin is not None and abs(math.remainder(leg.course - begin.course, math.tau)) > corners.STRAIGHT:
            return self._joining(start, begin, stop) or self.with_exit(leg, stop)
        return self.with_exit(leg, stop)

    def with_exit(self, leg: Leg, stop: NextItem) -> Leg:
        """The leg to the item of ``stop`` with what is flown at its end, if something is."""
        onward = self._after(stop)
        if onward is None:
            return replace(leg, exit=self._circle_ahead(leg, stop))
        item, then = self._item(stop), self._item(onward)
        if then.course is not None:
            curve = self._between(item.place, PathStart(leg.course), then)
            return replace(leg, exit=replace(curve, passing=(0.0, *curve.passing), heights=(curve.heights[0], *curve.heights)))
        onto = Leg(item.place, then.place)
        if abs(_change(leg, onto)) < corners.STRAIGHT:
            return replace(leg, exit=None)
        return replace(leg, exit=self._corner(leg, onto, stop, onward) or self._bypass(leg, stop))

    def _circle_ahead(self, leg: Leg, stop: NextItem) -> Curve | None:
        """From the end of a leg onto the circle that follows it, if one does."""
        then = following(self.items, stop)
        if then.index is None or self._item(then).kind in OFF_PATH:
            return None
        curve = self._onto_circle(leg.end, PathStart(leg.course), self._item(then))
        return replace(curve, passing=(0.0,), heights=(curve.heights[0], *curve.heights)) if curve is not None else None

    def _onto_circle(self, start: Place, begin: PathStart, item: PlanItem) -> Curve | None:
        """By a turn and straight on; None where it begins within the circle."""
        circle = self._circle(item)
        flying, ring = self.flying, (*circle.centre.point, circle.radius)
        way = turned_onto_circle((*start.point, begin.course), ring, flying.radius, flying.ramp, begin.bend)
        return Curve(way, (), (start.height, item.place.height), onto=circle) if way is not None else None

    def _circle(self, item: PlanItem) -> Circle:
        return Circle(item.place, orbit_radius(item, self.params))

    def _item(self, stop: NextItem) -> PlanItem:
        assert stop.index is not None
        return self.items[stop.index]

    def _after(self, stop: NextItem) -> NextItem | None:
        """The next one that is flown through, if the next one is."""
        then = following(self.items, stop)
        return then if then.index is not None and self._item(then).flies_through else None

    def _between(self, start: Place, begin: PathStart, item: PlanItem) -> Curve:
        """The Dubins path to an item with a course."""
        assert item.course is not None
        ends = (*start.point, begin.course), (*item.place.point, item.course)
        way = smooth_dubins_path(*ends, self.flying.radius, self.flying.ramp, begin.bend)
        return Curve(way, (way.length,), (start.height, item.place.height, item.place.height))

    def _joining(self, start: Place, begin: PathStart, stop: NextItem) -> Curve | None:
        """From a course onto the leg to an item without one."""
        item = self._item(stop)
        way = turned_onto((*start.point, begin.course), item.place.point, self.flying.radius, self.flying.ramp, begin.bend)
        if way is None:
            return None
        north, east = way.points[-1].tolist()
        left = math.hypot(item.place.north - north, item.place.east - east)
        height = start.height + (item.place.height - start.height) * way.length / (way.length + left)
        onto = self.with_exit(Leg(Place(north, east, height), item.place), stop)
        return Curve(way, (), (start.height, height), onto=onto)

    def _corner(self, leg: Leg, onto: Leg, stop: NextItem, onward: NextItem) -> corners.Corner | None:
        """Round the waypoint between two legs; None where there is no room for it, or for the next one after it."""
        before, room = leg.length - _taken(leg), LEAVING * onto.length
        corner = self._rounded(leg, onto, (before, room))
        beyond = self._after(onward)
        if corner is not None and beyond is not None and self._item(beyond).course is None:
            needed = self._needed(onto, Leg(onto.end, self._item(beyond).place))
            if needed > onto.length - corner.after:
                corner = self._rounded(leg, onto, (before, onto.length - needed))
        return corner if corner is not None and corner.cut(leg.end.point) <= self._item(stop).acceptance else None

    def _rounded(self, leg: Leg, onto: Leg, room: Point) -> corners.Corner | None:
        return corners.plan(leg.end.point, (leg.course, onto.course), self.flying, room)

    def _needed(self, leg: Leg, onto: Leg) -> float:
        """m at the end of a leg for the corner there; 0 where it will not be rounded."""
        if abs(_change(leg, onto)) < corners.STRAIGHT:
            return 0.0
        corner = self._rounded(leg, onto, (math.inf, LEAVING * onto.length))
        return corner.before if corner is not None else 0.0

    def _bypass(self, leg: Leg, stop: NextItem) -> Curve:
        """From this leg onto the first one after it that is long enough."""
        places, acceptances, out, last = [leg.end], [self._item(stop).acceptance], None, stop
        while out is None or (len(places) < MOST_PASSED and self._is_short(out, last)):
            if out is not None:
                places.append(out.end)
                acceptances.append(self._item(last).acceptance)
            onward = self._after(last)
            assert onward is not None
            last, out = onward, Leg(places[-1], self._item(onward).place)
        straight_on = self._item(last).course is None
        room = (leg.length - _taken(leg), self._left(out, last) if straight_on else 0.0)
        found = bypass.plan([leg.start.point, *(p.point for p in places), out.end.point], acceptances, room, self.flying)
        heights = (leg.height(leg.length - found.before), *(p.height for p in places), out.height(found.after))
        curve = Curve(found.way, found.passing, heights, found.before, found.after)
        return replace(curve, onto=replace(out, entry=curve)) if straight_on else curve

    def _left(self, leg: Leg, stop: NextItem) -> float:
        """m of the leg to the item of ``stop`` that the corner at its end leaves."""
        onward = self._after(stop)
        needed = 0.0 if onward is None else self._needed(leg, Leg(leg.end, self._item(onward).place))
        return max(LEAVING * leg.length, leg.length - needed)

    def _is_short(self, leg: Leg, stop: NextItem) -> bool:
        """Whether a leg that is joined by a curve is too short for the corner at its end."""
        onward = self._after(stop)
        if onward is None or self._item(stop).course is not None or self._item(onward).course is not None:
            return False
        return self._needed(leg, Leg(leg.end, self._item(onward).place)) > (1 - LEAVING) * leg.length


def _taken(leg: Leg) -> float:
    """m of the leg that the corner at its beginning takes."""
    return leg.entry.after if leg.entry is not None else 0.0


def _change(leg: Leg, onto: Leg) -> float:
    return math.remainder(onto.course - leg.course, math.tau)
