"""What keyframes have seen, as sums by tile and epoch, and what is to be believed by all of it."""

from bisect import insort
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uvf.slam.maps.tile_kernels import HIGHEST, LOWEST, TILE, UNIT, fold, spread

Cells = NDArray[np.int8]
Ints = NDArray[np.int64]

RECENT = 16
"""Epochs of a tile whose sums are kept apart; older ones are settled: one belief that nothing can be taken out of."""
_PER_CENT = np.rint(100.0 / (1.0 + np.exp(-UNIT * np.arange(LOWEST, HIGHEST + 1)))).astype(np.int8)


class CellEvidence:
    """Evidence of cells, as sums by tile and epoch. Tiles are known by a number each, epochs by theirs, which grow with time."""

    def __init__(self) -> None:
        self._pool = np.zeros((64, TILE, TILE), dtype=np.int16)
        self._free = list(range(len(self._pool)))
        self._slots: dict[int, dict[int, int]] = {}
        self._epochs: dict[int, list[tuple[int, int]]] = {}
        self._settled: dict[int, tuple[int, Cells]] = {}

    @property
    def size(self) -> int:
        """Number of sums that are kept, each of one tile in one epoch."""
        return len(self._pool) - len(self._free)

    def is_settled(self, epoch: int, tiles: Sequence[int]) -> bool:
        """Whether an epoch can no longer be changed in one of these tiles."""
        return any(tile in self._settled and epoch <= self._settled[tile][0] for tile in tiles)

    def add(self, epoch: int, tiles: Sequence[int], window: tuple[Cells, Ints], sign: int) -> None:
        """Adds (sign 1) or takes away (-1) what is drawn in a window, and empties it.

        window: its cells, and row and column (k, 2) of the tiles in it. None of them may be settled for this epoch.
        """
        slots = self._slots.setdefault(epoch, {})
        for tile in set(tiles).difference(slots):
            slots[tile] = self._new_slot()
            insort(self._epochs.setdefault(tile, []), (epoch, slots[tile]))
            if len(self._epochs[tile]) > RECENT and self._epochs[tile][-1][0] == epoch:
                self._settle(tile)
        spread(*window, np.array([slots[tile] for tile in tiles], dtype=np.int64), self._pool, sign)

    def forget(self, epoch: int) -> None:
        """Frees the memory of an epoch of which everything has been taken away."""
        for tile, slot in self._slots.pop(epoch, {}).items():
            self._epochs[tile].remove((epoch, slot))
            self._free.append(slot)

    def cells(self, tiles: Sequence[int]) -> Cells:
        """Occupancy (n, TILE, TILE) of n tiles: -1 unknown, 0..100 per cent occupied."""
        out = np.zeros((len(tiles), TILE, TILE), dtype=np.int8)
        for i, tile in enumerate(tiles):
            if tile in self._settled:
                out[i] = self._settled[tile][1]
        slots = [[slot for _, slot in self._epochs[tile]] for tile in tiles]
        first = np.cumsum([0, *map(len, slots)])
        fold(self._pool, np.array([s for each in slots for s in each], dtype=np.int64), first, _PER_CENT, out)
        return out

    def _new_slot(self) -> int:
        if not self._free:
            size = len(self._pool)
            self._pool = np.concatenate((self._pool, np.zeros((size // 2, TILE, TILE), dtype=np.int16)))
            self._free = list(range(size, len(self._pool)))
        return self._free.pop()

    def _settle(self, tile: int) -> None:
        """Carries the oldest epoch over into the belief with which the others begin, as ``fold`` would."""
        epoch, slot = self._epochs[tile].pop(0)
        _, belief = self._settled.get(tile, (epoch, np.zeros((TILE, TILE), dtype=np.int8)))
        self._settled[tile] = (epoch, np.clip(belief + self._pool[slot], LOWEST, HIGHEST).astype(np.int8))
        self._pool[slot] = 0
        self._free.append(slot)
        del self._slots[epoch][tile]
