"""Masks as Nav2 has them: maps of map_server whose cells say where not to drive, or how fast.

https://docs.nav2.org/configuration/packages/costmap-plugins/keepout_filter.html and speed_filter.html.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from uvf.models.world.map_file import GridMap
from uvf.slam.maps.placing import cells_of, centres, values_at

Mask = NDArray[np.bool_]
Floats = NDArray[np.float64]

LETHAL = 100
"""What keeps out; lower values are dear ground to Nav2, and driven on here."""


@dataclass(frozen=True)
class KeepOut:
    """A keep-out mask, as read from its file."""

    mask: GridMap

    def onto(self, grid: GridMap) -> Mask:
        """Mask (rows, columns) of ``grid``: the cells that a kept-out one touches with its centre, or that have theirs in one."""
        kept_out: Mask = values_at(self.mask, centres(grid)).reshape(grid.cells.shape) == LETHAL
        row, column, inside = cells_of(grid, centres(self.mask)[self.mask.cells.ravel() == LETHAL])
        kept_out[row[inside], column[inside]] = True
        return kept_out

    def layer(self) -> GridMap:
        """The mask as a grid: 100 keep out, 0 not."""
        return GridMap(np.where(self.mask.cells == LETHAL, 100, 0).astype(np.int8), self.mask.resolution, self.mask.origin)


@dataclass(frozen=True)
class SpeedLimit:
    """A speed mask: its value v, 1..100, allows base + multiplier * v, in per cent of the vehicle's own speed or in m/s.

    0 and unknown are no limit. Nav2's demonstration has base 100 and multiplier -1: the darker, the slower.
    """

    mask: GridMap
    unit: Literal["percent", "m/s"] = "percent"
    base: float = 100.0
    multiplier: float = -1.0

    def shares(self, full_speed: float) -> Floats:
        """Allowed share (rows, columns), 0 to 1, of the vehicle's full speed [m/s], at the mask's cells."""
        values = self.mask.cells.astype(np.float64)
        limit = self.base + self.multiplier * values
        share = limit / 100.0 if self.unit == "percent" else limit / full_speed
        return np.where(values > 0, np.clip(share, 0.0, 1.0), 1.0)

    def onto(self, grid: GridMap, full_speed: float) -> Floats:
        """Allowed speed (rows, columns) [m/s] at the centres of the cells of ``grid``, for a vehicle of ``full_speed`` [m/s]."""
        values = values_at(self.layer(full_speed), centres(grid)).reshape(grid.cells.shape)
        return np.where(values < 0, 1.0, values / 100.0) * full_speed

    def layer(self, full_speed: float) -> GridMap:
        """The mask as a grid of per cent of the full speed [m/s], rounded down."""
        return GridMap(np.floor(self.shares(full_speed) * 100.0 + 1e-6).astype(np.int8), self.mask.resolution, self.mask.origin)
