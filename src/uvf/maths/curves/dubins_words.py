"""Shortest Dubins paths for planners, which ask for millions: compiled, one pair at a time or in batch.

The formulas are those of ``dubins`` (Shkel and Lumelsky 2001), which stays free of the compiler for those who ask once in a while.
Words are numbered as in ``WORDS``; each odd one is the mirrored one before it.
"""

from math import acos, atan2, cos, hypot, inf, pi, sin, sqrt, tau

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import Triple, checked_pairs, checked_radius

Floats = NDArray[np.float64]
Words = NDArray[np.int8]
Angles = tuple[float, float, float, float, float, float]

WORDS = ("LSL", "RSR", "LSR", "RSL", "LRL", "RLR")
TURNS = np.array([["SLR".index(letter) for letter in word] for word in WORDS])
TURNS[TURNS == 2] = -1
"""(6, 3): 1 left, 0 straight, -1 right."""

NEARLY_WHOLE = 1e-12  # rad
"""By which a turn may fall short of a whole circle, for rounding, and still be none."""


@compiled
def _turn(angle: float) -> float:
    """0 to 2 pi; what is whole but for rounding is nothing."""
    turned = angle - tau * np.floor(angle / tau)
    return turned if turned < tau - NEARLY_WHOLE else 0.0


@compiled
def _same_turns(across: float, along: float, a: float, b: float) -> Triple:
    """LSL: along the outer tangent; (across, along) from the one circle's centre to the other's, a and b the headings."""
    straight = sqrt(across * across + along * along)
    if straight < NEARLY_WHOLE:
        return _turn(b - a), 0.0, 0.0
    tangent = atan2(across, along)
    # On a short straight the tangent's angle is uncertain, so that a turn of nothing may seem to be one of nearly a circle.
    whole = tau - NEARLY_WHOLE * (1.0 + 1.0 / straight)
    first, last = _turn(tangent - a), _turn(b - tangent)
    if first > whole:
        return 0.0, straight, _turn(b - a)
    if last > whole:
        return _turn(b - a), straight, 0.0
    return first, straight, last


@compiled
def _opposite_turns(across: float, along: float, a: float, b: float) -> Triple:
    """LSR: along the inner tangent; its straight is inf while the circles overlap."""
    squared = across * across + along * along - 4.0
    if squared < -NEARLY_WHOLE:
        return 0.0, inf, 0.0
    straight = sqrt(max(squared, 0.0))
    tangent = atan2(across, along) - atan2(-2.0, straight)
    return _turn(tangent - a), straight, _turn(tangent - b)


@compiled
def _three_turns(across: float, along: float, a: float, b: float) -> Triple:
    """LRL: over a third circle that touches both; its turn is inf where they are too far apart."""
    cosine = 1.0 - (across * across + along * along) / 8.0
    if cosine < -1.0 - NEARLY_WHOLE:
        return 0.0, inf, 0.0
    middle = tau - acos(min(max(cosine, -1.0), 1.0))
    first = _turn(-a - atan2(across, along) + middle / 2.0)
    return first, middle, _turn(b - a - first + middle)


@compiled
def _normal(start: Triple, goal: Triple, radius: float) -> Triple:
    """Distance over the radius, and both headings [rad] from the line between the places."""
    dx, dy = (goal[0] - start[0]) / radius, (goal[1] - start[1]) / radius
    direction = atan2(dy, dx)
    return hypot(dx, dy), start[2] - direction, goal[2] - direction


@compiled
def dubins_word(word: int, start: Triple, goal: Triple, radius: float) -> Triple:
    """Lengths over the radius of the three segments of a word between two configurations (x, y [m], heading [rad]); inf for none."""
    d, a, b = _normal(start, goal, radius)
    if word % 2 == 1:
        a, b = -a, -b
    if word < 2:
        return _same_turns(cos(b) - cos(a), d + sin(a) - sin(b), a, b)
    if word < 4:
        return _opposite_turns(-cos(a) - cos(b), d + sin(a) + sin(b), a, b)
    return _three_turns(cos(a) - cos(b), d + sin(a) - sin(b), a, b)


@compiled
def shortest_dubins(start: Triple, goal: Triple, radius: float) -> tuple[int, float, float, float]:
    """(word, lengths over ``radius`` [m] of its three segments) of the shortest path between configurations (x, y [m], heading [rad])."""
    d, a, b = _normal(start, goal, radius)
    sin_a, cos_a, sin_b, cos_b = sin(a), cos(a), sin(b), cos(b)
    word, best, found = 0, inf, (0.0, 0.0, 0.0)
    for k in range(6):
        side = 1.0 if k % 2 == 0 else -1.0
        # Nothing but the straight part, or the half circle of a third turn, is known to be needed: enough to leave most words out.
        if k < 2:
            across, along = cos_b - cos_a, d + side * (sin_a - sin_b)
            if across * across + along * along >= best * best:
                continue
            way = _same_turns(across, along, side * a, side * b)
        elif k < 4:
            across, along = -cos_a - cos_b, d + side * (sin_a + sin_b)
            if across * across + along * along - 4.0 >= best * best:
                continue
            way = _opposite_turns(across, along, side * a, side * b)
        else:
            if best <= pi or d > 6.0:
                continue
            way = _three_turns(cos_a - cos_b, d + side * (sin_a - sin_b), side * a, side * b)
        length = way[0] + way[1] + way[2]
        if length < best:
            word, best, found = k, length, way
    return word, found[0], found[1], found[2]


@compiled
def dubins_length(start: Triple, goal: Triple, radius: float) -> float:
    """Length [m] of the shortest path between configurations (x, y [m], heading [rad])."""
    _, t, p, q = shortest_dubins(start, goal, radius)
    return (t + p + q) * radius


@compiled
def dubins_segments(start: Triple, goal: Triple, radius: float, out: Floats) -> float:
    """Writes the shortest path's segments, signed length [m] and curvature [1/m], into ``out`` (k >= 3, 2); its length [m]."""
    word, t, p, q = shortest_dubins(start, goal, radius)
    out[:, :] = 0.0
    out[0, 0], out[1, 0], out[2, 0] = t * radius, p * radius, q * radius
    for k in range(3):
        out[k, 1] = TURNS[word, k] / radius
    return (t + p + q) * radius


@compiled
def _lengths(starts: Floats, goals: Floats, radius: float, lengths: Floats, words: Words) -> None:
    for i in range(lengths.size):
        start, goal = (starts[i, 0], starts[i, 1], starts[i, 2]), (goals[i, 0], goals[i, 1], goals[i, 2])
        word, t, p, q = shortest_dubins(start, goal, radius)
        lengths[i], words[i] = (t + p + q) * radius, word


def dubins_lengths(starts: Floats, goals: Floats, radius: float) -> tuple[Floats, Words]:
    """Lengths (n,) [m] and words (n,), indices into ``WORDS``, of the shortest paths from ``starts`` to ``goals``.

    starts, goals: (n, 3) x [m], y [m], heading [rad]; radius: [m]. Raises ValueError for other shapes, what is not finite, and a radius
    that is not positive.
    """
    radius = checked_radius(radius)
    starts, goals = checked_pairs(starts, goals)
    lengths, words = np.empty(len(starts)), np.empty(len(starts), dtype=np.int8)
    _lengths(starts, goals, radius, lengths, words)
    return lengths, words
