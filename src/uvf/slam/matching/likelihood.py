"""Field of the likelihood of a beam ending at a place, with upper bounds over squares of growing side.

For correlative matching by branch and bound: Olson, "Real-Time Correlative Scan Matching" (2009), for the field; Hess et al.,
"Real-Time Loop Closure in 2D LIDAR SLAM" (2016), section V, for the bounds.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Bytes = NDArray[np.uint8]

FULL = 255
"""Likelihood 1 in the field."""
REACH = 3.0  # sigmas around a point that are filled


@dataclass(frozen=True)
class LikelihoodField:
    """A likelihood field and its bounds, scaled to FULL.

    levels: (level, columns, rows); level l holds at a cell the most in the 2^l x 2^l cells from it upwards in x and y.
    corner: (x, y) of the first cell [m]; resolution, sigma [m].
    """

    levels: NDArray[np.uint8]
    corner: tuple[float, float]
    resolution: float
    sigma: float


@compiled
def _blots(points: Floats, field: Bytes, corner: tuple[float, float], scale: tuple[float, float]) -> None:
    """The most of exp(-d^2 / 2 sigma^2) over the points, at the middle of each cell; scale: resolution and sigma [m]."""
    resolution, sigma = scale
    k = int(REACH * sigma / resolution) + 1
    for i in range(points.shape[0]):
        cx, cy = int((points[i, 0] - corner[0]) / resolution), int((points[i, 1] - corner[1]) / resolution)
        for a in range(max(0, cx - k), min(field.shape[0], cx + k + 1)):
            for b in range(max(0, cy - k), min(field.shape[1], cy + k + 1)):
                dx, dy = (a + 0.5) * resolution + corner[0] - points[i, 0], (b + 0.5) * resolution + corner[1] - points[i, 1]
                value = np.uint8(FULL * np.exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma)))
                if value > field[a, b]:
                    field[a, b] = value


@compiled
def _bounds(levels: NDArray[np.uint8]) -> None:
    """Fills the levels above 0."""
    _, columns, rows = levels.shape
    for level in range(1, levels.shape[0]):
        below, here, step = levels[level - 1], levels[level], 1 << (level - 1)
        for a in range(columns):
            for b in range(rows):
                most = below[a, b]
                right, above = a + step < columns, b + step < rows
                if right:
                    most = max(most, below[a + step, b])
                if above:
                    most = max(most, below[a, b + step])
                if right and above:
                    most = max(most, below[a + step, b + step])
                here[a, b] = most


def likelihood_field(points: Floats, resolution: float, sigma: float, depth: int) -> LikelihoodField:
    """Likelihood field of points (n, 2) [m], with cells of ``resolution`` [m], ``sigma`` [m], and ``depth`` levels of bounds above it.

    The margin below and to the left is the side of the top level's squares: a square that begins outside still has its bound.
    """
    top = (1 << depth) * resolution
    low = points.min(axis=0) - REACH * sigma - top
    columns, rows = (int(v) + 2 for v in (points.max(axis=0) + REACH * sigma - low) / resolution)
    levels = np.zeros((depth + 1, columns, rows), dtype=np.uint8)
    corner = (float(low[0]), float(low[1]))
    _blots(points, levels[0], corner, (resolution, sigma))
    _bounds(levels)
    return LikelihoodField(levels, corner, resolution, sigma)
