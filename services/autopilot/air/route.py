"""The pieces of a flown route: a leg with its swings, the arc round its end, a circle."""

import math
from dataclasses import dataclass, replace

from services.autopilot.air.corners import Corner, Offset, offset
from services.autopilot.air.guidance import Aim, Point, line_aim, orbit_aim
from services.autopilot.air.params import AirParams
from services.autopilot.air.state import Estimate

CAPTURED = 0.3  # of the radius, from the circle: near enough to count turns


@dataclass(frozen=True, slots=True)
class Place:
    """m, world frame."""

    north: float
    east: float
    height: float

    @property
    def point(self) -> Point:
        return self.north, self.east


@dataclass(frozen=True, slots=True)
class Level:
    """The height wanted [m] and the climb of the path [m/s]."""

    height: float
    climb: float = 0.0


@dataclass(frozen=True, slots=True)
class Leg:
    """From ``start`` to ``end``; corners are those rounded at each."""

    start: Place
    end: Place
    entry: Corner | None = None
    exit: Corner | None = None

    @property
    def length(self) -> float:
        return math.hypot(self.end.north - self.start.north, self.end.east - self.start.east)

    @property
    def along(self) -> Point:
        """Unit vector; north for a leg without length."""
        length = self.length
        if length < 1e-6:
            return 1.0, 0.0
        return (self.end.north - self.start.north) / length, (self.end.east - self.start.east) / length

    @property
    def course(self) -> float:
        return math.atan2(self.along[1], self.along[0])

    def progress(self, position: Point) -> float:
        """m along the leg from its start."""
        n, e = self.along
        return (position[0] - self.start.north) * n + (position[1] - self.start.east) * e

    def is_flown(self, position: Point) -> bool:
        """Past the half plane where the arc begins, or through the waypoint."""
        return self.progress(position) >= self.length - (self.exit.before if self.exit else 0.0)

    def offset(self, s: float) -> Offset:
        return offset(s, self.length, self.entry, self.exit)

    def bend(self, s: float) -> float:
        """Curvature of the route at ``s`` [m], the arc at the end included [1/m]."""
        if self.exit is not None and s > self.length - self.exit.before:
            return self.exit.turn / self.exit.radius
        return self.offset(s).bend

    def aim(self, now: Estimate, params: AirParams) -> Aim:
        position = (now.north, now.east)
        s = self.progress(position)
        aside = self.offset(s)
        aim = line_aim(self.along, self.start.point, position, params)
        course = aim.course + math.atan(aside.slope)
        return replace(aim, error=aim.error - aside.value, course=course, curvature=self.bend(s + now.ground_speed * params.lead_time))

    def level(self, now: Estimate) -> Level:
        """A straight line between the heights of both ends."""
        length = max(self.length, 1.0)
        part = self.progress((now.north, now.east)) / length
        rise = self.end.height - self.start.height
        climbing = 0 < part < 1
        climb = now.ground_speed * rise / length if climbing else 0.0
        return Level(self.start.height + rise * min(max(part, 0.0), 1.0), climb)


@dataclass(frozen=True, slots=True)
class Arc:
    """Round ``corner`` onto the leg that follows it."""

    corner: Corner
    onto: Leg

    def is_flown(self, position: Point) -> bool:
        return self.onto.progress(position) >= self.corner.before

    def aim(self, now: Estimate, params: AirParams) -> Aim:
        corner = self.corner
        aim = orbit_aim(corner.centre, corner.turn * corner.radius, (now.north, now.east), params)
        left = math.remainder(corner.course_out - aim.course, math.tau) * corner.turn * corner.radius
        ahead = now.ground_speed * params.lead_time - left
        return replace(aim, curvature=self.onto.bend(corner.before + ahead)) if ahead > 0 else aim


@dataclass(frozen=True, slots=True)
class Circle:
    """``radius`` [m] positive clockwise seen from above."""

    centre: Place
    radius: float

    @classmethod
    def ahead(cls, now: Estimate, height: float, radius: float) -> "Circle":
        """The circle that the aircraft enters by turning now."""
        side = now.course + math.pi / 2
        centre = Place(now.north + radius * math.cos(side), now.east + radius * math.sin(side), height)
        return cls(centre, radius)

    def aim(self, now: Estimate, params: AirParams) -> Aim:
        return orbit_aim(self.centre.point, self.radius, (now.north, now.east), params)

    def bearing(self, now: Estimate) -> float:
        """rad, of the aircraft from the centre."""
        return math.atan2(now.east - self.centre.east, now.north - self.centre.north)

    def is_captured(self, now: Estimate) -> bool:
        distance = math.hypot(now.north - self.centre.north, now.east - self.centre.east)
        return abs(distance - abs(self.radius)) < CAPTURED * abs(self.radius)
