"""Compiled kernels that draw a reading into the tiles of a map and fold what tiles hold into occupancy."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bytes = NDArray[np.int8]
Counts = NDArray[np.int16]

TILE = 64
"""Cells along a tile's side."""
HIT, MISS = 17, -8
"""Evidence of one beam that ends in a cell, or goes through it, in units of 0.05 log-odds (Thrun et al. 2005, table 9.2)."""
UNIT = 0.05
LOWEST, HIGHEST = -60, 70
"""Bounds of what an epoch hands on to the next."""
_BITS = 20  # of the fraction of a cell, while a beam is followed
_WORD = 8  # bytes looked at together


@compiled
def beam_ends(
    beams: tuple[Floats, Floats], sensor: tuple[float, float, float], gate: tuple[float, float, float], cell: float
) -> tuple[Floats, NDArray[np.bool_], tuple[float, float], tuple[int, int, int, int]]:
    """(ends (m, 2), whether they hit (m,), start, window) of the beams that tell anything; in cells of side ``cell`` [m] from its corner.

    beams: ranges (n,) [m] and directions (n, 2) in the base frame; sensor: the lidar's place [m, map] and the base's yaw [rad];
    gate: range_min, range_max, and how far a beam without a return counts as free [m]. What is closer than range_min and NaN
    is a disturbed beam and says nothing; 0 and what is beyond range_max is no return.
    window: the tiles that the beams are in: row and column of the first, number of rows and columns.
    """
    ranges, directions = beams
    ends, hit = np.empty((ranges.shape[0], 2)), np.zeros(ranges.shape[0], dtype=np.bool_)
    c, s = np.cos(sensor[2]), np.sin(sensor[2])
    x, y = sensor[0] / cell, sensor[1] / cell
    low_x = high_x = x
    low_y = high_y = y
    m = 0
    for i in range(ranges.shape[0]):
        returned = ranges[i] > 0.0 and gate[0] <= ranges[i] < gate[1]
        if not (returned or ranges[i] == 0.0 or ranges[i] >= gate[1]):
            continue
        length = (ranges[i] if returned else gate[2]) / cell
        ends[m, 0] = x + length * (c * directions[i, 0] - s * directions[i, 1])
        ends[m, 1] = y + length * (s * directions[i, 0] + c * directions[i, 1])
        hit[m] = returned
        low_x, high_x = min(low_x, ends[m, 0]), max(high_x, ends[m, 0])
        low_y, high_y = min(low_y, ends[m, 1]), max(high_y, ends[m, 1])
        m += 1
    row, column = int(np.floor(low_y / TILE)), int(np.floor(low_x / TILE))
    rows, columns = int(np.floor(high_y / TILE)) + 1 - row, int(np.floor(high_x / TILE)) + 1 - column
    for i in range(m):
        ends[i, 0] -= column * TILE
        ends[i, 1] -= row * TILE
    return ends[:m], hit[:m], (x - column * TILE, y - row * TILE), (row, column, rows, columns)


@compiled
def _line(ends: tuple[float, float, float, float], value: int, window: tuple[Bytes, int]) -> None:
    """Sets the cells from (x, y) up to, not including, (x, y) to ``value``, but those that were hit."""
    cells, width = window
    dx, dy = ends[2] - ends[0], ends[3] - ends[1]
    steps = int(max(abs(dx), abs(dy)))
    if steps == 0:
        return
    x, y = int(ends[0] * (1 << _BITS)), int(ends[1] * (1 << _BITS))
    step_x, step_y = int(dx / steps * (1 << _BITS)), int(dy / steps * (1 << _BITS))
    for _ in range(steps):
        k = (y >> _BITS) * width + (x >> _BITS)
        cells[k] = HIT if cells[k] == HIT else value
        x += step_x
        y += step_y


@compiled
def sketch(ends: Floats, hit: NDArray[np.bool_], sensor: tuple[float, float], gap: float, window: tuple[Bytes, int]) -> None:
    """Draws the beams into an empty window: HIT where one ends, MISS where one only goes through; each cell once.

    All in cells from the window's corner, within it; window: its bytes row by row, and its width. One cell for each step along
    the longer axis (Bresenham's line). Between neighbouring ends closer than ``gap`` nothing is said: a beam that grazes
    a surface goes through its cells without hitting them.
    """
    cells, width = window
    for i in range(ends.shape[0]):
        if hit[i]:
            cells[int(ends[i, 1]) * width + int(ends[i, 0])] = HIT
    for i in range(ends.shape[0]):
        _line((sensor[0], sensor[1], ends[i, 0], ends[i, 1]), MISS, window)
    for i in range(ends.shape[0] - 1):
        if hit[i] and hit[i + 1] and (ends[i + 1, 0] - ends[i, 0]) ** 2 + (ends[i + 1, 1] - ends[i, 1]) ** 2 < gap * gap:
            _line((ends[i, 0], ends[i, 1], ends[i + 1, 0], ends[i + 1, 1]), 0, window)


@compiled
def touched_tiles(words: Ints) -> Ints:
    """Row and column (k, 2) of the window's tiles in which anything is drawn. words: its bytes, eight a word, (rows, columns / 8)."""
    rows, columns = words.shape[0] // TILE, words.shape[1] // (TILE // _WORD)
    found = np.empty((rows * columns, 2), dtype=np.int64)
    n = 0
    for a in range(rows):
        for b in range(columns):
            for r in range(a * TILE, a * TILE + TILE):
                some = np.int64(0)
                for w in range(b * (TILE // _WORD), (b + 1) * (TILE // _WORD)):
                    some |= words[r, w]
                if some != 0:
                    found[n, 0], found[n, 1] = a, b
                    n += 1
                    break
    return found[:n]


@compiled
def spread(window: NDArray[np.int8], tiles: Ints, slots: Ints, pool: Counts, sign: int) -> None:
    """Adds (sign 1) or takes away (-1) what is drawn in the window's ``tiles``, and empties them. pool: (capacity, TILE, TILE)."""
    for k in range(tiles.shape[0]):
        counts = pool[slots[k]]
        for r in range(TILE):
            source = window[tiles[k, 0] * TILE + r, tiles[k, 1] * TILE : (tiles[k, 1] + 1) * TILE]
            row = counts[r]
            for c in range(TILE):
                row[c] += sign * source[c]
                source[c] = 0


@compiled
def fold(pool: Counts, slots: Ints, first: Ints, per_cent: Bytes, out: Bytes) -> None:
    """Writes to out (n, TILE, TILE) the occupancy of each tile by what was believed (out before) and its epochs: -1 unknown, 0..100.

    slots[first[i] : first[i + 1]] are the places of tile i's epochs in the pool, oldest first. What is believed after each is kept
    within LOWEST .. HIGHEST, so that the next one can turn it over. per_cent: of each log-odds from LOWEST on.
    """
    for i in range(out.shape[0]):
        for r in range(TILE):
            for c in range(TILE):
                belief = int(out[i, r, c])
                for k in range(first[i], first[i + 1]):
                    belief = min(max(belief + pool[slots[k], r, c], LOWEST), HIGHEST)
                out[i, r, c] = -1 if belief == 0 else per_cent[belief - LOWEST]
