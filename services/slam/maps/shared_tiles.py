"""Several maps that share the tiles in which they do not differ: a copy costs nothing until it is drawn into.

Copy on write: a tile that more than one map holds is copied for the one that draws into it. What a cell holds is the method's
affair, but its first number is the log-odds of being occupied.
"""

from dataclasses import dataclass
from math import cos, isfinite, sin

import numpy as np
from numpy.typing import NDArray

from services.slam.maps.shared_kernels import Cells, Grid, Slots, add_evidence
from services.slam.maps.tile_kernels import TILE, beam_ends, sketch, touched_tiles
from services.slam.maps.tiles import GAP, LONGEST, NO_RETURN_REACH, OPEN_LIMIT
from services.slam.reading import Reading
from uvf.maths.planar import Pose2

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

FARTHEST = 20_000.0
"""m, from the map's origin; beyond, nothing is drawn."""
LARGEST = 64_000_000
"""Cells of the square that one reading may cover."""
EMPTY = 0
"""The tile of which nothing is known, which all maps share."""


@dataclass(frozen=True)
class Evidence:
    """What a beam does to the log-odds of a cell that it ends in or goes through, and their bounds; whole numbers of any unit."""

    hit: int
    miss: int
    lowest: int
    highest: int


@dataclass(frozen=True)
class Stroke:
    """Beams as they were drawn, in cells from the corner of tile ``first`` (row, column). ends: (n, 2); hit: (n,)."""

    ends: Floats
    hit: NDArray[np.bool_]
    sensor: tuple[float, float]
    first: tuple[int, int]


class SharedTiles:
    """``maps`` maps of square cells of ``cell`` [m], each of ``channels`` whole numbers."""

    def __init__(self, maps: int, channels: int, cell: float) -> None:
        self.cell = cell
        self._pool: Cells = np.zeros((64, TILE, TILE, channels), dtype=np.int16)
        self._holders = np.zeros(len(self._pool), dtype=np.int64)
        self._free = list(range(len(self._pool) - 1, EMPTY, -1))
        self._slots: Slots = np.full((maps, 64), EMPTY, dtype=np.int32)
        self._columns = 1
        self._directory: Slots = np.zeros((1, 1), dtype=np.int32)
        self._first = np.zeros(2, dtype=np.int64)
        self._window = np.zeros(0, dtype=np.int8)

    @property
    def tiles(self) -> int:
        """Tiles that are held, each counted once."""
        return len(self._pool) - 1 - len(self._free)

    def grid(self, k: int) -> Grid:
        """Map k as compiled kernels read it; good until something is drawn."""
        return self._pool, self._slots[k], self._directory, (int(self._first[0]), int(self._first[1])), self.cell

    def take(self, ancestors: Ints) -> None:
        """Map i becomes what map ancestors[i] was. No tile is copied."""
        self._slots = self._slots[ancestors]
        self._holders = np.bincount(self._slots.ravel(), minlength=len(self._pool))
        self._free = (np.flatnonzero(self._holders[EMPTY + 1 :] == 0) + EMPTY + 1).tolist()

    def draw(self, k: int, reading: Reading, map_from_base: Pose2, evidence: Evidence, reach: float = LONGEST) -> Stroke | None:
        """Draws a reading into map k, and returns what was drawn; None where nothing can be.

        reach: m; beams that say they are longer are no return.
        """
        beams, pose = reading.beams, map_from_base
        if not all(isfinite(v) and abs(v) < FARTHEST for v in pose):
            return None
        c, s = cos(pose.yaw), sin(pose.yaw)
        sensor = (pose.x + c * beams.origin[0] - s * beams.origin[1], pose.y + s * beams.origin[0] + c * beams.origin[1], pose.yaw)
        gate = (beams.range_min, min(beams.range_max, reach, LONGEST), min(NO_RETURN_REACH * beams.range_max, OPEN_LIMIT))
        ends, hit, start, (row, column, rows, columns) = beam_ends((reading.ranges, beams.directions), sensor, gate, self.cell)
        size = rows * columns * TILE * TILE
        if not 0 < size <= LARGEST or not len(ends):
            return None
        if size > self._window.size:
            self._window = np.zeros(size, dtype=np.int8)
        sketch(ends, hit, start, GAP / self.cell, (self._window[:size], columns * TILE))
        window = self._window[:size].reshape(rows * TILE, columns * TILE)
        tiles = touched_tiles(window.view(np.int64))
        if not len(tiles):
            return None
        slots = self._writable(k, tiles + np.array((row, column)))
        add_evidence(window, tiles, slots, self._pool, (evidence.hit, evidence.miss, evidence.lowest, evidence.highest))
        return Stroke(ends, hit, start, (row, column))

    def _writable(self, k: int, places: Ints) -> Ints:
        """Where in the pool the tiles at ``places`` (n, 2) are, row and column, as map k's own."""
        columns = self._columns_of(places)
        slots: Ints = self._slots[k, columns].astype(np.int64)
        shared = np.flatnonzero((slots == EMPTY) | (self._holders[slots] > 1))
        if len(shared):
            self._make_room(len(shared))
            new = np.array([self._free.pop() for _ in range(len(shared))], dtype=np.int64)
            old = slots[shared]
            self._pool[new] = self._pool[old]
            self._holders[old] -= 1
            self._holders[new] = 1
            slots[shared] = new
            self._slots[k, columns[shared]] = new
        return slots

    def _make_room(self, number: int) -> None:
        if number <= len(self._free):
            return
        size = len(self._pool)
        more = max(number, size // 2)
        self._pool = np.concatenate((self._pool, np.zeros((more, *self._pool.shape[1:]), dtype=np.int16)))
        self._holders = np.concatenate((self._holders, np.zeros(more, dtype=np.int64)))
        self._free += range(size, size + more)

    def _columns_of(self, places: Ints) -> Ints:
        """Columns of ``_slots`` for tiles, which no two tiles share."""
        self._cover(places.min(axis=0), places.max(axis=0) + 1)
        rows, columns = (places - self._first).T
        found: Ints = self._directory[rows, columns].astype(np.int64)
        new = np.flatnonzero(found == 0)
        if len(new):
            found[new] = np.arange(self._columns, self._columns + len(new))
            self._directory[rows[new], columns[new]] = found[new]
            self._columns += len(new)
            missing = self._columns - self._slots.shape[1]
            if missing > 0:
                self._slots = np.pad(self._slots, ((0, 0), (0, missing + self._columns // 2)), constant_values=EMPTY)
        return found

    def _cover(self, low: Ints, high: Ints) -> None:
        """Lets the directory reach from tile ``low`` to before ``high``, with room to grow."""
        last = self._first + self._directory.shape
        if (low >= self._first).all() and (high <= last).all():
            return
        spare = np.array(self._directory.shape) // 4 + 1
        before = np.where(low < self._first, self._first - low + spare, 0)
        after = np.where(high > last, high - last + spare, 0)
        self._directory = np.pad(self._directory, ((int(before[0]), int(after[0])), (int(before[1]), int(after[1]))))
        self._first = self._first - before
