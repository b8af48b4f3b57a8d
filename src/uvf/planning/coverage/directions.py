"""In which direction swaths lie best: strips and a first judgement for each of many directions."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uvf.planning.coverage.ground_speed import GroundSpeed
from uvf.planning.coverage.strips import StripRules, rotated, swaths

Floats = NDArray[np.float64]

EDGES = 24  # the longest, whose directions are tried
SWEEP = math.radians(2.0)
APART = math.radians(0.2)  # directions nearer than that are one
JUDGED_AGAIN = 16  # directions
ONE_LINE = 1e-6  # m, between swaths of one strip
KEPT_APART = math.radians(1.5)


@dataclass(frozen=True)
class Candidate:
    """Swaths (n, 4) [m] in one direction [rad], and the time [s] that they and as many turns take by a rule of thumb."""

    direction: float
    swaths: Floats
    time: float


def candidates(edges: Floats, speed: GroundSpeed, rules: StripRules, only: float | None = None) -> list[Candidate]:
    """Candidates for a field with ``edges`` (m, 4) [m], the quickest first; in the direction ``only`` [rad] alone, if it is given.

    All directions are judged by swaths that cover everything, the best of them again by what ``rules`` ask for.
    """
    if only is not None:
        return [_judged(edges, only, speed, rules)]
    everything = [_judged(edges, direction, speed, replace(rules, share=1.0)) for direction in _directions(edges)]
    best = best_apart(sorted(everything, key=lambda each: each.time), JUDGED_AGAIN)
    return sorted((_judged(edges, each.direction, speed, rules) for each in best), key=lambda each: each.time)


def best_apart(found: list[Candidate], count: int) -> list[Candidate]:
    """The first ``count`` of candidates in order, without those that hardly differ in direction from one before them."""
    kept: list[Candidate] = []
    for each in found:
        if all(_apart(each.direction, other.direction) > KEPT_APART for other in kept):
            kept.append(each)
        if len(kept) == count:
            break
    return kept


def _judged(edges: Floats, direction: float, speed: GroundSpeed, rules: StripRules) -> Candidate:
    lines = swaths(edges, direction, rules)
    slow = float((1.0 / speed.at(np.array((direction, direction + math.pi)))).mean())
    lengths = float(np.hypot(*(lines[:, 2:] - lines[:, :2]).T).sum())
    return Candidate(direction, lines, lengths * slow + _turns(rotated(lines, -direction), rules.each) / speed.airspeed)


def _turns(lines: Floats, each: float) -> float:
    """Length [m] that turns are worth: one for each swath, but no more than the gap for one that lies straight on behind another."""
    straight_on = np.abs(np.diff(lines[:, 1])) < ONE_LINE
    gaps = np.where(straight_on, np.minimum(lines[1:, 0] - lines[:-1, 2], each), each)
    return float(gaps.sum()) + each


def _directions(edges: Floats) -> list[float]:
    """Directions [rad] from 0 to pi: of the edges, in which most of the border lies, then an even sweep."""
    away = edges[:, 2:] - edges[:, :2]
    angles = np.arctan2(away[:, 1], away[:, 0]) % math.pi
    longest = np.argsort(-np.hypot(*away.T), kind="stable")[:EDGES]
    found: list[float] = []
    for angle in (*angles[longest].tolist(), *np.arange(0.0, math.pi, SWEEP).tolist()):
        if all(_apart(angle, other) > APART for other in found):
            found.append(angle)
    return found


def _apart(one: float, other: float) -> float:
    """rad between two directions, which are the same after half a turn."""
    return abs(math.remainder(one - other, math.pi))
