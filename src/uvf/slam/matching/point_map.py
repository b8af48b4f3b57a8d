"""Points with normals in a hash of square cells: what a sweep is matched to."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.matching.cloud import Cloud, joined

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CELL = 0.3
"""m; what lies within it of a point is found in nine cells."""

Table = tuple[Floats, Floats, Floats, Ints, float, float, int, int]
"""points and normals (n, 2), weights (n,), sorted by cell; first of each cell (columns * rows + 1); corner x and y [m]; columns, rows."""


@dataclass(frozen=True)
class PointMap:
    """Surfaces in one frame, as points in a hash of cells. table: for the compiled kernels."""

    table: Table

    @property
    def points(self) -> Floats:
        """Points (n, 2) [m] on the surfaces."""
        return self.table[0]


@compiled
def _order(points: Floats, corner: tuple[float, float], shape: tuple[int, int]) -> tuple[Ints, Ints]:
    """Counting sort: (points in the order of their cells, first of each cell)."""
    n = points.shape[0]
    first = np.zeros(shape[0] * shape[1] + 1, dtype=np.int64)
    cells = np.empty(n, dtype=np.int64)
    for i in range(n):
        cells[i] = int((points[i, 0] - corner[0]) / CELL) * shape[1] + int((points[i, 1] - corner[1]) / CELL)
        first[cells[i] + 1] += 1
    for c in range(first.shape[0] - 1):
        first[c + 1] += first[c]
    place = first[:-1].copy()
    order = np.empty(n, dtype=np.int64)
    for i in range(n):
        order[place[cells[i]]] = i
        place[cells[i]] += 1
    return order, first


def point_map(clouds: list[Cloud]) -> PointMap:
    """Point map of the points whose normal is known, of clouds in one frame; surfaces far away are filled."""
    whole = joined(clouds).filled()
    known = whole.flat
    points, normals, weights = whole.points[known], whole.normals[known], whole.weights[known]
    if len(points) == 0:
        return PointMap((points, normals, weights, np.zeros(2, dtype=np.int64), 0.0, 0.0, 1, 1))
    x, y = (float(v) - CELL for v in points.min(axis=0))
    columns, rows = (int(v) + 2 for v in (points.max(axis=0) - (x, y)) / CELL)
    order, first = _order(points, (x, y), (columns, rows))
    return PointMap((points[order], normals[order], weights[order], first, x, y, columns, rows))
