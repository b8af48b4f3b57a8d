"""How much unknown ground could be seen from a place (González-Baños & Latombe 2002, "Navigation Strategies for Exploring Indoor")."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Cell = tuple[int, int]
Mask = NDArray[np.bool_]

RAYS = 180
DECAY = 0.15
"""1/m of way that a square metre of unknown ground loses of its worth; theirs is 0.2."""


@compiled
def unknown_area(unknown: Mask, taken: Mask, cell: Cell, reach: float) -> float:
    """Unknown cells [-] that straight lines from a cell pass within ``reach`` [cells] before one that is taken.

    unknown, taken: (rows, columns). Each line counts for its share of the circle, so that near cells are not counted often.
    """
    rows, columns = unknown.shape
    area = 0.0
    for k in range(RAYS):
        angle = 2.0 * np.pi * (k + 0.5) / RAYS
        dr, dc = np.sin(angle), np.cos(angle)
        d = 1.0
        while d <= reach:
            r, c = int(np.floor(cell[0] + 0.5 + d * dr)), int(np.floor(cell[1] + 0.5 + d * dc))
            if not (0 <= r < rows and 0 <= c < columns):
                area += np.pi * (reach * reach - d * d) / RAYS  # beyond the map nothing is known either
                break
            if taken[r, c]:
                break
            if unknown[r, c]:
                area += 2.0 * np.pi * d / RAYS
            d += 1.0
    return area


def utility(area: float, way: float) -> float:
    """Worth of an unknown area [m^2] at the end of a way [m] (equation 1)."""
    return float(area * np.exp(-DECAY * way))
