"""What a cell of a particle's map holds beside its log-odds: the mean place of the beams that ended in it, and where they came from.

Whole numbers, so that a tile is small: log-odds, number of hits, place within the cell (x, y), direction towards the lidar (x, y).
"""

import numpy as np
from numpy.typing import NDArray

from services.slam.maps.shared_kernels import Cells, Grid, slot_of
from services.slam.maps.tile_kernels import TILE
from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]

CHANNELS = 6
PART = 16384
"""What stands for 1: a cell's side, and the length of a direction."""
MEMORY = 30
"""Hits from which on a mean forgets old ones."""
BRIDGE = 0.6  # m, between two ends on one straight surface
STRAIGHT = 0.97  # cosine between two stretches of it

REACH = 3  # cells around a point that are looked at
KERNEL = 1.2  # cells, 1 sigma of the weight of a surface by its distance
SAME_SIDE = 0.2  # least cosine between the directions a surface was and is seen from
FLAT = 0.15  # largest ratio of the two variances of a line


@compiled
def _add(x: float, y: float, sensor: tuple[float, float], tile: tuple[Cells, int, int]) -> None:
    """One place on a surface [cells from the corner of the stroke]; tile: where its cell is."""
    cell = tile[0][tile[1], tile[2]]
    dx, dy = sensor[0] - x, sensor[1] - y
    length = np.sqrt(dx * dx + dy * dy) + 1e-9
    n = min(cell[1] + 1, MEMORY)
    cell[1] = n
    cell[2] += int(np.rint(((x - np.floor(x)) * PART - cell[2]) / n))
    cell[3] += int(np.rint(((y - np.floor(y)) * PART - cell[3]) / n))
    cell[4] += int(np.rint((dx / length * PART - cell[4]) / n))
    cell[5] += int(np.rint((dy / length * PART - cell[5]) / n))


@compiled
def _straight(ends: Floats, hit: NDArray[np.bool_], i: int) -> bool:
    """Whether the ends i and i + 1 lie on one straight surface, with the one before or the one after them."""
    ax, ay = ends[i + 1, 0] - ends[i, 0], ends[i + 1, 1] - ends[i, 1]
    for j in (i - 1, i + 1):
        if j < 0 or j + 1 >= ends.shape[0] or not (hit[j] and hit[j + 1]):
            continue
        bx, by = ends[j + 1, 0] - ends[j, 0], ends[j + 1, 1] - ends[j, 1]
        if ax * bx + ay * by > STRAIGHT * np.sqrt((ax * ax + ay * ay) * (bx * bx + by * by)):
            return True
    return False


@compiled
def add_surfaces(ends: Floats, hit: NDArray[np.bool_], sensor: tuple[float, float], first: tuple[int, int], grid: Grid) -> None:
    """Ends of beams that hit something, and the straight surfaces between them; (n, 2) in cells from the corner of tile ``first``.

    Far away beams end in few cells of a wall; what lies between them is drawn so that the heading can be held by it.
    sensor: the lidar's place, likewise.
    """
    pool = grid[0]
    for i in range(ends.shape[0]):
        if not hit[i]:
            continue
        column, row = int(np.floor(ends[i, 0])), int(np.floor(ends[i, 1]))
        here = slot_of(first[0] * TILE + row, first[1] * TILE + column, grid)
        _add(ends[i, 0], ends[i, 1], sensor, (pool[here], row % TILE, column % TILE))
        if i + 1 == ends.shape[0] or not hit[i + 1]:
            continue
        dx, dy = ends[i + 1, 0] - ends[i, 0], ends[i + 1, 1] - ends[i, 1]
        steps = int(np.sqrt(dx * dx + dy * dy))
        if steps < 2 or steps * grid[4] > BRIDGE or not _straight(ends, hit, i):
            continue
        for k in range(1, steps):
            x, y = ends[i, 0] + dx * k / steps, ends[i, 1] + dy * k / steps
            column, row = int(np.floor(x)), int(np.floor(y))
            # Only tiles of the ends are sure to be this map's own.
            if slot_of(first[0] * TILE + row, first[1] * TILE + column, grid) == here:
                _add(x, y, sensor, (pool[here], row % TILE, column % TILE))


@compiled
def line_at(x: float, y: float, view: tuple[float, float], grid: Grid) -> tuple[float, float, float, bool]:
    """(normal x, normal y, distance along it [cells], found) of the surface near (x, y) [cells] that is seen from ``view``.

    A line through the means of the cells around, weighted by their distance: moving least squares.
    """
    pool = grid[0]
    column, row = int(np.floor(x)), int(np.floor(y))
    low_r, high_r, low_c, high_c = row - REACH, row + REACH, column - REACH, column + REACH
    single = low_r // TILE == high_r // TILE and low_c // TILE == high_c // TILE
    slot = slot_of(row, column, grid)
    w = sx = sy = sxx = sxy = syy = 0.0
    used = 0
    if single and slot == 0:
        return 0.0, 0.0, 0.0, False
    for r in range(low_r, high_r + 1):
        for c in range(low_c, high_c + 1):
            cell = pool[slot if single else slot_of(r, c, grid), r % TILE, c % TILE]
            if cell[0] < 0 or cell[1] == 0 or cell[4] * view[0] + cell[5] * view[1] < SAME_SIDE * PART:
                continue
            px, py = c + cell[2] / PART - x, r + cell[3] / PART - y
            weight = min(float(cell[1]), 10.0) * np.exp(-(px * px + py * py) / (2.0 * KERNEL * KERNEL))
            w += weight
            sx += weight * px
            sy += weight * py
            sxx += weight * px * px
            sxy += weight * px * py
            syy += weight * py * py
            used += 1
    if used < 3 or w < 1e-3:
        return 0.0, 0.0, 0.0, False
    mx, my = sx / w, sy / w
    vxx, vxy, vyy = sxx / w - mx * mx, sxy / w - mx * my, syy / w - my * my
    mean, spread = (vxx + vyy) / 2.0, np.sqrt(((vxx - vyy) / 2.0) ** 2 + vxy * vxy)
    if mean - spread > FLAT * (mean + spread):
        return 0.0, 0.0, 0.0, False
    along = 0.5 * np.arctan2(2.0 * vxy, vxx - vyy)
    nx, ny = -np.sin(along), np.cos(along)
    return nx, ny, -(nx * mx + ny * my), True
