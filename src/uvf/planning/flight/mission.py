"""A planned path of an aircraft as mission items, each way between two looked at as the autopilot flies it.

The autopilot leads from one given course to the next along the shortest Dubins path whose curvature rises and falls gradually
(``uvf.guidance.clothoid_dubins``), and climbs evenly on it. That is not quite the planned edge, so it is tested anew; where it would be
too steep, the mission circles to the height.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import remainder, tau

import numpy as np
from numpy.typing import NDArray

from uvf.guidance.clothoid_dubins import smooth_dubins_path
from uvf.models.mission.file import Waypoint
from uvf.planning.flight.airspace import Airspace, Space, space_of
from uvf.planning.flight.clearance import ClearanceMargins, Configuration, are_clear
from uvf.planning.flight.loiter import LoiterPattern, exits, plan_loiter
from uvf.planning.flight.planner import DubinsAirplanePath, FlightLimits
from uvf.planning.smoothing import way_along

Floats = NDArray[np.float64]

DECIMALS = 2  # of metres
PLANNED = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Shares of what the planned heights differ by from an even climb, in the order in which they are tried."""
EXITS = 24  # places on a circle from which the way on is tested


@dataclass(frozen=True)
class FlownTurns:
    """How the autopilot turns: ``radius`` [m] over ground and ``ramp`` [m], in which it rolls from level to the bank of the turn.

    fence_room: [m] that straight lines between items keep from the fence's edges, as the autopilot's check of missions asks for.
    """

    radius: float
    ramp: float
    fence_room: float


@dataclass(frozen=True)
class _Flown:
    """What the ways of one mission are tested against."""

    airspace: Airspace
    space: Space
    limits: FlightLimits
    turns: FlownTurns

    @property
    def margins(self) -> ClearanceMargins:
        return ClearanceMargins(float(self.limits.aside), float(self.limits.above))

    def way(self, a: Configuration, b: Configuration) -> Floats:
        """(n, 3) x, y, height [m] that are flown from ``a`` to ``b``."""
        path = smooth_dubins_path((a[0], a[1], a[3]), (b[0], b[1], b[3]), self.turns.radius, self.turns.ramp)
        return np.column_stack((path.points, a[2] + (b[2] - a[2]) * path.s / max(path.length, 1e-9)))

    def is_open(self, a: Configuration, b: Configuration) -> bool:
        """Whether the way is clear, and not too steep."""
        way = self.way(a, b)
        length = float(np.hypot(*np.diff(way[:, :2], axis=0).T).sum())
        steepest = np.tan(self.limits.climb if b[2] >= a[2] else self.limits.sink)
        if abs(b[2] - a[2]) > steepest * length * (1 + 1e-6) + 1e-6 or not are_clear(self.space, self.margins, way):
            return False
        return self.airspace.fence.leaves((a[0], a[1]), (b[0], b[1]), self.turns.fence_room) is None


def flight_items(path: DubinsAirplanePath, airspace: Airspace, limits: FlightLimits, turns: FlownTurns) -> list[Waypoint] | None:
    """Mission items (x east, y north) from the path's start, which is none of them, to its goal; None where a way between is not clear.

    Nodes that are not needed are left out. The heights of the others are as near as they may be to an even climb from start to goal, since
    the search only looks for a short way over ground. A climb that is too steep becomes an ``orbit`` to altitude, at one place if that
    can be.
    """
    flown = _Flown(airspace, space_of(airspace), limits, turns)
    even = [_levelled(path.waypoints, share) for share in PLANNED]
    for profiles, may_circle in ((even, False), (_at_once(path.waypoints), True), (even, True)):
        for nodes in profiles:
            if (items := _items(flown, nodes, may_circle)) is not None:
                return items
    return None


def _levelled(nodes: Floats, planned: float) -> list[Configuration]:
    """Nodes (n, 4) with heights between those of an even climb (``planned`` 0) and their own (1)."""
    along = way_along(nodes[:, :2])
    even = nodes[0, 2] + (nodes[-1, 2] - nodes[0, 2]) * along / max(along[-1], 1e-9)
    heights = even + planned * (nodes[:, 2] - even)
    return [(x, y, height, course) for (x, y, _, course), height in zip(nodes.tolist(), heights.tolist(), strict=True)]


def _at_once(nodes: Floats) -> Iterator[list[Configuration]]:
    """Nodes (n, 4) at the height of the start up to one of them, behind it at that of the goal; high for as long as can be first."""
    start, goal, last = float(nodes[0, 2]), float(nodes[-1, 2]), len(nodes) - 1
    for k in range(last) if goal > start else range(last - 1, -1, -1):
        yield [(x, y, start if i <= k else goal, course) for i, (x, y, _, course) in enumerate(nodes.tolist())]


def _items(flown: _Flown, nodes: list[Configuration], may_circle: bool) -> list[Waypoint] | None:
    items, here, last = list[Waypoint](), 0, len(nodes) - 1
    while here < last:
        ahead = next((k for k in range(last, here, -1) if flown.is_open(nodes[here], nodes[k])), None)
        if ahead is not None:
            items.append(waypoint(nodes[ahead]))
        elif may_circle and (circled := _circled(flown, nodes[here], nodes[here + 1])) is not None:
            items += circled
        else:
            return None
        here = here + 1 if ahead is None else ahead
    return items


def _circled(flown: _Flown, a: Configuration, b: Configuration) -> list[Waypoint] | None:
    """From ``a`` to ``b`` with a circle at the one of them at which there is room: first at ``a`` for a climb, at ``b`` for a descent."""
    at_start, at_end = (a[0], a[1], a[2], a[3]), (b[0], b[1], a[2], b[3])
    for begin in (at_start, at_end) if b[2] > a[2] else (at_end, at_start):
        if begin is at_end and not flown.is_open(a, begin):
            continue
        pattern = plan_loiter(flown.airspace, flown.limits, begin, b[2], flown.limits.radius)
        if pattern is not None and all(flown.is_open(leaving, b) for leaving in exits(pattern, EXITS)):
            return [*([waypoint(begin)] if begin is at_end else []), loiter_item(pattern), waypoint(b)]
    return None


def waypoint(at: Configuration) -> Waypoint:
    """The item that is passed at a place on its course."""
    course = round(remainder(at[3], tau), 5)
    return Waypoint(round(at[0], DECIMALS), round(at[1], DECIMALS), round(at[2], DECIMALS), course=course)


def loiter_item(pattern: LoiterPattern) -> Waypoint:
    """The orbit of a pattern: to its height, or without end where it has no height to reach."""
    (x, y), climbs = pattern.centre, pattern.length > 0
    place = round(x, DECIMALS), round(y, DECIMALS), round(pattern.height, DECIMALS)
    return Waypoint(*place, kind="orbit", radius=round(-pattern.radius, DECIMALS), to_altitude=climbs)
