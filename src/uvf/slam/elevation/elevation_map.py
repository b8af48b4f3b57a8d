"""Heights of the ground and of what stands on it, column by column, from points that a lidar has hit: a 2.5-D map.

Each surface is tracked by a gate and a mean (Fankhauser et al., "Robot-Centric Elevation Mapping with Uncertainty Estimates", CLAWAR 2014,
section 3.1, with a fixed gate for the Mahalanobis distance).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Counts = NDArray[np.int32]

SMOOTH = 10.0
"""m, over which what points were raised by is averaged: no pass knows the height better than another one."""
GROW = 64  # columns that the map grows by, so that it seldom does
MOST_COLUMNS, LONGEST = 3_900_000, 6_200
"""Of a map that still goes into one message and into a log: 31 MB of heights, and so many columns along a side."""
FORGETS = 50
"""Points that a mean is made of: later ones weigh no less than 1 / this. A surface beyond the gate, once hit, stays."""


class MapFull(ValueError):
    """The map would have more than ``MOST_COLUMNS`` columns, or more than ``LONGEST`` along a side."""


@dataclass(frozen=True)
class Elevation:
    """Heights (rows, columns) [m] of square columns of side ``resolution`` [m]; row 0 is at the lowest y, its first corner at (x, y) [m].

    ground: of the lowest surface that was hit, top: of the highest one; NaN where nothing was.
    """

    top: Singles
    ground: Singles
    resolution: float
    x: float
    y: float

    def within(self, area: tuple[float, float, float, float]) -> "Elevation | None":
        """The columns that lie in x_min, y_min, x_max, y_max [m]; None where there are none."""
        rows, columns = self.ground.shape
        first = np.clip(np.ceil((np.array(area[:2]) - (self.x, self.y)) / self.resolution - 1e-6), 0, (columns, rows)).astype(int)
        last = np.clip(np.floor((np.array(area[2:]) - (self.x, self.y)) / self.resolution + 1e-6), 0, (columns, rows)).astype(int)
        if (last <= first).any():
            return None
        window = slice(first[1], last[1]), slice(first[0], last[0])
        x, y = (first * self.resolution + (self.x, self.y)).tolist()
        return Elevation(self.top[window], self.ground[window], self.resolution, x, y)


class ElevationMap:
    """Grows to where points are. ``gate`` [m]: a point so near to a surface belongs to it; one beyond is another surface."""

    def __init__(self, resolution: float, gate: float) -> None:
        self.resolution, self.gate = resolution, gate
        self._low = np.zeros(2, dtype=np.int64)
        self._heights = np.empty((0, 0, 2), dtype=np.float64)
        self._counts = np.empty((0, 0, 2), dtype=np.int32)
        self._hit_at = np.empty((0, 0), dtype=np.float32)
        self._raised = np.empty((0, 0, 2), dtype=np.float32)

    def surface(self, points: Floats, before: float) -> Floats:
        """(n,) height [m] of ground or top, the nearer one, at each of the points (n, 3) [m]; NaN unless last hit before ``before`` [s]."""
        found = np.full(len(points), np.nan)
        finite = np.flatnonzero(np.isfinite(points).all(axis=1))
        column, row = (np.floor(points[finite, :2] / self.resolution).astype(np.int64) - self._low).T
        rows, columns = self._hit_at.shape
        inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
        finite, column, row = finite[inside], column[inside], row[inside]
        known = (self._counts[row, column, 0] > 0) & (self._hit_at[row, column] < before)
        finite, heights = finite[known], self._heights[row[known], column[known]]
        nearer = np.abs(heights - points[finite, 2:]).argmin(axis=1)
        found[finite] = heights[np.arange(len(heights)), nearer]
        return found

    def insert(self, points: Floats, t: float = -np.inf, raised: Floats | None = None) -> None:
        """Points (n, 3) [m] that were hit at ``t`` [s]; those that are not finite are left out.

        raised: (n,) [m], by so much they are drawn higher, to fit what was drawn before. Raises MapFull, and takes none of them then.
        """
        finite = np.isfinite(points).all(axis=1)
        points, by = points[finite], np.zeros(int(finite.sum())) if raised is None else raised[finite]
        if not len(points):
            return
        cells = np.floor(points[:, :2] / self.resolution).astype(np.int64)
        self._make_room(cells.min(axis=0), cells.max(axis=0) + 1)
        cells -= self._low
        _fuse(self._heights, self._counts, cells, points[:, 2] + by, self.gate)
        _average(self._raised, cells, by)
        self._hit_at[cells[:, 1], cells[:, 0]] = t

    def elevation(self) -> Elevation | None:
        """The map as far as anything was hit; None while nothing was. The rest of the grid is left out."""
        hit = self._counts[:, :, 0] > 0
        if not hit.any():
            return None
        rows, columns = (np.flatnonzero(hit.any(axis=axis)) for axis in (1, 0))
        window = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        datum = _smooth(self._raised[window], SMOOTH / self.resolution)
        ground, top = (np.where(hit[window], self._heights[(*window, k)] - datum, np.nan).astype(np.float32) for k in (0, 1))
        x, y = ((self._low + np.array((columns[0], rows[0]))) * self.resolution).tolist()
        return Elevation(top, ground, self.resolution, x, y)

    def resume(self, left: Elevation) -> None:
        """Goes on with a map that was drawn before, as if each surface had been hit once."""
        rows, columns = np.nonzero(np.isfinite(left.ground))
        centres = np.column_stack(((columns + 0.5) * left.resolution + left.x, (rows + 0.5) * left.resolution + left.y))
        for heights in (left.ground, left.top):
            self.insert(np.column_stack((centres, heights[rows, columns].astype(np.float64))))

    def _make_room(self, low: NDArray[np.int64], high: NDArray[np.int64]) -> None:
        size = np.array(self._counts.shape[1::-1])
        if size.all():
            low, high = np.minimum(low, self._low), np.maximum(high, self._low + size)
            if (low == self._low).all() and (high == self._low + size).all():
                return
        low, high = low // GROW * GROW, -(-high // GROW) * GROW
        columns, rows = (high - low).tolist()
        if rows * columns > MOST_COLUMNS or max(rows, columns) > LONGEST:
            raise MapFull(f"the map would have {rows} x {columns} columns; {MOST_COLUMNS} are possible, {LONGEST} along a side")
        heights, counts = np.zeros((rows, columns, 2)), np.zeros((rows, columns, 2), dtype=np.int32)
        hit_at, raised = np.zeros((rows, columns), dtype=np.float32), np.zeros((rows, columns, 2), dtype=np.float32)
        if size.all():
            column, row = self._low - low
            window = slice(row, row + size[1]), slice(column, column + size[0])
            heights[window], counts[window] = self._heights, self._counts
            hit_at[window], raised[window] = self._hit_at, self._raised
        self._low, self._heights, self._counts, self._hit_at, self._raised = low, heights, counts, hit_at, raised


def _smooth(raised: Singles, side: float) -> Floats:
    """(rows, columns) [m] by how much points about each column were raised on the average, within about ``side`` columns."""
    sums = np.asarray(raised, dtype=np.float64)
    for _ in range(2):
        sums = ndimage.uniform_filter(sums, size=(2 * round(side / 2) + 1,) * 2 + (1,), mode="constant")
    smooth: Floats = sums[:, :, 0] / np.maximum(sums[:, :, 1], 1e-9)
    return smooth


@compiled
def _average(raised: Singles, cells: NDArray[np.int64], by: Floats) -> None:
    """raised: (rows, columns, 2) sum over passes of what points were raised by, and of how many; cells: (n, 2) column and row."""
    for i in range(len(by)):
        column, row = cells[i]
        raised[row, column, 0] += by[i]
        raised[row, column, 1] += 1.0


@compiled
def _fuse(heights: Floats, counts: Counts, cells: NDArray[np.int64], z: Floats, gate: float) -> None:
    """heights, counts: (rows, columns, 2) of the ground and of the top; cells: (n, 2) column and row."""
    for i in range(len(z)):
        column, row = cells[i]
        for k, up in ((0, -1.0), (1, 1.0)):
            beyond = up * (z[i] - heights[row, column, k])
            if counts[row, column, k] == 0 or beyond > gate:
                heights[row, column, k], counts[row, column, k] = z[i], 1
            elif beyond >= -gate:
                counts[row, column, k] += 1
                heights[row, column, k] += (z[i] - heights[row, column, k]) / min(counts[row, column, k], FORGETS)
