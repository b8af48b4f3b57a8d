"""Cells and points of a grid that lies anywhere; all points in the frame that its origin is given in."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import inverse, transform
from uvf.models.world.map_file import GridMap

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]


def cells_of(grid: GridMap, points: Floats) -> tuple[Ints, Ints, Mask]:
    """(rows (n,), columns (n,), mask (n,)): the cells that points (n, 2) [m] lie in, and whether the grid has them."""
    local = transform(inverse(grid.origin), points) / grid.resolution
    column, row = np.floor(local[:, 0]).astype(np.int64), np.floor(local[:, 1]).astype(np.int64)
    return row, column, (row >= 0) & (row < grid.cells.shape[0]) & (column >= 0) & (column < grid.cells.shape[1])


def values_at(grid: GridMap, points: Floats) -> NDArray[np.int8]:
    """Values (n,) of the cells at points (n, 2) [m]; -1 outside."""
    row, column, inside = cells_of(grid, points)
    values = np.full(len(points), -1, dtype=np.int8)
    values[inside] = grid.cells[row[inside], column[inside]]
    return values


def centres(grid: GridMap) -> Floats:
    """Centres (cells, 2) [m] of all cells, row by row, in the frame of the grid's origin."""
    rows, columns = np.indices(grid.cells.shape)
    return transform(grid.origin, np.column_stack((columns.ravel() + 0.5, rows.ravel() + 0.5)) * grid.resolution)
