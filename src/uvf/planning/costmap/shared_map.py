"""A map that another vehicle has made, laid below a vehicle's own one."""

from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from uvf.maths.grids import distance_field
from uvf.maths.se2 import Pose2, inverse, transform
from uvf.planning.costmap.costmap import Frame
from uvf.planning.costmap.terrain import OVERHEAD

Cells = NDArray[np.int8]
Floats = NDArray[np.float64]

UNKNOWN, OCCUPIED = -1, 65
"""Values of a map: nothing is known; per cent, from which on a cell is an obstacle."""
BESIDE = 2
"""Cells beside those that a vehicle has covered which are taken for free: a way needs some room."""


class SharedMap:
    """Cells (rows, columns) of -1 unknown, 0..100 per cent, of side ``resolution`` [m], whose first corner lies at ``map_from_cells``.

    outranks: whether its obstacles count where the vehicle's own map shows free ground, too: a lidar looks over a ditch. Not what is
    overhead where the vehicle has driven: from above a crown is an obstacle, and who stands under it would not get out.
    """

    def __init__(self, cells: Cells, resolution: float, map_from_cells: Pose2, *, outranks: bool) -> None:
        self._cells, self._resolution, self._map_from_cells, self._outranks = cells, resolution, map_from_cells, outranks
        self._drawn: tuple[Cells, Frame] | None = None

    def below(self, cells: Cells, frame: Frame, driven: Floats, radius: float) -> tuple[Cells, Frame]:
        """The vehicle's own map, its resolution and origin [m], with this one where it shows nothing; as large as both together.

        driven: (n, 2) [m] where a vehicle of this ``radius`` [m] has been, in its own map frame.
        """
        resolution, own_corner = frame
        if self._drawn is None or self._drawn[1][0] != resolution:
            self._drawn = self._as_cells_of(frame)
        drawn, (_, corner) = self._drawn
        column, row = (round((own - low) / resolution) for own, low in zip(own_corner, corner, strict=True))
        left, bottom = min(column, 0), min(row, 0)
        right, top = max(column + cells.shape[1], drawn.shape[1]), max(row + cells.shape[0], drawn.shape[0])
        both = np.full((top - bottom, right - left), UNKNOWN, dtype=np.int8)
        both[-bottom : drawn.shape[0] - bottom, -left : drawn.shape[1] - left] = drawn
        own = both[row - bottom : row - bottom + cells.shape[0], column - left : column - left + cells.shape[1]]
        wins = cells != UNKNOWN
        if self._outranks:
            wins &= (own < OCCUPIED) | ((own == OVERHEAD) & _covered(driven, radius, frame, cells.shape))
        own[wins] = cells[wins]
        x, y = own_corner[0] + (left - column) * resolution, own_corner[1] + (bottom - row) * resolution
        return both, (resolution, (x, y))

    def cells_with(self, shape: tuple[int, int], frame: Frame) -> float:
        """How many cells the two maps have together; shape (rows, columns) and frame of the vehicle's own one."""
        resolution, corner = frame[0], np.array(frame[1])
        rim = self._rim()
        low, high = np.minimum(rim.min(axis=0), corner), np.maximum(rim.max(axis=0), corner + resolution * np.array(shape[::-1]))
        return float(np.prod((high - low) / resolution))

    def _rim(self) -> NDArray[np.float64]:
        """Corners (4, 2) [m] of this map in the vehicle's own map frame."""
        rows, columns = self._cells.shape
        return transform(self._map_from_cells, np.array(((0, 0), (columns, 0), (0, rows), (columns, rows))) * self._resolution)

    def _as_cells_of(self, frame: Frame) -> tuple[Cells, Frame]:
        """This map in cells of the vehicle's own one, by the value at their centres; no obstacle is lost between them."""
        resolution, (x, y) = frame
        rows, columns = self._cells.shape
        corners = self._rim()
        low = [floor((at - own) / resolution + 1e-6) for at, own in zip(corners.min(axis=0), (x, y), strict=True)]
        high = [ceil((at - own) / resolution - 1e-6) for at, own in zip(corners.max(axis=0), (x, y), strict=True)]
        across, up = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
        centres = np.column_stack((across.ravel(), up.ravel())) * resolution + (x, y)
        at = np.floor(transform(inverse(self._map_from_cells), centres) / self._resolution).astype(np.int64)
        inside = ((at >= 0) & (at < (columns, rows))).all(axis=1)
        drawn = np.full(across.size, UNKNOWN, dtype=np.int8)
        drawn[inside] = self._cells[at[inside, 1], at[inside, 0]]
        cells = drawn.reshape(across.shape)
        corner = x + low[0] * resolution, y + low[1] * resolution
        obstacles = np.argwhere(self._cells >= OCCUPIED)
        places = transform(self._map_from_cells, (obstacles[:, ::-1].astype(np.float64) + 0.5) * self._resolution)
        column, row = np.floor((places - corner) / resolution).astype(np.int64).T
        np.maximum.at(cells, (row, column), self._cells[obstacles[:, 0], obstacles[:, 1]])
        return cells, (resolution, corner)


def _covered(driven: Floats, radius: float, frame: Frame, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """Cells (rows, columns) that a vehicle of this radius [m] has covered at ``driven`` (n, 2) [m], and ``BESIDE`` about them."""
    resolution, corner = frame
    at = np.floor((driven - corner) / resolution).astype(np.int64)[:, ::-1]
    at = at[((at >= 0) & (at < shape)).all(axis=1)]
    covered = np.zeros(shape, dtype=np.bool_)
    if len(at):
        reach = ceil(radius / resolution) + BESIDE
        low, high = np.maximum(at.min(axis=0) - reach, 0), at.max(axis=0) + reach + 1
        middles = np.zeros(tuple(np.minimum(high, shape) - low), dtype=np.bool_)
        middles[tuple((at - low).T)] = True
        covered[low[0] : high[0], low[1] : high[1]] = distance_field(middles) <= radius / resolution + BESIDE
    return covered
