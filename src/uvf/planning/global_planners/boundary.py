"""Following an obstacle's boundary on a grid: from side to side of cells, so that it always comes back to where it began.

A side is a free cell and one of the four directions in which an impassable cell lies beside it. Free cells join by four neighbours,
impassable ones by eight.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Mask = NDArray[np.bool_]
Cells = NDArray[np.int64]
Side = tuple[int, int, int]
"""Row, column, and direction: 0 east, 1 north (rows up), 2 west, 3 south."""

DOWN = (0, 1, 0, -1)  # rows
ACROSS = (1, 0, -1, 0)  # columns


@compiled
def is_free(free: Mask, row: int, column: int) -> bool:
    """Whether a cell lies on the map and is free."""
    return 0 <= row < free.shape[0] and 0 <= column < free.shape[1] and bool(free[row, column])


@compiled
def next_side(free: Mask, side: Side) -> tuple[Side, int, int]:
    """The side that follows with the obstacle on the right, and the cell that is passed on the way there; (-1, -1): none."""
    row, column, wall = side
    ahead = (wall + 1) % 4
    ar, ac = row + DOWN[ahead], column + ACROSS[ahead]
    if not is_free(free, ar, ac):
        return (row, column, ahead), -1, -1
    dr, dc = ar + DOWN[wall], ac + ACROSS[wall]
    if not is_free(free, dr, dc):
        return (ar, ac, wall), -1, -1
    return (dr, dc, (ahead + 2) % 4), ar, ac


@compiled
def with_cell(cells: Cells, n: int, row: int, column: int) -> tuple[Cells, int]:
    """Cells (m, 2) of which ``n`` count, with one more unless it is the last one; and how many count."""
    if n > 0 and cells[n - 1, 0] == row and cells[n - 1, 1] == column:
        return cells, n
    if n == cells.shape[0]:
        more = np.empty((2 * n + 16, 2), dtype=np.int64)
        more[:n] = cells[:n]
        cells = more
    cells[n, 0], cells[n, 1] = row, column
    return cells, n + 1


@compiled
def straight(start: tuple[int, int], goal: tuple[int, int]) -> Cells:
    """Cells (n, 2) along the line from one cell's centre to another's, each beside the one before; each is nearer to the goal."""
    rows, columns = abs(goal[0] - start[0]), abs(goal[1] - start[1])
    up, right = (1 if goal[0] > start[0] else -1), (1 if goal[1] > start[1] else -1)
    cells = np.empty((rows + columns + 1, 2), dtype=np.int64)
    row, column = start
    cells[0, 0], cells[0, 1] = row, column
    i, k = 0, 0
    for n in range(1, rows + columns + 1):
        # The next border that the line crosses: at (2 i + 1) / (2 rows) of its length, or at (2 k + 1) / (2 columns).
        if k == columns or (i < rows and (2 * i + 1) * columns <= (2 * k + 1) * rows):
            row += up
            i += 1
        else:
            column += right
            k += 1
        cells[n, 0], cells[n, 1] = row, column
    return cells


@compiled
def direction_of(step_row: int, step_column: int) -> int:
    """0 to 3 of a step to a cell beside."""
    if step_row == 0:
        return 0 if step_column > 0 else 2
    return 1 if step_row > 0 else 3
