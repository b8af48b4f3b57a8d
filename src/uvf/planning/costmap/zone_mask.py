"""Masks drawn over a map: where not to drive, and how fast (the costmap filters of Nav2)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.planning.costmap.costmap import Frame

Floats = NDArray[np.float64]
Values = NDArray[np.int8]
Point = tuple[float, float]

KEPT_OUT = 50
"""Value from which on a cell of a keep-out mask is not to be driven on."""


@dataclass(frozen=True)
class ZoneMask:
    """Values (rows, columns) of cells, resolution and origin [m] in the mask's own frame; outside of it nothing is marked."""

    values: Values
    frame: Frame

    def at(self, points: Floats) -> Values:
        """Values (n,) at points (n, 2) [m, the mask's frame]; 0 outside."""
        resolution, (x, y) = self.frame
        columns, rows = np.floor((points[:, 0] - x) / resolution), np.floor((points[:, 1] - y) / resolution)
        inside = (rows >= 0) & (columns >= 0) & (rows < self.values.shape[0]) & (columns < self.values.shape[1])
        found: Values = np.zeros(len(points), dtype=np.int8)
        found[inside] = self.values[rows[inside].astype(np.int64), columns[inside].astype(np.int64)]
        return found

    def kept_out_near(self, place: Point, reach: float) -> Floats:
        """Centres (n, 2) [m] of the cells within ``reach`` [m] of a place, along both axes, that are not to be driven on."""
        resolution, (x, y) = self.frame
        window = tuple(
            slice(*np.clip(np.floor((np.array((at - reach, at + reach + resolution)) - corner) / resolution), 0, size).astype(int))
            for at, corner, size in ((place[1], y, self.values.shape[0]), (place[0], x, self.values.shape[1]))
        )
        cells = np.argwhere(self.values[window] >= KEPT_OUT) + np.array((window[0].start, window[1].start))
        centres: Floats = (cells[:, ::-1] + 0.5) * resolution + np.array((x, y))
        return centres
