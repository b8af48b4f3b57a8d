"""The surfaces in a particle's map: of each cell the mean place of the beams that ended in it, and where they came from.

Whole numbers, so that a tile is small: number of hits, place within the cell (x, y), direction towards the lidar (x, y). Few cells
have any, so tiles are small, too, and stand beside those of the log-odds.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.maps.shared_kernels import Cells, Grid, slot_at, slot_of
from uvf.slam.maps.shared_tiles import Stroke
from uvf.slam.maps.tile_kernels import TILE
from uvf.slam.maps.tile_pool import TileKind, TilePool

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Numbers = NDArray[np.int16]
ParticleMap = tuple[Grid, Grid]
"""Log-odds, and surfaces in tiles of ``SIDE``."""

SIDE = 16
"""Cells along the side of a tile of surfaces."""
SURFACES = TileKind(SIDE, 5, np.int16)
_ROW = 1 << 32

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
def _add(x: float, y: float, sensor: tuple[float, float], cell: Numbers) -> None:
    """One place on a surface [cells from the corner of the stroke], into the cell (5,) that it is in."""
    dx, dy = sensor[0] - x, sensor[1] - y
    length = np.sqrt(dx * dx + dy * dy) + 1e-9
    n = min(cell[0] + 1, MEMORY)
    cell[0] = n
    cell[1] += int(np.rint(((x - np.floor(x)) * PART - cell[1]) / n))
    cell[2] += int(np.rint(((y - np.floor(y)) * PART - cell[2]) / n))
    cell[3] += int(np.rint((dx / length * PART - cell[3]) / n))
    cell[4] += int(np.rint((dy / length * PART - cell[4]) / n))


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
def _on_surfaces(ends: Floats, hit: NDArray[np.bool_], cell: float) -> Floats:
    """(m, 2) ends of beams that hit something, and places on the straight surfaces between them; all in cells of ``cell`` [m].

    Far away beams end in few cells of a wall; what lies between them is drawn so that the heading can be held by it.
    """
    found, n = np.empty((ends.shape[0] * (1 + int(BRIDGE / cell)), 2)), 0
    for i in range(ends.shape[0]):
        if not hit[i]:
            continue
        found[n], n = ends[i], n + 1
        if i + 1 == ends.shape[0] or not hit[i + 1]:
            continue
        dx, dy = ends[i + 1, 0] - ends[i, 0], ends[i + 1, 1] - ends[i, 1]
        steps = int(np.sqrt(dx * dx + dy * dy))
        if steps < 2 or steps * cell > BRIDGE or not _straight(ends, hit, i):
            continue
        for k in range(1, steps):
            x, y = ends[i, 0] + dx * k / steps, ends[i, 1] + dy * k / steps
            # Only tiles of the ends are sure to be known.
            if np.floor(x / TILE) == np.floor(ends[i, 0] / TILE) and np.floor(y / TILE) == np.floor(ends[i, 1] / TILE):
                found[n, 0], found[n, 1] = x, y
                n += 1
    return found[:n]


@compiled
def _add_all(points: Floats, slots: Ints, sensor: tuple[float, float], pool: Cells) -> None:
    """Points (n, 2) as of ``_on_surfaces``, each into the tile that it is in; place 0 is none."""
    for i in range(points.shape[0]):
        if slots[i] != 0:
            x, y = points[i, 0], points[i, 1]
            _add(x, y, sensor, pool[slots[i], int(np.floor(y)) % SIDE, int(np.floor(x)) % SIDE])


def add_surfaces(stroke: Stroke, surfaces: TilePool, k: int) -> None:
    """Adds to map k what a sweep has hit."""
    points = _on_surfaces(stroke.ends, stroke.hit, surfaces.cell)
    tiles = np.floor(points[:, ::-1] / SIDE).astype(np.int64) + np.array(stroke.first) * (TILE // SIDE)
    _, first, which = np.unique(tiles[:, 0] * _ROW + tiles[:, 1], return_index=True, return_inverse=True)
    slots = surfaces.writable(k, tiles[first])
    _add_all(points, slots[which], stroke.sensor, surfaces.grid(k)[0])


@compiled
def line_at(x: float, y: float, view: tuple[float, float], maps: ParticleMap) -> tuple[float, float, float, bool]:
    """(normal x, normal y, distance along it [cells], found) of the surface near (x, y) [cells] that is seen from ``view``.

    view: unit vector towards the lidar. A line through the means of the cells around, weighted by their distance: moving least squares.
    """
    known, surfaces = maps
    column, row = int(np.floor(x)), int(np.floor(y))
    low_r, low_c = (row - REACH) // SIDE, (column - REACH) // SIDE
    one_r, one_c = (row + REACH) // SIDE == low_r, (column + REACH) // SIDE == low_c
    s00 = slot_at(low_r, low_c, surfaces)
    s01 = s00 if one_c else slot_at(low_r, low_c + 1, surfaces)
    s10 = s00 if one_r else slot_at(low_r + 1, low_c, surfaces)
    s11 = s10 if one_c else s01 if one_r else slot_at(low_r + 1, low_c + 1, surfaces)
    w = sx = sy = sxx = sxy = syy = 0.0
    used = 0
    if s00 + s01 + s10 + s11 == 0:
        return 0.0, 0.0, 0.0, False
    for r in range(row - REACH, row + REACH + 1):
        left, right = (s00, s01) if r // SIDE == low_r else (s10, s11)
        for c in range(column - REACH, column + REACH + 1):
            cell = surfaces[0][left if c // SIDE == low_c else right, r % SIDE, c % SIDE]
            if cell[0] == 0 or cell[3] * view[0] + cell[4] * view[1] < SAME_SIDE * PART:
                continue
            if known[0][slot_of(r, c, known), r % TILE, c % TILE, 0] < 0:
                continue
            px, py = c + cell[1] / PART - x, r + cell[2] / PART - y
            weight = min(float(cell[0]), 10.0) * np.exp(-(px * px + py * py) / (2.0 * KERNEL * KERNEL))
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
