"""A map prepared for planning: costs by the values of ROS' costmap_2d, distances to obstacles, and headings that are shut."""

from dataclasses import dataclass
from functools import cached_property
from math import floor

import numpy as np
from numpy.typing import NDArray

from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.headings import Bits, blocked_headings
from uvf.planning.costmap.inflation import FREE_SPACE, INSCRIBED, LETHAL, NO_INFORMATION, Inflation, inflate

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Cell = tuple[int, int]

OCCUPIED, FREE = 60, 40  # per cent: at least, at most
FAR = 1e9
"""Cells; no map reaches so far, and farther places are counted as lying there."""

Frame = tuple[float, tuple[float, float]]
"""Resolution [m] and (x, y) [m, map frame] of the lower left corner of cell [0, 0]."""


@dataclass(frozen=True)
class Costmap:
    """A map prepared for planning; arrays are (rows, columns), points [m] in the map frame."""

    resolution: float
    origin: tuple[float, float]
    footprint: RobotFootprint
    values: Bytes
    """0 free, 1 to 252 near an obstacle, 253 within the inscribed radius, 254 an obstacle, 255 unknown."""
    free: Mask
    """Known to be free, however near an obstacle is."""
    unknown: Mask
    distance: Floats
    """Cells, from centre to centre of the nearest occupied cell."""

    @property
    def clearance(self) -> Floats:
        """(rows, columns) m to the nearest occupied cell's edge."""
        return (self.distance - 0.5) * self.resolution

    def clearance_at(self, cell: Cell) -> float:
        """Distance [m] from a cell's centre to the nearest occupied cell's edge."""
        return float(self.distance[cell] - 0.5) * self.resolution

    @property
    def passable(self) -> Mask:
        """(rows, columns) where the vehicle's centre may be: known ground, beyond the inscribed radius of every obstacle."""
        out: Mask = self.values < INSCRIBED
        return out

    @cached_property
    def blocked(self) -> Bits:
        """(rows, columns) bit ``heading_bin(yaw)`` set: the footprint at the cell's centre with that yaw touches an occupied cell."""
        return blocked_headings(self.values == LETHAL, self.resolution, self.footprint)

    @property
    def frame(self) -> Frame:
        """Resolution and origin."""
        return self.resolution, self.origin

    def cell(self, x: float, y: float) -> Cell:
        """Cell (row, column) of a point [m, map frame], which must be finite; may lie outside."""
        return self._index(y - self.origin[1]), self._index(x - self.origin[0])

    def _index(self, distance: float) -> int:
        return floor(min(max(distance / self.resolution, -FAR), FAR))

    def holds(self, cell: Cell) -> bool:
        """Whether a cell (row, column) lies on the map."""
        rows, columns = self.values.shape
        return bool(0 <= cell[0] < rows and 0 <= cell[1] < columns)

    def points(self, cells: NDArray[np.int64]) -> Floats:
        """Centres (n, 2) [m, map frame] of the cells (n, 2), given as row and column."""
        out: Floats = (cells[:, ::-1] + 0.5) * self.resolution + np.array(self.origin)
        return out


def make_costmap(cells: NDArray[np.int8], frame: Frame, footprint: RobotFootprint, inflation: Inflation) -> Costmap:
    """The costmap of an occupancy grid (rows, columns): -1 unknown, 0..100 per cent.

    Half a cell is added to the inscribed radius: what a map shows as occupied may lie anywhere in its cell.
    """
    resolution, origin = frame
    occupied, unknown = cells >= OCCUPIED, cells < 0
    free = ~unknown & (cells <= FREE)
    raw = np.full(cells.shape, INSCRIBED, dtype=np.uint8)  # what is neither free nor occupied: not to be entered, nor inflated
    raw[free], raw[occupied], raw[unknown] = FREE_SPACE, LETHAL, NO_INFORMATION
    values, distance = inflate(raw, resolution, footprint.inscribed_radius + resolution / 2, inflation)
    return Costmap(resolution, origin, footprint, values, free, unknown, distance)
