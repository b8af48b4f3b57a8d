"""Compiled kernels that read and draw into tiles which several maps share."""

import numpy as np
from numpy.typing import NDArray

from services.slam.maps.tile_kernels import HIT, MISS, TILE
from uvf.maths.compiled import compiled

Ints = NDArray[np.int64]
Cells = NDArray[np.int16]
Slots = NDArray[np.int32]
Grid = tuple[Cells, Slots, Slots, tuple[int, int], float]
"""One map: pool of tiles (capacity, TILE, TILE, channels), the place in it of each column, the column of each tile (rows, columns),
row and column of the directory's first tile, side of a cell [m]. Place 0 is the unknown tile."""


@compiled
def slot_of(row: int, column: int, grid: Grid) -> int:
    """Where in the pool the tile of a cell is."""
    _, slots, directory, first, _ = grid
    r, c = row // TILE - first[0], column // TILE - first[1]
    if r < 0 or c < 0 or r >= directory.shape[0] or c >= directory.shape[1]:
        return 0
    return int(slots[directory[r, c]])


@compiled
def add_evidence(window: NDArray[np.int8], tiles: Ints, slots: Ints, pool: Cells, evidence: tuple[int, int, int, int]) -> None:
    """Adds to the log-odds what ``tile_kernels.sketch`` has drawn, and empties the window. evidence: hit, miss, lowest, highest."""
    hit, miss, lowest, highest = evidence
    for k in range(tiles.shape[0]):
        cells = pool[slots[k]]
        for r in range(TILE):
            drawn = window[tiles[k, 0] * TILE + r, tiles[k, 1] * TILE : (tiles[k, 1] + 1) * TILE]
            for c in range(TILE):
                if drawn[c] == HIT:
                    cells[r, c, 0] = min(cells[r, c, 0] + hit, highest)
                elif drawn[c] == MISS:
                    cells[r, c, 0] = max(cells[r, c, 0] + miss, lowest)
                drawn[c] = 0
