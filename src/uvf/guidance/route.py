"""The pieces of a flown route: a leg, the turn onto the next, a circle."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from uvf.estimation.state import Estimate
from uvf.guidance.clothoid_dubins import SampledPath
from uvf.guidance.corners import Corner
from uvf.guidance.vector_field import PathReference, Point, line_reference, orbit_reference
from uvf.models.vehicle.flight_params import AirParams

CHANGES = 0.04  # s, over which the change of a bend is taken, each way
CAPTURED = 0.3  # of the radius, from the circle: near enough to count turns
BEHIND, AHEAD = 20.0, 40.0  # m along a curve, where the aircraft is looked for


@dataclass(frozen=True, slots=True)
class Place:
    """A place in the world frame, height above its origin [m]."""

    north: float
    east: float
    height: float

    @property
    def point(self) -> Point:
        """North and east [m]."""
        return self.north, self.east


@dataclass(frozen=True, slots=True)
class AltitudeProfile:
    """Height to fly at [m] and climb rate of the path [m/s]."""

    height: float
    climb: float = 0.0


def banked_for(bend: Callable[[float], float], s: float, now: Estimate, params: AirParams) -> float:
    """Curvature [1/m] to bank for at ``s`` [m] of a path with the curvature ``bend``.

    A lead time ahead, and beyond that as much as it changes there within ``bank_time``: the lag of roll behind its command, inverted.
    """
    ahead, step = s + now.ground_speed * params.lead_time, now.ground_speed * CHANGES
    return bend(ahead) + params.bank_time * (bend(ahead + step) - bend(ahead - step)) / (2 * CHANGES)


@dataclass(frozen=True, slots=True)
class Leg:
    """A straight leg from ``start`` to ``end``; with the corner rounded at each end, or the curve flown instead."""

    start: Place
    end: Place
    entry: "Corner | Curve | None" = None
    exit: "Corner | Curve | None" = None

    @property
    def length(self) -> float:
        """Horizontal length [m]."""
        return math.hypot(self.end.north - self.start.north, self.end.east - self.start.east)

    @property
    def along(self) -> Point:
        """Unit vector along the leg, north and east; north for a leg without length."""
        length = self.length
        if length < 1e-6:
            return 1.0, 0.0
        return (self.end.north - self.start.north) / length, (self.end.east - self.start.east) / length

    @property
    def course(self) -> float:
        """Course [rad] from north, clockwise."""
        return math.atan2(self.along[1], self.along[0])

    def progress(self, position: Point) -> float:
        """Distance [m] along the leg from its start to ``position`` (north, east [m])."""
        n, e = self.along
        return (position[0] - self.start.north) * n + (position[1] - self.start.east) * e

    def is_flown(self, position: Point) -> bool:
        """Whether the half plane is passed where the corner at the end begins, or that through the waypoint."""
        return self.progress(position) >= self.length - (self.exit.before if self.exit else 0.0)

    def bend(self, s: float) -> float:
        """Curvature [1/m] of the route at ``s`` [m] along the leg, that of the corner at the end included."""
        return self.exit.bend(s - self.length + self.exit.before) if self.exit is not None else 0.0

    def aim(self, now: Estimate, params: AirParams) -> PathReference:
        """Path reference on the leg, its curvature a lead time ahead."""
        position = (now.north, now.east)
        aim = line_reference(self.along, self.start.point, position, params)
        return replace(aim, curvature=banked_for(self.bend, self.progress(position), now, params))

    def level(self, now: Estimate) -> AltitudeProfile:
        """Altitude profile on a straight line between the heights of both ends."""
        s = self.progress((now.north, now.east))
        rise = (self.end.height - self.start.height) / max(self.length, 1.0)
        return AltitudeProfile(self.height(s), now.ground_speed * rise if 0 < s < self.length else 0.0)

    def height(self, s: float) -> float:
        """Height [m] of the route at ``s`` [m] along the leg."""
        part = min(max(s / max(self.length, 1.0), 0.0), 1.0)
        return self.start.height + part * (self.end.height - self.start.height)


@dataclass(frozen=True, slots=True)
class Turn:
    """The way round ``corner`` from one leg onto the next."""

    corner: Corner
    leaves: Leg
    onto: Leg

    def is_flown(self, position: Point) -> bool:
        """Whether ``position`` (north, east [m]) is beyond the corner's end."""
        return self.corner.nearest(position)[0] >= self.corner.length

    def aim(self, now: Estimate, params: AirParams) -> PathReference:
        """Path reference on the corner, its curvature a lead time ahead: of the corner, or of the next leg."""
        s, aside, course = self.corner.nearest((now.north, now.east))
        return PathReference(aside, course, banked_for(self._bend, s, now, params), params.k_path, params.chi_inf)

    def _bend(self, s: float) -> float:
        corner = self.corner
        return corner.bend(s) if s <= corner.length else self.onto.bend(corner.after + s - corner.length)

    def level(self, now: Estimate) -> AltitudeProfile:
        """Altitude profile on a straight line between the heights of the two legs where the corner begins and ends."""
        corner, leaves = self.corner, self.leaves
        begin, end = leaves.height(leaves.length - corner.before), self.onto.height(corner.after)
        part = min(max(corner.nearest((now.north, now.east))[0] / corner.length, 0.0), 1.0)
        return AltitudeProfile(begin + part * (end - begin), now.ground_speed * (end - begin) / corner.length)


@dataclass
class Curve:
    """A path planned beforehand, straight at both ends; it knows how far along it the aircraft is, for it may cross itself.

    ``passing``: [m] along it where items of the mission are passed. ``heights``: [m] at its begin, at each of these and at its end.
    ``before``, ``after``: [m] of the legs that it replaces. ``onto``: what follows, once that is known.
    """

    way: SampledPath
    passing: tuple[float, ...]
    heights: tuple[float, ...]
    before: float = 0.0
    after: float = 0.0
    onto: "Leg | Curve | Circle | None" = None
    s: float = 0.0  # m
    passed: int = 0  # of ``passing``

    @property
    def end(self) -> Place:
        """Place where the curve ends."""
        north, east = self.way.points[-1].tolist()
        return Place(north, east, self.heights[-1])

    @property
    def left(self) -> float:
        """Distance [m] left to the curve's end."""
        return self.way.length - self.s

    @property
    def here(self) -> tuple[float, float, float]:
        """North, east [m] and course [rad] of the curve where the aircraft is."""
        i = int(np.searchsorted(self.way.s, self.s).clip(0, len(self.way.s) - 1))
        return *self.way.points[i].tolist(), float(self.way.course[i])

    def place(self, s: float) -> Place:
        """Place on the curve at ``s`` [m] along it."""
        north, east = (float(np.interp(s, self.way.s, column)) for column in self.way.points.T)
        return Place(north, east, self._height(s))

    @property
    def is_straight(self) -> bool:
        """Whether the curve is straight where the aircraft is."""
        return abs(self.way.bend(self.s)) < 1e-9

    @property
    def ends_at_item(self) -> bool:
        """Whether the current item is at the curve's end, with no other on the way to it."""
        return self.passing[self.passed :] == (self.way.length,)

    def follow(self, position: Point) -> None:
        """Takes each new position (north, east [m]) to find how far along the curve the aircraft is."""
        self.s = self._nearest(position)[0]

    def bend(self, s: float) -> float:
        """Curvature [1/m] at ``s`` [m] along the curve, beyond its end that of what follows."""
        beyond = s - self.way.length
        if beyond <= 0 or self.onto is None:
            return self.way.bend(s)
        return 1 / self.onto.radius if isinstance(self.onto, Circle) else self.onto.bend(beyond + self.after)

    def aim(self, now: Estimate, params: AirParams) -> PathReference:
        """Path reference on the curve, its curvature a lead time ahead."""
        s, aside, course = self._nearest((now.north, now.east))
        return PathReference(aside, course, banked_for(self.bend, s, now, params), params.k_path, params.chi_inf)

    def level(self, now: Estimate) -> AltitudeProfile:
        """Altitude profile by linear interpolation between the heights over the length."""
        height = self._height(self.s)
        return AltitudeProfile(height, now.ground_speed * (self._height(self.s + 1.0) - height))

    def _height(self, s: float) -> float:
        return float(np.interp(s, (0.0, *self.passing, self.way.length), self.heights))

    def _nearest(self, position: Point) -> tuple[float, float, float]:
        return self.way.nearest(position, (self.s - BEHIND, self.s + AHEAD))


@dataclass(frozen=True, slots=True)
class Circle:
    """A circle; ``radius`` [m] positive clockwise seen from above."""

    centre: Place
    radius: float

    @classmethod
    def ahead(cls, now: Estimate, height: float, radius: float) -> "Circle":
        """The circle at ``height`` [m] with ``radius`` [m] that the aircraft enters by turning now."""
        side = now.course + math.pi / 2
        centre = Place(now.north + radius * math.cos(side), now.east + radius * math.sin(side), height)
        return cls(centre, radius)

    def aim(self, now: Estimate, params: AirParams) -> PathReference:
        """Path reference on the circle."""
        return orbit_reference(self.centre.point, self.radius, (now.north, now.east), params)

    def level(self, now: Estimate) -> AltitudeProfile:
        """Altitude profile at the height of the circle, without climb."""
        return AltitudeProfile(self.centre.height)

    def bearing(self, now: Estimate) -> float:
        """Bearing [rad] of the aircraft from the centre, from north, clockwise."""
        return math.atan2(now.east - self.centre.east, now.north - self.centre.north)

    def is_captured(self, now: Estimate) -> bool:
        """Whether the aircraft is near enough to the circle for turns to count."""
        distance = math.hypot(now.north - self.centre.north, now.east - self.centre.east)
        return abs(distance - abs(self.radius)) < CAPTURED * abs(self.radius)
