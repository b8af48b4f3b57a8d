"""Occupancy of several maps that share the tiles in which they do not differ."""

from dataclasses import dataclass
from math import cos, isfinite, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2
from uvf.slam.maps.shared_kernels import add_evidence
from uvf.slam.maps.tile_kernels import TILE, beam_ends, sketch, touched_tiles
from uvf.slam.maps.tile_pool import TileKind, TilePool
from uvf.slam.maps.tiles import GAP, LONGEST, NO_RETURN_REACH, OPEN_LIMIT
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

FARTHEST = 20_000.0
"""m, from the map's origin; beyond, nothing is drawn."""
LARGEST = 64_000_000
"""Cells of the square that one reading may cover."""


@dataclass(frozen=True)
class SharedEvidence:
    """Change of a cell's log-odds by a beam that ends in it or goes through it, and their bounds; whole numbers of any unit."""

    hit: int
    miss: int
    lowest: int
    highest: int


@dataclass(frozen=True)
class Stroke:
    """Beams as they were drawn, in cells from the corner of tile ``first`` (row, column).

    ends: (n, 2) [cells]; hit: (n,) whether the beam came back.
    """

    ends: Floats
    hit: NDArray[np.bool_]
    sensor: tuple[float, float]
    first: tuple[int, int]


class SharedTiles(TilePool):
    """``maps`` maps of log-odds in square cells of ``cell`` [m]; number: their type. most: bytes."""

    def __init__(self, maps: int, number: type[np.signedinteger[Any]], cell: float, most: float) -> None:
        super().__init__(maps, TileKind(TILE, 1, number), cell, most)
        self._window = np.zeros(0, dtype=np.int8)

    def draw(self, k: int, reading: Reading, map_from_base: Pose2, evidence: SharedEvidence, reach: float = LONGEST) -> Stroke | None:
        """Draws a reading into map k, and returns what was drawn; None where nothing can be.

        reach: beams that say they are longer [m] are no return.
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
        slots = self.writable(k, tiles + np.array((row, column)))
        add_evidence(window, tiles, slots, self._pool, (evidence.hit, evidence.miss, evidence.lowest, evidence.highest))
        return Stroke(ends, hit, start, (row, column))
