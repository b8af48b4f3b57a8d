"""Log-odds occupancy grid that grows with what is seen, with the mean surface point of each cell."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from services.slam.raster import add_free, add_hits

Floats = NDArray[np.float64]

CHUNK = 64  # cells by which the grid grows at a time
UNKNOWN = -1


class OccupancyMap:
    """Square cells of ``resolution`` [m]; cell [row, column] covers origin + resolution * [column..+1, row..+1]."""

    def __init__(self, resolution: float) -> None:
        self.resolution = resolution
        self.origin = np.zeros(2)
        """(x, y) [m, map frame] of the lower left corner of cell [0, 0]; a whole number of cells from zero."""
        self.log_odds = np.zeros((0, 0), dtype=np.float32)
        self.surface = np.zeros((0, 0, 5), dtype=np.float32)
        self._seen = np.zeros((0, 0), dtype=np.int32)
        self._scans = 0

    def insert(self, hits: Floats, open_ends: Floats, sensor: Floats) -> None:
        """One scan: ends of beams that hit something, ends of the free part of those that did not; m, map frame."""
        self._grow_over(np.vstack((hits, open_ends, sensor[None])))
        self._scans += 1
        in_cells = [(p - self.origin) / self.resolution for p in (hits, open_ends, sensor)]
        layers = (self.log_odds, self.surface, self._seen)
        add_hits(in_cells[0], in_cells[2], layers, self._scans)
        add_free(in_cells[0], in_cells[2], layers, self._scans)
        add_free(in_cells[1], in_cells[2], layers, self._scans)

    @property
    def is_empty(self) -> bool:
        return self._seen.size == 0

    def restore(self, cells: NDArray[np.int8], origin: Floats) -> None:
        """Takes up a map from its published form; surfaces are taken to lie in the middle of their cells.

        cells: (rows, columns) as of ``cells()``; origin: (x, y) [m]. The side a surface was seen from is the free one.
        """
        free, occupied = (cells >= 0) & (cells < 50), cells > 50
        probability = np.clip(cells / 100.0, 0.02, 0.98)
        self.log_odds = np.where(cells < 0, 0.0, np.log(probability / (1.0 - probability))).astype(np.float32)
        self._seen = np.where(cells < 0, 0, 1).astype(np.int32)
        self._scans = 1
        self.origin = np.asarray(origin, dtype=np.float64)
        offsets = np.arange(-2.0, 3.0)
        towards = [
            ndimage.correlate(free.astype(float), o, mode="constant") for o in (np.tile(offsets, (5, 1)), np.tile(offsets[:, None], 5))
        ]
        length = np.hypot(*towards) + 1e-9
        layers = (np.ones(cells.shape), np.full(cells.shape, 0.5), np.full(cells.shape, 0.5), towards[0] / length, towards[1] / length)
        self.surface = (np.stack(layers, axis=-1) * occupied[..., None]).astype(np.float32)

    def cells(self) -> NDArray[np.int8]:
        """(rows, columns): -1 unknown, else the probability of being occupied in per cent."""
        per_cent = 100.0 / (1.0 + np.exp(-self.log_odds))
        return np.where(self._seen > 0, np.rint(per_cent), UNKNOWN).astype(np.int8)

    def _grow_over(self, points: Floats) -> None:
        rows, columns = self.log_odds.shape
        lowest = np.floor((points.min(axis=0) - self.origin) / self.resolution).astype(int) - 2
        highest = np.floor((points.max(axis=0) - self.origin) / self.resolution).astype(int) + 3
        below = -(np.minimum(lowest, 0) // CHUNK) * CHUNK
        above = -(-np.maximum(highest - (columns, rows), 0) // CHUNK) * CHUNK
        if not (below.any() or above.any()):
            return
        pads = ((int(below[1]), int(above[1])), (int(below[0]), int(above[0])))
        self.log_odds = np.pad(self.log_odds, pads)
        self._seen = np.pad(self._seen, pads)
        self.surface = np.pad(self.surface, (*pads, (0, 0)))
        self.origin = self.origin - below * self.resolution
