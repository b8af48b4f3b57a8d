"""Dubins paths: the shortest way between two configurations in the plane that never turns tighter than a radius.

A configuration is x [m], y [m] and a course [rad] from x towards y; curvatures are positive in that sense. So (x, y) = (east, north)
has courses counter-clockwise and a positive curvature turns left; (north, east) has courses clockwise and it turns right.

Lengths after Shkel and Lumelsky, "Classification of the Dubins set", Robotics and Autonomous Systems 34 (2001); the way as
Beard & McLain 11.3. Words with the turns exchanged are the mirrored ones, so that three formulas give all six.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from math import acos, atan2, cos, hypot, remainder, sin, sqrt, tau

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Triple = tuple[float, float, float]

WHOLE = 1e-9  # rad, by which a turn may fall short of a whole circle and still be none


@dataclass(frozen=True)
class DubinsPath:
    """A path of three segments from ``start`` (x, y, course) [m, m, rad].

    ``turns`` are the segments' curvatures times ``radius`` [m]: 1, 0 or -1; ``lengths`` [m] are their lengths.
    """

    start: Triple
    radius: float
    turns: tuple[int, int, int]
    lengths: Triple

    @property
    def length(self) -> float:
        """Length of the whole path [m]."""
        return sum(self.lengths)

    @property
    def word(self) -> str:
        """The kinds of the three segments, as letters: L (positive curvature), S (straight) and R (negative curvature)."""
        return "".join("SLR"[turn] for turn in self.turns)

    @cached_property
    def joints(self) -> tuple[Triple, Triple, Triple, Triple]:
        """Configurations (x, y, course) [m, m, rad] where the segments begin, and the end; courses are not wrapped."""
        found = [self.start]
        for turn, length in zip(self.turns, self.lengths, strict=True):
            x, y, course = _move(found[-1], turn / self.radius, np.array([length]))
            found.append((float(x[0]), float(y[0]), float(course[0])))
        return found[0], found[1], found[2], found[3]

    def at(self, s: Floats) -> Floats:
        """Configurations (k, 3) x, y [m], course [rad], not wrapped, at the arc lengths ``s`` (k,) [m]; straight on beyond both ends."""
        begins = np.cumsum((0.0, *self.lengths))
        found = np.empty((len(s), 3))
        which = np.searchsorted(begins, s, side="right") - 1
        for i, joint in zip((-1, 0, 1, 2, 3), (self.start, *self.joints), strict=True):
            k = which == i
            curvature = self.turns[i] / self.radius if 0 <= i < 3 else 0.0
            found[k] = np.column_stack(_move(joint, curvature, s[k] - begins[max(i, 0)]))
        return found

    def curvature(self, s: Floats) -> Floats:
        """Curvature (k,) [1/m] at the arc lengths ``s`` (k,) [m]; 0 beyond both ends."""
        which = np.searchsorted(np.cumsum((0.0, *self.lengths)), s, side="right")
        return np.array((0, *self.turns, 0))[which] / self.radius

    def nearest(self, x: float, y: float) -> tuple[float, float]:
        """(arc length [m], distance [m]) of the point of the path that is nearest to (x, y) [m]."""
        begin, best = 0.0, (0.0, hypot(x - self.start[0], y - self.start[1]))
        for joint, turn, length in zip(self.joints, self.turns, self.lengths, strict=False):
            along, distance = _nearest(joint, turn * self.radius, length, (x, y))
            if distance < best[1]:
                best = begin + along, distance
            begin += length
        return best


def _move(start: Triple, curvature: float, s: Floats) -> tuple[Floats, Floats, Floats]:
    """x, y, course after the lengths ``s`` [m]; the half angle keeps short arcs exact."""
    half = curvature * s / 2
    chord = s * np.sinc(half / np.pi)
    return start[0] + chord * np.cos(start[2] + half), start[1] + chord * np.sin(start[2] + half), start[2] + 2 * half


def _nearest(start: Triple, radius: float, length: float, point: tuple[float, float]) -> tuple[float, float]:
    """(m along one segment, distance [m]); ``radius`` with the sign of the turn, 0 = straight."""
    x, y, course = start
    dx, dy = point[0] - x, point[1] - y
    ahead, aside = dx * cos(course) + dy * sin(course), dy * cos(course) - dx * sin(course)
    if radius == 0:
        along = min(max(ahead, 0.0), length)
        return along, hypot(ahead - along, aside)
    side, size = (1.0 if radius > 0 else -1.0), abs(radius)
    turned = atan2(ahead, size - side * aside) % tau
    if turned * size > length:
        end = length / size
        gaps = [hypot(ahead - size * sin(a), side * aside - size * (1 - cos(a))) for a in (0.0, end)]
        return (0.0, gaps[0]) if gaps[0] <= gaps[1] else (length, gaps[1])
    return turned * size, abs(hypot(ahead, side * aside - size) - size)


def dubins_path(start: Triple, end: Triple, radius: float) -> DubinsPath:
    """Shortest Dubins path between the configurations ``start`` and ``end`` (x, y, course) [m, m, rad] with turns of ``radius`` [m].

    Raises ValueError for a radius that is not positive.
    """
    return min(dubins_paths(start, end, radius), key=lambda path: path.length)


def dubins_paths(start: Triple, end: Triple, radius: float) -> list[DubinsPath]:
    """Dubins paths of every word that leads from ``start`` to ``end`` (x, y, course) [m, m, rad], with turns of ``radius`` [m].

    There are at least two. Raises ValueError for a radius that is not positive.
    """
    if not radius > 0:
        raise ValueError(f"a turning radius of {radius:g} m")
    dx, dy = end[0] - start[0], end[1] - start[1]
    direction = atan2(dy, dx)
    problem = hypot(dx, dy) / radius, start[2] - direction, end[2] - direction
    return [DubinsPath(start, radius, turns, (t * radius, p * radius, q * radius)) for turns, (t, p, q) in _words(*problem)]


def _words(d: float, alpha: float, beta: float) -> Iterator[tuple[tuple[int, int, int], Triple]]:
    """Turns and lengths over the radius."""
    formulas: tuple[tuple[tuple[int, int, int], Callable[[float, float, float], Triple | None]], ...] = (
        ((1, 0, 1), _same_turns),
        ((1, 0, -1), _opposite_turns),
        ((1, -1, 1), _three_turns),
    )
    for turns, formula in formulas:
        for mirror in (1, -1):
            found = formula(d, mirror * alpha, mirror * beta)
            if found is not None:
                yield (mirror * turns[0], mirror * turns[1], mirror * turns[2]), found


def _same_turns(d: float, a: float, b: float) -> Triple:
    """LSL: along the outer tangent of two circles."""
    across, along = cos(b) - cos(a), d + sin(a) - sin(b)
    straight = hypot(across, along)
    tangent = atan2(across, along) if straight > 1e-12 else a
    return _turn(tangent - a), straight, _turn(b - tangent)


def _opposite_turns(d: float, a: float, b: float) -> Triple | None:
    """LSR: along the inner tangent; none while the circles overlap."""
    across, along = -cos(a) - cos(b), d + sin(a) + sin(b)
    squared = across**2 + along**2 - 4
    if squared < -1e-12:
        return None
    straight = sqrt(max(squared, 0.0))
    tangent = atan2(across, along) - atan2(-2.0, straight)
    return _turn(tangent - a), straight, _turn(tangent - b)


def _three_turns(d: float, a: float, b: float) -> Triple | None:
    """LRL: over a third circle that touches both; none where they are too far apart. Its turn is more than half a circle."""
    across, along = cos(a) - cos(b), d + sin(a) - sin(b)
    cosine = 1 - (across**2 + along**2) / 8
    if cosine < -1:
        return None
    middle = tau - acos(cosine)
    first = _turn(-a - atan2(across, along) + middle / 2)
    return first, middle, _turn(b - a - first + middle)


def _turn(angle: float) -> float:
    """0 to 2 pi; what is whole but for rounding is nothing."""
    turned = angle % tau
    return turned if turned < tau - WHOLE and abs(remainder(angle, tau)) > 1e-15 else 0.0
