"""Whether a straight line between any two points lies on free cells."""

from math import floor, inf, sqrt

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Point = tuple[float, float]

DIAGONALS = 1.4143
"""Cells: of what a distance between centres says, so much does not count between any point of the one and any point of the other cell."""
CORNER = 1e-9
"""Share of a line's length within which it crosses two borders at once."""


@compiled
def is_line_free(distance: Floats, a: Point, b: Point) -> bool:
    """Whether the line from ``a`` to ``b`` (x, y [cells]) lies on cells (rows, columns) whose distance [cells] to an obstacle is not 0.

    A line through the corner where four cells meet needs the cells beside it too. In the open, steps are as long as there is room.
    """
    rows, columns = distance.shape
    dx, dy = b[0] - a[0], b[1] - a[1]
    size = sqrt(dx * dx + dy * dy)
    column, row, t = floor(a[0]), floor(a[1]), 0.0
    right, up = (1 if dx > 0.0 else -1), (1 if dy > 0.0 else -1)
    while True:
        if not (0 <= row < rows and 0 <= column < columns) or distance[row, column] <= 0.0:
            return False
        room = distance[row, column] - DIAGONALS
        if room > 1.0:
            t += room / max(size, 1e-12)
            if t >= 1.0:
                return True
            column, row = floor(a[0] + t * dx), floor(a[1] + t * dy)
            continue
        tx = (column + (1 if dx > 0.0 else 0) - a[0]) / dx if dx != 0.0 else inf
        ty = (row + (1 if dy > 0.0 else 0) - a[1]) / dy if dy != 0.0 else inf
        t = min(tx, ty)
        if t >= 1.0:
            return True
        if abs(tx - ty) <= CORNER:
            if not (0 <= row + up < rows and 0 <= column + right < columns):
                return False
            if distance[row + up, column] <= 0.0 or distance[row, column + right] <= 0.0:
                return False
            column += right
            row += up
        elif tx < ty:
            column += right
        else:
            row += up
