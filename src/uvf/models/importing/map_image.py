"""Maps of map_server (picture and yaml) as worlds: occupied cells are walls (http://wiki.ros.org/map_server#Map_format)."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import transform
from uvf.models.importing.heights import HOME
from uvf.models.importing.notes import Notes
from uvf.models.world.file import Box, WorldFile
from uvf.models.world.map_file import OCCUPIED_FROM, GridMap, load_map
from uvf.models.yaml_data import BadInput

Mask = NDArray[np.bool_]
Rectangle = tuple[int, int, int, int]
"""First row, first column, number of rows, number of columns."""
MANY = 3000  # boxes


def map_world(path: Path, height: float, notes: Notes) -> WorldFile:
    """A world with walls of ``height`` [m] where the map is occupied. Raises BadInput."""
    grid = load_map(path, notes.add)
    occupied, known = grid.cells >= OCCUPIED_FROM, grid.cells >= 0
    if not occupied.any():
        raise BadInput(f"{path}: no cell is occupied, so there is nothing to take over; look at negate and the thresholds")
    rectangles = greedy_rectangles(occupied)
    notes.add(f"{int(occupied.sum())} occupied cells of {grid.resolution:g} m became {len(rectangles)} boxes")
    if len(rectangles) > MANY:
        notes.add(f"more than {MANY} boxes are slow; clean the picture of single cells first")
    if not known.all():
        notes.add("cells that the map does not know are floor here", f"{int((~known).sum())}")
    notes.add("a map does not say where on Earth it lies: set 'origin'")
    boxes = [_box(i, rectangle, grid, height) for i, rectangle in enumerate(rectangles, 1)]
    return WorldFile(f"Walls of the map {path.stem}.yaml.", HOME, _floor(known, grid, path), boxes=boxes, ground_colour=(0.6, 0.6, 0.58))


def greedy_rectangles(cells: Mask) -> list[Rectangle]:
    """Few rectangles that cover exactly the cells (rows, columns) that are set.

    At each first free cell the larger of the two that grow along and up.
    """
    left = cells.copy()
    found = []
    for row, column in np.argwhere(cells):
        if not left[row, column]:
            continue
        wide = _grown(left[row:, column:])
        tall = _grown(left[row:, column:].T)[::-1]
        rows, columns = max(wide, (tall[0], tall[1]), key=lambda size: size[0] * size[1])
        left[row : row + rows, column : column + columns] = False
        found.append((int(row), int(column), rows, columns))
    return found


def _grown(cells: Mask) -> tuple[int, int]:
    """(rows, columns) of the rectangle at [0, 0] that first grows along its row, then upward."""
    columns = _run(cells[0])
    return _run(np.asarray(cells[:, :columns].all(axis=1))), columns


def _run(values: Mask) -> int:
    """How many are set before the first that is not."""
    return int(len(values) if values.all() else np.argmin(values))


def _box(number: int, rectangle: Rectangle, grid: GridMap, height: float) -> Box:
    row, column, rows, columns = rectangle
    size = (columns * grid.resolution, rows * grid.resolution, height)
    x, y = _world(grid, column + columns / 2, row + rows / 2)
    return Box(f"wall_{number}", (x, y, height / 2), size, (0.0, 0.0, grid.origin.yaw), (0.75, 0.73, 0.68))


def _world(grid: GridMap, column: float, row: float) -> tuple[float, float]:
    """x, y [m] of a point given in cells from the lower left corner."""
    x, y = transform(grid.origin, np.array(((column, row),)) * grid.resolution)[0]
    return float(x), float(y)


def _floor(known: Mask, grid: GridMap, path: Path) -> tuple[float, float, float, float]:
    """The rectangle about all cells that the map knows."""
    rows, columns = np.flatnonzero(known.any(axis=1)), np.flatnonzero(known.any(axis=0))
    if len(rows) == 0:
        raise BadInput(f"{path}: no cell is free or occupied; look at negate and the thresholds")
    corners = [_world(grid, c, r) for c in (columns[0], columns[-1] + 1) for r in (rows[0], rows[-1] + 1)]
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    return round(float(low[0]), 3), round(float(low[1]), 3), round(float(high[0]), 3), round(float(high[1]), 3)
