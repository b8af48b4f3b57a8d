"""Compiled kernels that read and draw into tiles which several maps share."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.maps.tile_kernels import HIT, MISS, TILE

Ints = NDArray[np.int64]
Cells = NDArray[np.signedinteger[Any]]
Slots = NDArray[np.int32]
Grid = tuple[Cells, Slots, Ints, Slots, float]
"""One map: pool of tiles (capacity, side, side, channels), the place in it of each column, a hash table of the keys of tiles and
of their columns (its size a power of two, half of it NO_KEY or more), side of a cell [m]. Place 0 is the unknown tile."""
NO_KEY = -(1 << 62)
_ROW = 1 << 32
_WORD = 8  # bytes looked at together
_SCATTER = -7046029254386353131
"""2^64 divided by the golden ratio, as a signed number (Knuth, The Art of Computer Programming, volume 3, section 6.4)."""


@compiled
def _entry(key: int, keys: Ints) -> int:
    """Where the key is in the table, or where it would be put."""
    mask = keys.shape[0] - 1
    i = int(((key * _SCATTER) >> 32) & mask)
    while keys[i] != NO_KEY and keys[i] != key:
        i = (i + 1) & mask
    return i


@compiled
def slot_at(row: int, column: int, grid: Grid) -> int:
    """Index in the pool of the tile of this row and column; 0 where there is none."""
    _, slots, keys, columns, _ = grid
    i = _entry(row * _ROW + column, keys)
    return int(slots[columns[i]]) if keys[i] != NO_KEY else 0


@compiled
def slot_of(row: int, column: int, grid: Grid) -> int:
    """Index in the pool of the tile of a cell, of tiles of side TILE."""
    return slot_at(row // TILE, column // TILE, grid)


@compiled
def columns_of(places: Ints, keys: Ints, columns: Slots, count: int) -> tuple[Ints, int]:
    """(columns (n,) of tiles (n, 2) in the table, number of columns then); new tiles are counted on from ``count`` and put into it."""
    found = np.empty(places.shape[0], dtype=np.int64)
    for n in range(places.shape[0]):
        key = places[n, 0] * _ROW + places[n, 1]
        i = _entry(key, keys)
        if keys[i] == NO_KEY:
            keys[i], columns[i] = key, count
            count += 1
        found[n] = columns[i]
    return found, count


@compiled
def moved_keys(keys: Ints, columns: Slots, numbers: Ints, size: int) -> tuple[Ints, Slots]:
    """A table of ``size`` entries in which column i has become numbers[i]; those below 0 are left out."""
    new_keys, new_columns = np.full(size, NO_KEY, dtype=np.int64), np.zeros(size, dtype=np.int32)
    for k in range(keys.shape[0]):
        if keys[k] != NO_KEY and numbers[columns[k]] >= 0:
            i = _entry(keys[k], new_keys)
            new_keys[i], new_columns[i] = keys[k], numbers[columns[k]]
    return new_keys, new_columns


@compiled
def add_evidence(window: NDArray[np.int8], tiles: Ints, slots: Ints, pool: Cells, evidence: tuple[int, int, int, int]) -> None:
    """Adds what ``tile_kernels.sketch`` drew into a window (rows, columns) to the log-odds of its ``tiles`` (k, 2); empties the window.

    evidence: hit, miss, lowest, highest. Tiles without a place but 0, the unknown tile's, are not drawn.
    """
    hit, miss, lowest, highest = evidence
    words = window.view(np.int64)
    for k in range(tiles.shape[0]):
        cells = pool[slots[k]]
        for r in range(TILE):
            row = tiles[k, 0] * TILE + r
            for c in range(tiles[k, 1] * TILE, (tiles[k, 1] + 1) * TILE, _WORD):
                if words[row, c // _WORD] == 0:
                    continue  # far away beams lie apart
                for i in range(c, c + _WORD if slots[k] != 0 else c):
                    if window[row, i] == HIT:
                        cells[r, i % TILE, 0] = min(cells[r, i % TILE, 0] + hit, highest)
                    elif window[row, i] == MISS:
                        cells[r, i % TILE, 0] = max(cells[r, i % TILE, 0] + miss, lowest)
                words[row, c // _WORD] = 0
