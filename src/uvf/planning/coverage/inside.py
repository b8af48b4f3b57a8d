"""Shortest ways that stay inside a field: its visibility graph (Lozano-Perez & Wesley 1979), and passes along its borders."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse.csgraph import shortest_path

from uvf.planning.coverage.field import CoverageField

Floats = NDArray[np.float64]

TOLERANCE = 1e-3  # m, by which a way may cut a border
MOST_PLACES = 3_000


@dataclass(frozen=True)
class InsideWays:
    """Shortest ways among ``places`` (p, 2) [m]: ``lengths`` (p, p) [m], infinite where there is none, and who comes before whom."""

    places: Floats
    lengths: Floats
    before: NDArray[np.int32]

    def way(self, start: int, end: int) -> Floats:
        """Corners (k, 2) [m] of the shortest way from one place, by its index, to another. Raises ValueError where there is none."""
        if not np.isfinite(self.lengths[start, end]):
            raise ValueError("the field is in parts that no way inside joins; plan each part on its own")
        order = [end]
        while order[-1] != start:
            order.append(int(self.before[start, order[-1]]))
        return self.places[order[::-1]]


def ways_inside(field: CoverageField, places: Floats) -> InsideWays:
    """Shortest ways inside ``field`` among ``places`` (p, 2) [m], which lie in it. Raises ValueError for more than 3 000 places."""
    every = np.concatenate((places, _bends(field)))
    if len(every) > MOST_PLACES:
        raise ValueError(f"{len(every)} ends of swaths and corners, {MOST_PLACES} at most; widen the swaths or simplify the field")
    one, other = np.triu_indices(len(every), 1)
    room = field.shape.buffer(TOLERANCE)
    shapely.prepare(room)
    seen = shapely.covers(room, shapely.linestrings(np.stack((every[one], every[other]), axis=1)))
    lengths = np.zeros((len(every), len(every)))
    away = np.hypot(*(every[one] - every[other]).T)
    lengths[one[seen], other[seen]] = np.maximum(away[seen], 1e-9)
    found, before = shortest_path(lengths, directed=False, return_predecessors=True, indices=np.arange(len(places)))
    return InsideWays(every, found, before)


def _bends(field: CoverageField) -> Floats:
    """Corners (k, 2) [m] round which a shortest way may bend: those where the field's angle is more than half a turn."""
    bends = []
    for ring in field.rings:
        into, out = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
        bends.append(ring[into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0] < 0.0])
    return np.concatenate(bends)


def border_passes(field: CoverageField, width: float, passes: int, start: Floats) -> list[Floats]:
    """Closed ways (k, 2) [m], first corner repeated, ``passes`` times along every border, the outer one half a ``width`` [m] inside.

    In order: each begins where it is nearest to the end of the one before, the first one nearest to ``start`` (2,) [m].
    """
    rings = []
    for number in range(passes):
        inner = field.shrunk((number + 0.5) * width)
        rings += list(inner.rings) if inner is not None else []
    found: list[Floats] = []
    here = start
    while rings:
        nearest = [np.hypot(*(ring - here).T).min() for ring in rings]
        ring = rings.pop(int(np.argmin(nearest)))
        first = int(np.argmin(np.hypot(*(ring - here).T)))
        found.append(np.concatenate((ring[first:], ring[: first + 1])))
        here = ring[first]
    return found
