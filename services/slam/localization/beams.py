"""How well a sweep fits a known map at many poses at once: the likelihood field (Thrun et al. 2005, section 6.4), with ways.

What the field alone does not know: a beam that ends in front of a wall has met something new, which happens; one that has gone
through a wall has not been measured there.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.slam.localization.known_map import KnownMap
from services.slam.reading import Reading
from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Field = tuple[NDArray[np.float32], float, float, float]
"""Distances [m] as of KnownMap, corner x and y and side of their cells [m]."""

SIGMA = 0.08  # m, of a beam's end
RANDOM, SHORT, UNKNOWN = 0.03, 0.12, 0.25
"""Likelihood, beside 1 for an end on a wall, of an end anywhere, before a wall, and where the map knows nothing."""
INDEPENDENT = 12.0
"""Beams that a whole sweep tells as much as: neighbours err together."""
OPEN = 0.35  # m from any wall: who is there after he has met one has gone through it
STRIDE = 0.9  # of the distance to the nearest wall that a beam can be followed at once


@dataclass(frozen=True)
class Beams:
    """ends: (n, 2) m, where beams came back from; origin: (x, y) m of the lidar; base frame."""

    ends: Floats
    origin: tuple[float, float]


def beams_of(reading: Reading, most: int) -> Beams:
    """At most so many, evenly taken; what gave no return tells nothing: black things and glass give none either."""
    returned = np.flatnonzero(reading.returned)
    taken = returned[:: max(1, -(-len(returned) // most))]
    return Beams(reading.beams.directions[taken] * reading.ranges[taken, None] + np.array(reading.beams.origin), reading.beams.origin)


def field_of(known: KnownMap) -> Field:
    return known.distances, known.grid.origin.x, known.grid.origin.y, known.grid.resolution


@compiled
def distance_at(field: Field, x: float, y: float) -> float:
    """m to the nearest wall, between the cells' middles; -1 where nothing is known."""
    distances, left, low, cell = field
    u, v = (x - left) / cell - 0.5, (y - low) / cell - 0.5
    c, r = int(np.floor(u)), int(np.floor(v))
    if c < 0 or r < 0 or c + 1 >= distances.shape[1] or r + 1 >= distances.shape[0]:
        return -1.0
    a, b, e, f = distances[r, c], distances[r, c + 1], distances[r + 1, c], distances[r + 1, c + 1]
    if a < 0.0 or b < 0.0 or e < 0.0 or f < 0.0:
        return float(distances[int(np.floor(v + 0.5)), int(np.floor(u + 0.5))])
    u, v = u - c, v - r
    return float((1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * e + u * f))


@compiled
def _goes_through(field: Field, origin: tuple[float, float], end: tuple[float, float]) -> bool:
    """Whether a wall stands between two places, with open floor behind it: followed from distance to distance (Hart 1996)."""
    cell = field[3]
    dx, dy = end[0] - origin[0], end[1] - origin[1]
    length = np.sqrt(dx * dx + dy * dy)
    met, s = False, 0.0
    while s < length:
        d = distance_at(field, origin[0] + dx * s / length, origin[1] + dy * s / length)
        if d >= 0.0 and d < 0.5 * cell:
            met = True
        elif met and d > OPEN:
            return True
        s += max(STRIDE * d, cell) if d >= 0.0 else 2.0 * cell
    return False


@compiled
def _scores(poses: Floats, beams: tuple[Floats, tuple[float, float]], field: Field, follows: bool) -> tuple[Floats, Floats]:
    """(log-likelihood of all beams, share of the ends that are on walls where the map knows) of each pose."""
    ends, origin = beams
    logs, shares = np.zeros(poses.shape[0]), np.zeros(poses.shape[0])
    for k in range(poses.shape[0]):
        c, s = np.cos(poses[k, 2]), np.sin(poses[k, 2])
        from_ = (poses[k, 0] + c * origin[0] - s * origin[1], poses[k, 1] + s * origin[0] + c * origin[1])
        seen, fits = 0.0, 0.0
        for i in range(ends.shape[0]):
            x, y = poses[k, 0] + c * ends[i, 0] - s * ends[i, 1], poses[k, 1] + s * ends[i, 0] + c * ends[i, 1]
            d = distance_at(field, x, y)
            if d < 0.0:
                logs[k] += np.log(UNKNOWN)
                continue
            hit = np.exp(-d * d / (2.0 * SIGMA * SIGMA))
            through = (follows or hit < 0.1) and _goes_through(field, from_, (x, y))
            seen += 1.0
            fits += 0.0 if through else hit
            logs[k] += np.log(RANDOM + (0.0 if through else (1.0 - SHORT) * hit + SHORT - RANDOM))
        if seen > 0.25 * ends.shape[0]:
            shares[k] = fits / seen
        else:
            shares[k] = -1.0
    return logs, shares


def scores(poses: Floats, beams: Beams, field: Field, follows: bool) -> tuple[Floats, Floats]:
    """Of poses (n, 3): (log-likelihood (n,) of the sweep, share (n,) 0..1 of it that fits, -1 where the map does not know enough).

    follows: each beam is looked along for walls, not only those that end before or behind one.
    """
    logs, shares = _scores(poses, (beams.ends, beams.origin), field, follows)
    return logs * min(1.0, INDEPENDENT / max(len(beams.ends), 1)), shares
