"""How well a sweep fits a known map at many poses at once: the likelihood field (Thrun et al. 2005, section 6.4), with ways.

What the field alone does not know: a beam that ends in front of a wall has met something new, which happens; one that has gone
through a wall has not been measured there.
"""

from dataclasses import dataclass
from math import log

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.localization.known_map import OUTSIDE, UNKNOWN, KnownMap
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]
Field = tuple[NDArray[np.float32], float, float, float]
"""Distances [m] as of KnownMap, corner x and y and side of their cells [m]."""

SIGMA = 0.08  # m, of a beam's end
RANDOM, SHORT, NEUTRAL = 0.03, 0.12, 0.25
"""Likelihood, beside 1 for an end on a wall, of an end behind a wall, before one, and where the map knows nothing."""
LOG_RANDOM, LOG_NEUTRAL = log(RANDOM), log(NEUTRAL)
INDEPENDENT = 12.0
"""Beams that a whole sweep tells as much as: neighbours err together."""
OPEN = 0.35  # m from any wall: who is there after he has met one has gone through it
STRIDE = 0.9  # of the distance to the nearest wall that a beam can be followed at once


@dataclass(frozen=True)
class BeamLikelihood:
    """Beams of a sweep in the base frame: their ends (n, 2) [m], and the lidar's place (x, y) [m]."""

    ends: Floats
    origin: tuple[float, float]


@dataclass(frozen=True)
class Scores:
    """Scores (n,) of a sweep, one for each pose. logs: log-likelihood of the sweep; fits, against: shares of its beams, 0..1.

    ``fits`` are on walls, ``against`` have gone through one or end where the map knows free floor; the rest ends where it knows nothing.
    """

    logs: Floats
    fits: Floats
    against: Floats


def beams_of(reading: Reading, most: int) -> BeamLikelihood:
    """At most ``most`` beams of a reading, evenly taken, of those that came back.

    No return tells nothing: black things and glass give none either.
    """
    returned = np.flatnonzero(reading.returned)
    taken = returned[:: max(1, -(-len(returned) // most))]
    return BeamLikelihood(
        reading.beams.directions[taken] * reading.ranges[taken, None] + np.array(reading.beams.origin), reading.beams.origin
    )


def field_of(known: KnownMap) -> Field:
    """The distances of a known map and where its cells lie, for compiled kernels."""
    return known.distances, known.grid.origin.x, known.grid.origin.y, known.grid.resolution


@compiled
def distance_at(field: Field, x: float, y: float) -> float:
    """Distance [m] from (x, y) [m, map] to the nearest wall, between the cells' middles; where nothing is known, as much below -1."""
    distances, left, low, cell = field
    u, v = (x - left) / cell - 0.5, (y - low) / cell - 0.5
    c, r = int(np.floor(u)), int(np.floor(v))
    if c < 0 or r < 0 or c + 1 >= distances.shape[1] or r + 1 >= distances.shape[0]:
        return OUTSIDE
    a, b, e, f = distances[r, c], distances[r, c + 1], distances[r + 1, c], distances[r + 1, c + 1]
    if a < 0.0 or b < 0.0 or e < 0.0 or f < 0.0:
        return float(distances[int(np.floor(v + 0.5)), int(np.floor(u + 0.5))])
    u, v = u - c, v - r
    return float((1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * e + u * f))


@compiled
def _goes_through(field: Field, origin: tuple[float, float], end: tuple[float, float]) -> bool:
    """Whether a wall stands between two places, with room behind it: followed from distance to distance (Hart 1996)."""
    cell = field[3]
    dx, dy = end[0] - origin[0], end[1] - origin[1]
    length = np.sqrt(dx * dx + dy * dy)
    met, s = False, 0.0
    while s < length:
        d = distance_at(field, origin[0] + dx * s / length, origin[1] + dy * s / length)
        d = d if d >= 0.0 else UNKNOWN - d
        if d < 0.5 * cell:
            met = True
        elif met and d > OPEN:
            return True
        s += max(STRIDE * d, cell)
    return False


@compiled
def _placed(pose: Floats, x: float, y: float) -> tuple[float, float]:
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return pose[0] + c * x - s * y, pose[1] + s * x + c * y


@compiled
def _ways(poses: Floats, beams: tuple[Floats, tuple[float, float]], field: Field) -> Mask:
    ends, origin = beams
    out = np.empty((poses.shape[0], ends.shape[0]), dtype=np.bool_)
    for k in range(poses.shape[0]):
        from_ = _placed(poses[k], origin[0], origin[1])
        for i in range(ends.shape[0]):
            out[k, i] = _goes_through(field, from_, _placed(poses[k], ends[i, 0], ends[i, 1]))
    return out


@compiled
def _scores(poses: Floats, beams: tuple[Floats, tuple[float, float]], field: Field, ways: tuple[Mask, Ints]) -> Floats:
    """(3, n) of each pose: log-likelihood of all beams, how many of them are on walls, how many tell against it."""
    ends, origin = beams
    blocked, of = ways
    out = np.zeros((3, poses.shape[0]))
    for k in range(poses.shape[0]):
        c, s = np.cos(poses[k, 2]), np.sin(poses[k, 2])
        from_ = _placed(poses[k], origin[0], origin[1])
        for i in range(ends.shape[0]):
            x, y = poses[k, 0] + c * ends[i, 0] - s * ends[i, 1], poses[k, 1] + s * ends[i, 0] + c * ends[i, 1]
            if blocked[of[k], i] if of[k] >= 0 else _goes_through(field, from_, (x, y)):
                out[0, k] += LOG_RANDOM
                out[2, k] += 1.0
                continue
            d = distance_at(field, x, y)
            if d < 0.0:
                out[0, k] += LOG_NEUTRAL
                continue
            hit = np.exp(-d * d / (2.0 * SIGMA * SIGMA))
            out[0, k] += np.log((1.0 - SHORT) * hit + SHORT)
            out[1, k] += hit
            out[2, k] += 1.0 - hit
    return out


def ways(poses: Floats, beams: BeamLikelihood, field: Field) -> Mask:
    """Whether each beam has gone through a wall, (poses, beams), seen from poses (n, 3) [m, m, rad, map]."""
    return _ways(poses, (beams.ends, beams.origin), field)


def scores(poses: Floats, beams: BeamLikelihood, field: Field, blocked: Mask, of: Ints) -> Scores:
    """Scores of a sweep at poses (n, 3) [m, m, rad, map].

    blocked: as of ``ways`` at some places; of: (n,) which of these places is a pose's, -1 for none.
    """
    logs, fits, against = _scores(poses, (beams.ends, beams.origin), field, (blocked, of))
    n = max(len(beams.ends), 1)
    return Scores(logs * min(1.0, INDEPENDENT / n), fits / n, against / n)


def fits_at(poses: Floats, beams: BeamLikelihood, field: Field) -> Scores:
    """Scores of a sweep at poses (n, 3) [m, m, rad, map], with all beams followed from each pose."""
    return scores(poses, beams, field, np.zeros((0, len(beams.ends)), dtype=np.bool_), np.full(len(poses), -1))
