"""Tiles that several maps share: a copy of a map costs nothing until it is drawn into, and all of them take no more memory than they may.

Copy on write: a tile that more than one map holds is copied for the one that draws into it. Where memory is full, all maps
lose the tiles that none of them has drawn into for longest.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvf.slam.maps.shared_kernels import NO_KEY, Cells, Grid, Slots, columns_of, moved_keys

Ints = NDArray[np.int64]

EMPTY = 0
"""The tile of which nothing is known, which all maps share; and the column that no tile has."""
SPARE = 8
"""One part of so many of all tiles is made free when none is left."""


@dataclass(frozen=True)
class TileKind:
    """Kind of tiles: ``side`` x ``side`` cells, each of ``channels`` whole numbers of a type."""

    side: int
    channels: int
    number: type[np.signedinteger[Any]]

    @property
    def size(self) -> int:
        """Size of a tile in bytes."""
        return self.side * self.side * self.channels * np.dtype(self.number).itemsize


class TilePool:
    """Tiles of ``maps`` maps of cells of ``cell`` [m].

    Memory: at most ``most`` bytes, with what finds the tiles. It is asked for at once, and taken from the system as it is used.
    """

    def __init__(self, maps: int, kind: TileKind, cell: float, most: float) -> None:
        self.cell = cell
        self.kind = kind
        self.capacity = max(1, int(most / (kind.size + np.dtype(np.int32).itemsize * maps)))
        """Tiles that there may be."""
        self.forgotten = 0
        """Places that all maps have lost because memory was full."""
        self._pool: Cells = np.zeros((self.capacity + 1, kind.side, kind.side, kind.channels), dtype=kind.number)
        self._holders = np.zeros(len(self._pool), dtype=np.int32)
        self._free = np.arange(self.capacity, EMPTY, -1, dtype=np.int32)
        self._free_count = self.capacity
        self._slots: Slots = np.full((maps, 64), EMPTY, dtype=np.int32)
        self._seen = np.zeros(64, dtype=np.int64)
        self._columns = 1
        self._keys, self._key_columns = np.full(128, NO_KEY, dtype=np.int64), np.zeros(128, dtype=np.int32)
        self._now = 0

    @property
    def tiles(self) -> int:
        """Number of tiles that are held, each counted once."""
        return self.capacity - self._free_count

    def grid(self, k: int) -> Grid:
        """Map k as compiled kernels read it; valid until something is drawn."""
        return self._pool, self._slots[k], self._keys, self._key_columns, self.cell

    def take(self, ancestors: Ints) -> None:
        """Makes map i what map ancestors[i] was. No tile is copied."""
        self._slots = self._slots[ancestors]
        self._keep((self._slots[:, : self._columns] != EMPTY).any(axis=0))

    def writable(self, k: int, places: Ints) -> Ints:
        """Indices (n,) in the pool of map k's own tiles at ``places`` (n, 2), row and column; EMPTY where there is no room for one."""
        self._now += 1
        columns = self._columns_at(places)
        slots: Ints = self._slots[k, columns].astype(np.int64)
        shared = np.flatnonzero((slots == EMPTY) | (self._holders[slots] > 1))
        if len(shared) > self._free_count:
            self._forget_oldest(len(shared))
            columns = self._columns_at(places)
        copied, refused = shared[: self._free_count], shared[self._free_count :]
        if len(copied):
            self._free_count -= len(copied)
            new = self._free[self._free_count : self._free_count + len(copied)][::-1]
            old = slots[copied]
            self._pool[new] = self._pool[old]
            self._holders[old] -= 1
            self._holders[new] = 1
            slots[copied] = new
            self._slots[k, columns[copied]] = new
        slots[refused] = EMPTY
        return slots

    def _columns_at(self, places: Ints) -> Ints:
        """Columns of ``_slots`` for tiles, which no two tiles share."""
        most = self._columns + len(places)
        if 2 * most > len(self._keys):
            size = 1 << int(2 * most).bit_length()
            self._keys, self._key_columns = moved_keys(self._keys, self._key_columns, np.arange(self._columns), size)
        if most > self._slots.shape[1]:
            more = most + most // 2 - self._slots.shape[1]
            self._slots = np.pad(self._slots, ((0, 0), (0, more)), constant_values=EMPTY)
            self._seen = np.pad(self._seen, (0, more))
        found, self._columns = columns_of(places, self._keys, self._key_columns, self._columns)
        self._seen[found] = self._now
        return found

    def _forget_oldest(self, wanted: int) -> None:
        """Makes room for ``wanted`` tiles and some to spare, but leaves the places that are seen now."""
        held = np.sort(self._slots[:, : self._columns], axis=0)
        tiles = (np.diff(held, axis=0, prepend=EMPTY) != 0).sum(axis=0)
        oldest = np.argsort(self._seen[: self._columns], kind="stable")
        enough = np.cumsum(tiles[oldest]) - tiles[oldest] >= wanted - self._free_count + self.capacity // SPARE
        kept = np.zeros(self._columns, dtype=np.bool_)
        kept[oldest[enough]] = True
        kept |= self._seen[: self._columns] == self._now
        self.forgotten += int(np.count_nonzero(~kept & (tiles > 0)))
        self._keep(kept)

    def _keep(self, kept: NDArray[np.bool_]) -> None:
        """Leaves only some columns (columns,), and counts anew who holds what."""
        kept[EMPTY] = True
        numbers = np.where(kept, np.cumsum(kept) - 1, -1)
        self._keys, self._key_columns = moved_keys(self._keys, self._key_columns, numbers, len(self._keys))
        rest = np.flatnonzero(kept)
        self._slots, self._seen = self._slots[:, rest], self._seen[rest]
        self._columns = len(rest)
        self._holders = np.bincount(self._slots.ravel(), minlength=len(self._pool)).astype(np.int32)
        free = np.flatnonzero(self._holders[EMPTY + 1 :] == 0)[::-1] + EMPTY + 1
        self._free_count = len(free)
        self._free[: len(free)] = free
