"""The way round a corner between two legs: as tight as the bank allows, drifting with the wind, begun in time to roll.

Through the air it is a turn at a steady bank, rolled into and out of, a little beyond the new heading, and back with less bank:
so the second leg is passed as far outside as the corner is cut inside. Over ground the wind carries all of it along, which makes
it flyable at one airspeed and one bank from any side; where on the two legs it begins and ends follows (Beard & McLain 11.2 round
corners with arcs over ground, which a wind makes steeper here and flatter there).
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.guidance.clothoid_dubins import SampledPath
from uvf.guidance.vector_field import Point, turn_radius
from uvf.maths.geodesy import GRAVITY

Floats = NDArray[np.float64]

STRAIGHT = 0.02  # rad, below which a corner is none
SHARPEST = 2.8  # rad, beyond which the waypoint is overflown and the next leg joined from there
EASED = 1.2  # times roll_in, for curves, which may change from one side to the other at once
BACK = 0.7  # of the turn's bank, for the way back from beyond the second leg
MOST_BEYOND = 0.6  # rad, of heading
MOST_OUTSIDE = 0.3  # of the radius through the air, beyond the second leg
STEP = 0.04  # s, between samples
HALVINGS = 8


@dataclass(frozen=True, slots=True)
class CornerLimits:
    """Airspeed, wind and bank that corners are flown with."""

    airspeed: float  # m/s
    wind: Point  # m/s north and east, the way it blows to
    bank: float  # rad, of the turn
    roll_in: float = 1.0  # s, from level to that bank

    @property
    def radius(self) -> float:
        """Turn radius [m] over ground within the bank wherever the wind comes from (Beard & McLain 9.3.2, at its fastest)."""
        return turn_radius(self._fastest, self.bank)

    @property
    def ramp(self) -> float:
        """Distance [m] over ground in which it rolls from level to the bank of the turn."""
        return EASED * self.roll_in * self._fastest

    @property
    def _fastest(self) -> float:
        return self.airspeed + math.hypot(*self.wind)


@dataclass(frozen=True)
class Corner(SampledPath):
    """Samples of the path round a corner, evenly in time. ``before``, ``after``: [m] of the two legs that it replaces."""

    before: float
    after: float

    def cut(self, waypoint: Point) -> float:
        """Smallest distance [m] between the path and the waypoint."""
        return float(np.hypot(*(self.points - waypoint).T).min())


def plan(waypoint: Point, courses: tuple[float, float], flying: CornerLimits, room: Point) -> Corner | None:
    """The corner at ``waypoint`` between two ``courses`` [rad] with ``room`` [m] on the two legs; None where it cannot be rounded."""
    change = math.remainder(courses[1] - courses[0], math.tau)
    if not STRAIGHT < abs(change) < SHARPEST:
        return None
    headings = [_heading(course, flying) for course in courses]
    if None in headings:
        return None
    turn = _same_way(math.remainder(headings[1] - headings[0], math.tau), change)  # type: ignore[operator]
    made = CornerPlanner(waypoint, courses, flying, headings[0], turn).balanced(room[1])  # type: ignore[arg-type]
    return made if made.before <= room[0] and made.after <= room[1] else None


def _heading(course: float, flying: CornerLimits) -> float | None:
    """rad, through the air, that leads along ``course`` over ground; None when the wind is too strong."""
    north, east = flying.wind
    aside = (east * math.cos(course) - north * math.sin(course)) / flying.airspeed
    return course - math.asin(aside) if abs(aside) < 1 else None


def _same_way(turn: float, change: float) -> float:
    """The turn through the air, the same way round as that over ground."""
    return turn if turn * change > 0 else turn + math.copysign(math.tau, change)


@dataclass(frozen=True)
class CornerPlanner:
    """Corners round one waypoint, which differ in how far they turn beyond the new heading."""

    waypoint: Point
    courses: tuple[float, float]
    flying: CornerLimits
    heading: float  # rad, at the beginning
    turn: float  # rad, of the heading, to the right

    def balanced(self, room: float) -> Corner:
        """The corner that goes as far outside of the second leg as inside of both.

        Within MOST_OUTSIDE and, where it can be, ``room`` [m] on that leg.
        """
        most = MOST_OUTSIDE * turn_radius(self.flying.airspeed, self.flying.bank)
        low, high = 0.0, min(MOST_BEYOND, abs(self.turn))
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            corner = self.corner(middle)
            inside, outside = self._distances(corner)
            low, high = (middle, high) if outside < min(inside, most) and corner.after < room else (low, middle)
        return self.corner(low)

    def corner(self, beyond: float) -> Corner:
        """The corner that turns ``beyond`` [rad] further than to the new heading, and back."""
        side, v = math.copysign(1.0, self.turn), self.flying.airspeed
        rate = np.concatenate((_pulse(abs(self.turn) + beyond, self.flying, 1.0), -_pulse(beyond, self.flying, BACK))) * side
        heading = self.heading + _integral(rate)
        velocity = v * np.column_stack((np.cos(heading), np.sin(heading))) + self.flying.wind
        way = np.column_stack([_integral(column) for column in velocity.T])
        along = np.array([(math.cos(c), math.sin(c)) for c in self.courses])
        before, after = np.linalg.solve(along.T, way[-1]).tolist()
        course = np.unwrap(np.arctan2(velocity[:, 1], velocity[:, 0]))
        speed = np.hypot(*velocity.T)
        # Of the velocity over ground only the part through the air turns, with the heading.
        turning = v * rate * np.cos(course - heading) / speed
        return Corner(np.asarray(self.waypoint) - before * along[0] + way, course, turning / speed, before, after)

    def _distances(self, corner: Corner) -> tuple[float, float]:
        """m: how far the corner is cut, and how far the way goes beyond the second leg."""
        d, side = corner.points - self.waypoint, math.copysign(1.0, self.turn)
        first, second = (side * (d[:, 1] * math.cos(c) - d[:, 0] * math.sin(c)) for c in self.courses)
        return float(np.minimum(first, second).max()), float(-second[len(second) // 2 :].min())


def _pulse(angle: float, flying: CornerLimits, share: float) -> Floats:
    """Rates [rad/s] of a turn by ``angle`` [rad]: rolling to a ``share`` of the bank, holding it, rolling out; a small one takes less."""
    if angle < 1e-6:
        return np.zeros(0)
    bank, airspeed, roll_in = share * flying.bank, flying.airspeed, flying.roll_in
    ramp = 0.5 - 0.5 * np.cos(np.pi * np.arange(round(roll_in / STEP) + 1) * STEP / roll_in)
    tangent = math.tan(bank)
    for _ in range(HALVINGS):
        rolling = 2 * _area(np.tan(bank * ramp)) * GRAVITY / airspeed
        if rolling <= angle:
            break
        bank, tangent = bank * angle / rolling, math.tan(bank * angle / rolling)
    steady = GRAVITY / airspeed * tangent
    held = max(angle - rolling, 0.0) / steady
    count = math.ceil(held / STEP)
    shape = np.concatenate((np.tan(bank * ramp), np.full(max(count - 1, 0), tangent), np.tan(bank * ramp[::-1])))
    rates: Floats = GRAVITY / airspeed * shape
    return rates * (angle / _area(rates))


def _area(values: Floats) -> float:
    return float(np.trapezoid(values) * STEP)


def _integral(values: Floats) -> Floats:
    """(k,) from 0 on, by the trapezoidal rule."""
    return np.concatenate(((0.0,), np.cumsum((values[1:] + values[:-1]) / 2) * STEP))
