"""The 48 words of Reeds and Shepp: the shortest way of a car that turns no tighter than a radius and drives both ways.

Reeds & Shepp, "Optimal paths for a car that goes both forwards and backwards", Pacific Journal of Mathematics 145 (1990), formulas 8.1
to 8.11, the misprints in 8.3, 8.4 and 8.11 mended as in OMPL's ReedsSheppStateSpace. Eleven formulas, each for the goal as it is, mirrored
(left for right), reversed in time (forwards for backwards) and both, give all words. The paper's conditions on the signs of the lengths
are left out: lengths are signed, so that each solution leads to the goal, and none is lost where a sign is that of a rounding error.
"""

from math import acos, asin, atan2, cos, inf, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import Triple, checked_pairs, checked_radius, wrapped

Floats = NDArray[np.float64]
Place = tuple[float, float, float, float, float]
"""Of the goal over the radius, seen from the start: x, y, heading [rad], its sine and cosine."""
Word = tuple[int, float, float, float, float, float]
"""Formula, its lengths t, u, v over the radius, and 1 or -1 for a reversal in time and for mirroring."""

FORMULAS = ("LSL", "LSR", "LRL", "LRL", "LRLR", "LRLR", "LRSL", "LRSR", "LSRL", "RSRL", "LRSLR")
LETTERS = np.array([["SLR".index(letter) for letter in word.ljust(5, "S")] for word in FORMULAS])
TURNS = np.where(LETTERS == 2, -1, LETTERS)
"""(11, 5): 1 left, 0 straight, -1 right."""

SMALL = 1e-11
"""Of the radius: by so little circles may fail to touch, for rounding, and those whose centres are so near to each other are one."""


@compiled
def _two_angles(u: float, v: float, xi: float, eta: float, phi: float) -> tuple[float, float]:
    """First and last turn of a word of four turns, whose middle ones are known (tau and omega in the paper)."""
    delta = u - v
    a, b = sin(u) - sin(delta), cos(u) - cos(delta) - 1.0
    first = atan2(eta * a - xi * b, xi * a + eta * b)
    if 2.0 * (cos(delta) - cos(v) - cos(u)) + 3.0 < 0.0:
        first += pi
    first = wrapped(first)
    return first, wrapped(first - u + v - phi)


@compiled
def _with_straight(formula: int, place: Place, best: float) -> Triple:
    """t, u, v of CSC: 8.1 and 8.2. u is inf where there is none below ``best``."""
    x, y, phi, s, c = place
    if formula == 0:
        xi, eta = x - s, y - 1.0 + c
        u = sqrt(xi * xi + eta * eta)
        t = atan2(eta, xi) if u > SMALL else 0.0
        return (t, u, wrapped(phi - t)) if u < best else (0.0, inf, 0.0)
    xi, eta = x + s, y - 1.0 - c
    squared = xi * xi + eta * eta - 4.0
    if not -SMALL <= squared < best * best:
        return 0.0, inf, 0.0
    u = sqrt(max(squared, 0.0))
    t = wrapped(atan2(eta, xi) + atan2(2.0, u))
    return t, u, wrapped(t - phi)


@compiled
def _with_turns(formula: int, place: Place) -> Triple:
    """t, u, v of CCC and CCCC: 8.3 and 8.4, 8.7, 8.8."""
    x, y, phi, s, c = place
    if formula < 4:
        xi, eta = x - s, y - 1.0 + c
        rho = sqrt(xi * xi + eta * eta)
        if rho > 4.0 + SMALL:
            return 0.0, inf, 0.0
        u = -2.0 * asin(min(0.25 * rho, 1.0))
        t = wrapped((atan2(eta, xi) if rho > SMALL else 0.0) + 0.5 * u + pi)
        return t, u, wrapped(phi - t + u)
    xi, eta = x + s, y - 1.0 - c
    squared = xi * xi + eta * eta
    if formula == 4:
        if squared > 4.0 + SMALL:
            return 0.0, inf, 0.0
        u = acos(min(0.25 * (2.0 + sqrt(squared)), 1.0))
        t, v = _two_angles(u, -u, xi, eta, phi)
        return t, u, v
    rho = (20.0 - squared) / 16.0
    if not 0.0 <= rho <= 1.0 + SMALL:
        return 0.0, inf, 0.0
    u = -acos(min(rho, 1.0))
    t, v = _two_angles(u, u, xi, eta, phi)
    return t, u, v


@compiled
def _with_quarters(formula: int, place: Place, best: float) -> Triple:
    """t, u, v of CCSC and CCSCC, whose second (and fourth) turn is a quarter backwards: 8.9, 8.10, 8.11."""
    x, y, phi, s, c = place
    if formula == 6 or formula == 8:
        xi, eta = x - s, y - 1.0 + c
        squared = xi * xi + eta * eta - 4.0
        r = sqrt(max(squared, 0.0))
        if squared < -SMALL or r > best + 2.0:
            return 0.0, inf, 0.0
        t = wrapped(atan2(eta, xi) + atan2(r, -2.0))
        return t, 2.0 - r, wrapped(phi - 0.5 * pi - t)
    xi, eta = x + s, y - 1.0 - c
    if formula == 10:
        squared = xi * xi + eta * eta - 4.0
        r = sqrt(max(squared, 0.0))
        if squared < -SMALL or r > best + 4.0:
            return 0.0, inf, 0.0
        t = atan2(r * xi - 2.0 * eta, -2.0 * xi - r * eta)
        return t, 4.0 - r, wrapped(t - phi)
    rho = sqrt(xi * xi + eta * eta)
    if rho < 2.0 - SMALL or rho > best + 2.0:
        return 0.0, inf, 0.0
    t = atan2(xi, -eta)
    return t, 2.0 - rho, wrapped(t + 0.5 * pi - phi)


@compiled
def _solved(formula: int, place: Place, best: float) -> tuple[float, float, float, float]:
    """(length, t, u, v) over the radius; the length is inf where there is none below ``best``."""
    seen = place
    if formula == 3 or formula == 8 or formula == 9:
        # The start as it is seen from the goal, so that the word comes out backwards.
        x, y, phi, s, c = place
        seen = (x * c + y * s, x * s - y * c, phi, s, c)
    known = 0.0
    if formula < 2:
        t, u, v = _with_straight(formula, seen, best)
    elif formula < 6:
        t, u, v = _with_turns(formula, seen)
        known = abs(u) if formula > 3 else 0.0
    else:
        t, u, v = _with_quarters(formula, seen, best)
        known = pi if formula == 10 else 0.5 * pi
    return abs(t) + abs(u) + abs(v) + known, t, u, v


@compiled
def _place(start: Triple, goal: Triple, radius: float) -> Place:
    dx, dy = (goal[0] - start[0]) / radius, (goal[1] - start[1]) / radius
    s, c = sin(start[2]), cos(start[2])
    phi = wrapped(goal[2] - start[2])
    return dx * c + dy * s, dy * c - dx * s, phi, sin(phi), cos(phi)


@compiled
def _changed(place: Place, reverse: float, mirror: float) -> Place:
    x, y, phi, s, c = place
    return reverse * x, mirror * y, reverse * mirror * phi, reverse * mirror * s, c


@compiled
def _write(word: Word, radius: float, out: Floats) -> None:
    """Segments of a word, signed length [m] and curvature [1/m]."""
    formula, t, u, v, reverse, mirror = word
    out[:, :] = 0.0
    quarter = -0.5 * pi
    first, last = (v, t) if formula == 3 or formula == 8 or formula == 9 else (t, v)
    out[0, 0], out[1, 0], out[2, 0] = first, u, last
    if formula == 4 or formula == 5:
        out[2, 0], out[3, 0] = (-u if formula == 4 else u), last
    elif formula == 6 or formula == 7:
        out[1, 0], out[2, 0], out[3, 0] = quarter, u, last
    elif formula == 8 or formula == 9:
        out[2, 0], out[3, 0] = quarter, last
    elif formula == 10:
        out[1, 0], out[2, 0], out[3, 0], out[4, 0] = quarter, u, quarter, last
    for k in range(5):
        out[k, 0] *= reverse * radius
        out[k, 1] = mirror * TURNS[formula, k] / radius


@compiled
def _shortest(start: Triple, goal: Triple, radius: float) -> tuple[float, Word]:
    """Length over the radius, and the word."""
    place = _place(start, goal, radius)
    best, word = inf, (0, 0.0, 0.0, 0.0, 1.0, 1.0)
    for formula in range(11):
        for k in range(4):
            reverse, mirror = 1.0 - 2.0 * (k % 2), 1.0 - 2.0 * (k // 2)
            length, t, u, v = _solved(formula, _changed(place, reverse, mirror), best)
            if length < best:
                best, word = length, (formula, t, u, v, reverse, mirror)
    return best, word


@compiled
def reeds_shepp_length(start: Triple, goal: Triple, radius: float) -> float:
    """Length [m] of the shortest path between configurations (x, y [m], heading [rad])."""
    return _shortest(start, goal, radius)[0] * radius


@compiled
def reeds_shepp_segments(start: Triple, goal: Triple, radius: float, out: Floats) -> float:
    """Writes the shortest path's segments, signed length [m] and curvature [1/m], into ``out`` (5, 2); its length [m]."""
    length, word = _shortest(start, goal, radius)
    _write(word, radius, out)
    return length * radius


@compiled
def reeds_shepp_word(number: int, start: Triple, goal: Triple, radius: float, out: Floats) -> float:
    """The same for one word of 0..43, in the order in which the formulas are tried; inf where it does not lead to the goal."""
    reverse, mirror = 1.0 - 2.0 * (number % 2), 1.0 - 2.0 * (number // 2 % 2)
    length, t, u, v = _solved(number // 4, _changed(_place(start, goal, radius), reverse, mirror), inf)
    _write((number // 4, t, u, v, reverse, mirror), radius, out)
    return length * radius


@compiled
def _lengths(starts: Floats, goals: Floats, radius: float, lengths: Floats) -> None:
    for i in range(lengths.size):
        start, goal = (starts[i, 0], starts[i, 1], starts[i, 2]), (goals[i, 0], goals[i, 1], goals[i, 2])
        lengths[i] = _shortest(start, goal, radius)[0] * radius


def reeds_shepp_lengths(starts: Floats, goals: Floats, radius: float) -> Floats:
    """Lengths (n,) [m] of the shortest paths from ``starts`` to ``goals``, (n, 3) x [m], y [m], heading [rad]; radius: [m].

    Raises ValueError for other shapes, what is not finite, and a radius that is not positive.
    """
    radius = checked_radius(radius)
    starts, goals = checked_pairs(starts, goals)
    lengths = np.empty(len(starts))
    _lengths(starts, goals, radius, lengths)
    return lengths
