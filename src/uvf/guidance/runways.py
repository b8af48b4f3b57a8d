"""Places to take off from and to land on: strips of the world, and one of the two directions of each."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from uvf.estimation.state import Estimate
from uvf.guidance.route import Place
from uvf.guidance.vector_field import Point, from_line

AIM_SHARE, AIM_MOST = 0.25, 60.0  # of the length, m: how far behind the threshold the wheels are meant to touch
ALONG = 0.35  # rad, between a strip and an approach to it
MEADOW = 400.0, 30.0  # m, length and width of what is supposed to be free about a place without a strip


@dataclass(frozen=True, slots=True)
class LandingStrip:
    """A strip of the world to take off from and land on.

    ``middle`` lies on the ground; ``course`` [rad] is that of one of its directions; length and width in [m].
    """

    middle: Place
    course: float
    length: float
    width: float

    def lane(self, course: float) -> "Runway":
        """The runway in that direction of the strip which is nearer to ``course`` [rad]."""
        turned = self.course if math.cos(course - self.course) >= 0 else self.course + math.pi
        back = self.length / 2 - min(AIM_SHARE * self.length, AIM_MOST)
        n, e, up = self.middle.north, self.middle.east, self.middle.height
        aim = Place(n - back * math.cos(turned), e - back * math.sin(turned), up)
        return Runway(aim, math.remainder(turned, math.tau), self.length / 2 + back, self.width)


@dataclass(frozen=True, slots=True)
class Runway:
    """One direction of a strip from the aiming point, where the wheels are to touch; ``rest`` [m] of it lies behind that."""

    aim: Place
    course: float  # rad
    rest: float
    width: float  # m

    @property
    def along(self) -> Point:
        """Unit vector of the landing direction, north and east."""
        return math.cos(self.course), math.sin(self.course)

    def locate(self, now: Estimate) -> tuple[float, float]:
        """Distance [m] of the aircraft before the aiming point, and to the right of the centre line."""
        ahead, right = from_line(self.along, (self.aim.north, self.aim.east), (now.north, now.east))
        return -ahead, right

    def tailwind(self, now: Estimate) -> float:
        """Tailwind [m/s] along the landing direction."""
        return now.wind_north * self.along[0] + now.wind_east * self.along[1]

    def crosswind(self, now: Estimate) -> float:
        """Wind [m/s] across the landing direction, to the right of it."""
        return now.wind_east * self.along[0] - now.wind_north * self.along[1]

    def before(self, distance: float, aside: float = 0.0) -> Point:
        """Point (north, east [m]) at ``distance`` [m] before the aiming point and ``aside`` [m] to the right."""
        cn, ce = self.along
        return self.aim.north - distance * cn - aside * ce, self.aim.east - distance * ce + aside * cn

    def off(self, angle: float) -> float:
        """Angle [rad] of a course or heading to the right of the runway's course."""
        return math.remainder(angle - self.course, math.tau)


def lane_for(place: Place, strips: Sequence[LandingStrip], now: Estimate) -> Runway:
    """The runway of the strip nearest to ``place``, against the wind; when it is calm, in the direction from the aircraft to the place.

    Without any strip the place itself is landed on.
    """
    if math.hypot(now.wind_north, now.wind_east) > 1.0:
        upwind = math.atan2(-now.wind_east, -now.wind_north)
    else:
        upwind = math.atan2(place.east - now.east, place.north - now.north)
    if not strips:
        return Runway(place, upwind, MEADOW[0] / 2, MEADOW[1])
    nearest = min(strips, key=lambda s: math.hypot(s.middle.north - place.north, s.middle.east - place.east))
    return nearest.lane(upwind)


def lane_by(place: Place, course: float, strips: Sequence[LandingStrip]) -> Runway:
    """The runway to touch right at ``place`` on ``course`` [rad].

    It has the room that is left of the strip there, if the place lies on one and the course along it.
    """
    for strip in strips:
        axis = math.cos(strip.course), math.sin(strip.course)
        ahead, right = from_line(axis, strip.middle.point, place.point)
        way = math.copysign(1.0, math.cos(course - strip.course))
        on = abs(ahead) < strip.length / 2 and abs(right) < strip.width / 2
        if on and abs(math.sin(course - strip.course)) < math.sin(ALONG):
            touch = Place(place.north, place.east, strip.middle.height)
            return Runway(touch, course, strip.length / 2 - way * ahead, strip.width)
    return Runway(place, course, MEADOW[0] / 2, MEADOW[1])
