"""The quickest Dubins path over ground between two poses in a steady wind, and the times between the ends of all swaths.

Words and lengths after Shkel and Lumelsky, "Classification of the Dubins set", Robotics and Autonomous Systems 34 (2001), as in
``uvf.maths.curves``. The radius over ground is the same on every course; the time is that of the ground speed on each course. A pose is
x [m], y [m] and a course [rad] from x towards y.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.coverage.ground_speed import turning

Floats = NDArray[np.float64]

WORDS = 6
TURNS = np.array(((1, 0, 1), (-1, 0, -1), (1, 0, -1), (-1, 0, 1), (1, -1, 1), (-1, 1, -1)), dtype=np.float64)
WHOLE = 1e-9  # rad, by which a turn may fall short of a whole circle and still be none


class Motion(NamedTuple):
    """How a vehicle moves: turning ``radius`` [m], ``table`` (721,) [s/m] and calm ``airspeed`` and ``wind`` of its ``GroundSpeed``."""

    radius: float
    table: Floats
    airspeed: float
    wind: tuple[float, float]


@compiled
def speed_on(motion: Motion, course: float) -> float:
    """Ground speed [m/s] on a course [rad]."""
    c, s = np.cos(course), np.sin(course)
    across = motion.wind[1] * c - motion.wind[0] * s
    speed: float = motion.wind[0] * c + motion.wind[1] * s + np.sqrt(motion.airspeed**2 - across**2)
    return speed


@compiled
def _turn(angle: float) -> float:
    turned = angle % (2 * np.pi)
    return 0.0 if turned > 2 * np.pi - WHOLE or turned < 1e-12 else turned


@compiled
def word(kind: int, d: float, alpha: float, beta: float) -> tuple[float, float, float]:
    """Lengths over the radius of the word ``TURNS[kind]`` for a distance ``d`` over the radius; the first is infinite where there is none.

    alpha, beta: courses [rad] at both ends against the line from the one to the other.
    """
    mirror = 1.0 if kind % 2 == 0 else -1.0
    a, b = mirror * alpha, mirror * beta
    if kind < 2:
        across, along = np.cos(b) - np.cos(a), d + np.sin(a) - np.sin(b)
        straight = np.hypot(across, along)
        tangent = np.arctan2(across, along) if straight > 1e-12 else a
        return _turn(tangent - a), straight, _turn(b - tangent)
    if kind < 4:
        across, along = -np.cos(a) - np.cos(b), d + np.sin(a) + np.sin(b)
        squared = across**2 + along**2 - 4
        if squared < -1e-12:
            return np.inf, 0.0, 0.0
        straight = np.sqrt(max(squared, 0.0))
        tangent = np.arctan2(across, along) - np.arctan2(-2.0, straight)
        return _turn(tangent - a), straight, _turn(tangent - b)
    across, along = np.cos(a) - np.cos(b), d + np.sin(a) - np.sin(b)
    cosine = 1 - (across**2 + along**2) / 8
    if cosine < -1:
        return np.inf, 0.0, 0.0
    middle = 2 * np.pi - np.arccos(cosine)
    first = _turn(-a - np.arctan2(across, along) + middle / 2)
    return first, middle, _turn(b - a - first + middle)


@compiled
def quickest(start: Floats, end: Floats, motion: Motion) -> tuple[float, int]:
    """Time [s] of the quickest path from pose to pose (3,), and its word in ``TURNS``; -1: turned on the spot, with a radius of 0."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    away = np.hypot(dx, dy)
    if motion.radius <= 0.0:
        return (away / speed_on(motion, np.arctan2(dy, dx)) if away > 0 else 0.0), -1
    direction = np.arctan2(dy, dx)
    best, kind = np.inf, 0
    for k in range(WORDS):
        first, middle, last = word(k, away / motion.radius, start[2] - direction, end[2] - direction)
        if first == np.inf:
            continue
        time = _time(k, (first, middle, last), start[2], motion)
        if time < best - 1e-9:
            best, kind = time, k
    return best, kind


@compiled
def _time(kind: int, lengths: tuple[float, float, float], course: float, motion: Motion) -> float:
    """s along a word whose lengths over the radius are given."""
    time = 0.0
    for k in range(3):
        turn = TURNS[kind, k]
        if turn == 0.0:
            time += lengths[k] * motion.radius / speed_on(motion, course)
        else:
            onto = course + turn * lengths[k]
            time += motion.radius * abs(turning(motion.table, onto) - turning(motion.table, course))
            course = onto
    return time


@compiled
def times_between(leaving: Floats, entering: Floats, motion: Motion, out: Floats) -> None:
    """Writes the times (n, m) [s] from each pose of ``leaving`` (n, 3) to each of ``entering`` (m, 3) into ``out``."""
    for i in range(len(leaving)):
        for j in range(len(entering)):
            out[i, j] = quickest(leaving[i], entering[j], motion)[0]


def segments_of(start: Floats, end: Floats, motion: Motion) -> Floats:
    """The quickest path from pose to pose (3,) as segments (k, 5): x, y [m], course [rad], curvature [1/m], length [m].

    With a radius of 0: straight from place to place, turned on the spot at both.
    """
    _, kind = quickest(start, end, motion)
    direction = float(np.arctan2(end[1] - start[1], end[0] - start[0]))
    away = float(np.hypot(*(end[:2] - start[:2])))
    if kind < 0:
        return np.array(((start[0], start[1], direction, 0.0, away),)) if away > 0 else np.empty((0, 5))
    lengths = np.array(word(kind, away / motion.radius, start[2] - direction, end[2] - direction)) * motion.radius
    found, pose = [], np.array(start, dtype=np.float64)
    for turn, length in zip(TURNS[kind] / motion.radius, lengths, strict=True):
        if length > 0.0:
            found.append((*pose, turn, length))
            pose = moved(pose, turn, float(length))
    return np.array(found).reshape(-1, 5)


def moved(pose: Floats, curvature: float, length: float) -> Floats:
    """The pose (3,) after ``length`` [m] along an arc of ``curvature`` [1/m]; the half angle keeps short arcs exact."""
    half = curvature * length / 2
    chord = length * np.sinc(half / np.pi)
    return np.array((pose[0] + chord * np.cos(pose[2] + half), pose[1] + chord * np.sin(pose[2] + half), pose[2] + 2 * half))
