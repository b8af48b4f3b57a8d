"""Dubins paths for a vehicle that needs time to change its curvature: a word whose curvature rises and falls along clothoids.

The curvature of a word, smoothed over a length (a running mean along the way), has ramps where the word has steps, as in the
continuous-curvature paths of Scheuer & Fraichard, "Continuous-curvature path planning for car-like vehicles", IROS 1997. The lengths
of the three segments are then corrected until the way leads again from the one configuration to the other, straight at both.
"""

from dataclasses import dataclass
from functools import cached_property
from math import asin, atan2, cos, hypot, remainder, sin, tau

import numpy as np
from numpy.typing import NDArray

from uvf.maths.curves.dubins import Triple, dubins_paths

Floats = NDArray[np.float64]
Point = tuple[float, float]

STEP = 1.0  # m, between samples at most, unless that makes more than SAMPLES
SAMPLES = 20_000
ITERATIONS = 12
CLOSE = 1e-6  # m and, times the radius, rad
TOUCHING = 1e-3  # m
NUDGE = 1e-3  # m, for derivatives


@dataclass(frozen=True)
class SampledPath:
    """Samples of a path, (k,) each. Curvatures are positive from x towards y."""

    points: Floats  # (k, 2) m
    course: Floats  # rad, unwrapped
    curvature: Floats  # 1/m

    @cached_property
    def s(self) -> Floats:
        """Arc length (k,) [m] at each sample."""
        steps = np.hypot(*np.diff(self.points, axis=0).T)
        return np.concatenate(((0.0,), np.cumsum(steps)))

    @property
    def length(self) -> float:
        """Length [m] of the path."""
        return float(self.s[-1])

    def nearest(self, position: tuple[float, float], within: tuple[float, float] = (-np.inf, np.inf)) -> Triple:
        """(arc length [m], lateral distance [m], course [rad]) at the point nearest to ``position`` [m]; straight on beyond its ends.

        The lateral distance is positive in the sense of the curvature. Searched where the arc length is ``within`` [m].
        """
        low, high = np.searchsorted(self.s, within)
        low = min(int(low), len(self.s) - 1)
        away = np.asarray(position) - self.points[low : max(int(high), low + 1)]
        i = int(np.argmin(np.einsum("ij,ij->i", away, away)))
        n, e = away[i].tolist()
        i += low
        c, s = cos(self.course[i]), sin(self.course[i])
        ahead = n * c + e * s
        curvature = float(self.curvature[i])
        return float(self.s[i]) + ahead, e * c - n * s - 0.5 * curvature * ahead**2, float(self.course[i]) + curvature * ahead

    def bend(self, s: float) -> float:
        """Curvature [1/m] at the arc length ``s`` [m], 0 before and after the path."""
        return float(np.interp(s, self.s, self.curvature, left=0.0, right=0.0))


def smooth_dubins_path(start: Triple, end: Triple, radius: float, ramp: float, bend: float = 0.0) -> SampledPath:
    """The shortest path of turns and straights from ``start`` to ``end`` with ramps of ``ramp`` [m] between curvatures.

    start, end: (x [m], y [m], course [rad]); radius: [m], smallest; bend: curvature [1/m] at the start. Where no word can be corrected
    (none has been seen), the plain Dubins path. Raises ValueError for a radius that is not positive.
    """
    begin, finish = _ahead(start, ramp / 2), _ahead(end, -ramp / 2)
    words = sorted(dubins_paths(begin, finish, radius), key=lambda path: path.length)
    for path in words:
        word = _Word(start, radius, path.turns, ramp, bend)
        lengths = _corrected(word, path.lengths, end)
        if lengths is not None and lengths.min() > -CLOSE and lengths.max() < tau * radius + sum(path.lengths):
            return word.way(lengths)
    shortest = min(dubins_paths(start, end, radius), key=lambda path: path.length)
    s = np.linspace(0.0, shortest.length, _count(shortest.length))
    x, y, course = shortest.at(s).T
    return SampledPath(np.column_stack((x, y)), course, shortest.curvature(s))


@dataclass(frozen=True)
class _Word:
    start: Triple
    radius: float
    turns: tuple[int, int, int]
    ramp: float
    bend: float = 0.0  # 1/m, at the start
    end: float = 0.0  # 1/m, at the end

    def way(self, lengths: Floats) -> SampledPath:
        total = float(lengths.sum()) + self.ramp
        s = np.linspace(0.0, total, _count(total))
        begins = np.concatenate(((0.0,), np.cumsum(lengths)))
        steps = np.diff((self.bend, *(turn / self.radius for turn in self.turns), self.end))
        since = s[:, None] - begins
        curvature = self.bend + np.clip(since / self.ramp, 0.0, 1.0) @ steps
        course = self.start[2] + self.bend * s + _risen(since, self.ramp) @ steps
        # Simpson's rule, with the course between two samples
        middle = s[:-1] + s[1] / 2
        half = self.start[2] + self.bend * middle + _risen(middle[:, None] - begins, self.ramp) @ steps
        points = [
            np.concatenate(((p,), p + np.cumsum(s[1] / 6 * (f(course[:-1]) + 4 * f(half) + f(course[1:])))))
            for p, f in zip(self.start[:2], (np.cos, np.sin), strict=True)
        ]
        return SampledPath(np.column_stack(points), course, curvature)

    def miss(self, lengths: Floats, end: Triple) -> Floats:
        """(3,) m: ahead, beside and, times the radius, course of the end against the one wanted."""
        way = self.way(lengths)
        d, c, s = way.points[-1] - end[:2], cos(end[2]), sin(end[2])
        return np.array((d[0] * c + d[1] * s, d[1] * c - d[0] * s, self.radius * remainder(way.course[-1] - end[2], tau)))


def _corrected(word: _Word, lengths: Triple, end: Triple) -> Floats | None:
    """Newton's method on the lengths of the segments; None when it leads nowhere."""
    found = np.array(lengths)
    for _ in range(ITERATIONS):
        miss = word.miss(found, end)
        if np.abs(miss).max() < CLOSE:
            return found
        slopes = np.column_stack([(word.miss(found + NUDGE * unit, end) - miss) / NUDGE for unit in np.eye(3)])
        found = found - np.linalg.lstsq(slopes, miss, rcond=1e-6)[0]
        if found.min() < -word.radius or found.max() > tau * word.radius + sum(lengths):
            return None
    return None


def _risen(since: Floats, ramp: float) -> Floats:
    """The integral [m] of a ramp from 0 to 1."""
    up = np.clip(since, 0.0, ramp)
    risen: Floats = up**2 / (2 * ramp) + np.maximum(since - ramp, 0.0)
    return risen


def _ahead(configuration: Triple, distance: float) -> Triple:
    x, y, course = configuration
    return x + distance * cos(course), y + distance * sin(course), course


def _count(length: float) -> int:
    return min(max(int(length / STEP) + 2, 3), SAMPLES)


def turned_onto(start: Triple, point: Point, radius: float, ramp: float, bend: float = 0.0) -> SampledPath | None:
    """The path from ``start`` by one turn, the shorter, until straight on leads through ``point``; None where none is found.

    start: (x [m], y [m], course [rad]); point: [m]; radius and ramp of the turn: [m]; bend: curvature [1/m] at the start. A point within
    the turning circle to one side is reached by the turn to the other.
    """
    ways = [way for side in (1, -1) if (way := _one_turn(_Word(start, radius, (side, 0, 0), ramp, bend), point)) is not None]
    return min(ways, key=lambda way: way.length, default=None)


def turned_onto_circle(start: Triple, circle: Triple, radius: float, ramp: float, bend: float = 0.0) -> SampledPath | None:
    """The path from ``start`` by one turn, then straight on and by a ramp onto ``circle`` in its sense; None from within it.

    start: (x [m], y [m], course [rad]); circle: x, y of the centre [m], its radius [m], positive from x towards y; radius and ramp of
    the turn: [m]; bend: curvature [1/m] at the start. The ramp onto the circle is shorter by its radius; from nearby there is none.
    """
    eased = _Clothoid(circle, ramp * min(radius / abs(circle[2]), 1.0))
    words = [_Word(start, radius, (side, 0, 0), ramp, bend) for side in (1, -1)]
    for onto in (eased, _Clothoid(circle, 0.0)):
        ways = [way for word in words if (way := _turn_and_tangent(word, onto)) is not None]
        if ways:
            return min(ways, key=lambda way: way.length)
    return None


@dataclass(frozen=True)
class _Clothoid:
    """The ramp from a straight line onto a circle: the line passes the circle further outside, and the ramp begins ahead of its foot."""

    circle: Triple
    ramp: float

    def onward(self, start: Triple) -> SampledPath:
        """The ramp from a place [m] and course [rad] on the line."""
        return _Word(start, abs(self.circle[2]), (0, 0, 0), max(self.ramp, CLOSE), end=1 / self.circle[2]).way(np.zeros(3))

    @cached_property
    def offset(self) -> Point:
        """How far [m] ahead of the circle's foot on the line the ramp begins, and how much wider than the circle is one that touches it.

        The second has the sign of the circle's radius.
        """
        ramp, radius = self.onward((0.0, 0.0, 0.0)), self.circle[2]
        (x, y), turned = ramp.points[-1].tolist(), float(ramp.course[-1])
        return x - radius * sin(turned), y - radius * (1 - cos(turned))

    def begins(self, point: Point) -> Point | None:
        """Where the ramp begins on the line from a point that goes onto the circle; None from too near."""
        x, y, radius = self.circle
        before, wider = self.offset
        dx, dy = x - point[0], y - point[1]
        away, wide = hypot(dx, dy), radius + wider
        if away <= abs(wide):
            return None
        course, length = atan2(dy, dx) - asin(wide / away), (away**2 - wide**2) ** 0.5 - before
        return (point[0] + length * cos(course), point[1] + length * sin(course)) if length >= 0 else None

    def after(self, way: SampledPath) -> SampledPath:
        """The way, which ends where the ramp begins, with the ramp."""
        if not self.ramp:
            return way
        x, y = way.points[-1].tolist()
        ramp = self.onward((x, y, float(way.course[-1])))
        parts = ((way.points, ramp.points), (way.course, ramp.course), (way.curvature, ramp.curvature))
        return SampledPath(*(np.concatenate((before, then[1:])) for before, then in parts))


def _turn_and_tangent(word: _Word, onto: _Clothoid) -> SampledPath | None:
    """The turn decides the tangent and the tangent the turn: found by repetition."""
    begins = onto.begins((word.start[0], word.start[1]))
    for _ in range(ITERATIONS):
        way = _one_turn(word, begins) if begins is not None else None
        if way is None or begins is None:
            return None
        before, begins = begins, onto.begins((float(way.points[-1, 0]), float(way.points[-1, 1])))
        if begins is not None and hypot(begins[0] - before[0], begins[1] - before[1]) < TOUCHING:
            return onto.after(_straight_on(way, begins))
    return None


def _straight_on(way: SampledPath, point: Point) -> SampledPath:
    """The way with a straight piece up to ``point``, which lies ahead of its end."""
    last = way.points[-1]
    count = _count(hypot(point[0] - last[0], point[1] - last[1]))
    parts = np.linspace(0.0, 1.0, count)[1:, None]
    points = last + parts * (np.asarray(point) - last)
    courses = np.concatenate((way.course, np.full(count - 1, way.course[-1])))
    return SampledPath(np.concatenate((way.points, points)), courses, np.concatenate((way.curvature, np.zeros(count - 1))))


def _one_turn(word: _Word, point: Point) -> SampledPath | None:
    """The secant method on the length of the turn, from where the circle's tangent leads through the point."""
    side, radius = word.turns[0], word.radius
    x, y, course = _ahead(word.start, word.ramp / 2 * (1 - side * radius * word.bend))
    dx, dy = point[0] - x + side * radius * sin(course), point[1] - y - side * radius * cos(course)
    if hypot(dx, dy) <= radius:
        return None
    tangent = atan2(dy, dx) + side * asin(radius / hypot(dx, dy))
    turned = (side * (tangent - course)) % tau
    length, last, missed = turned * radius, turned * radius + NUDGE, None
    for _ in range(ITERATIONS):
        way = word.way(np.array((length, 0.0, 0.0)))
        (n, e), c = point - way.points[-1], float(way.course[-1])
        if n * cos(c) + e * sin(c) < 0:
            return None
        now = float(e * cos(c) - n * sin(c))
        if abs(now) < CLOSE:
            return way
        slope = (now - missed) / (length - last) if missed is not None else -side * hypot(n, e) / radius
        length, last, missed = length - now / slope, length, now
    return None
