"""Compiled kernels that draw a lidar scan into the map's arrays."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Cells = NDArray[np.float32]
Layers = tuple[Cells, Cells, NDArray[np.int32]]
"""(r, c) log-odds, (r, c, 5) surface, (r, c) number of the last scan that changed the cell."""

HIT, MISS = 0.85, -0.4
"""Change of a cell's log-odds by one end of a beam in it, and by one beam through it (Thrun et al. 2005, table 9.2)."""
LOWEST, HIGHEST = -3.0, 3.5
FULL_WEIGHT = 50.0
"""Number of hits from which on a cell's mean forgets old ones, so that it can follow the refined poses."""


@compiled
def add_hits(hits: Floats, sensor: Floats, layers: Layers, scan: int) -> None:
    """Ends of beams. hits: (n, 2), sensor: (2,), both in cells; layers: log-odds, surface (see below), last scan.

    surface holds per cell the number of hits, the sums of their x and y [cells, relative to the cell's corner] and
    of the unit vector towards the sensor: which face of a thin wall the cell belongs to.
    """
    grid, surface, seen = layers
    for i in range(hits.shape[0]):
        c, r = int(np.floor(hits[i, 0])), int(np.floor(hits[i, 1]))
        if seen[r, c] != scan:
            seen[r, c] = scan
            grid[r, c] = min(grid[r, c] + HIT, HIGHEST)
        dx, dy = sensor[0] - hits[i, 0], sensor[1] - hits[i, 1]
        length = np.sqrt(dx * dx + dy * dy) + 1e-9
        if surface[r, c, 0] >= FULL_WEIGHT:
            for k in range(5):
                surface[r, c, k] *= 1.0 - 1.0 / FULL_WEIGHT
        surface[r, c, 0] += 1.0
        surface[r, c, 1] += hits[i, 0] - c
        surface[r, c, 2] += hits[i, 1] - r
        surface[r, c, 3] += dx / length
        surface[r, c, 4] += dy / length


@compiled
def add_free(ends: Floats, sensor: Floats, layers: Layers, scan: int) -> None:
    """Clears the cells between the sensor and each end (not included), once per scan and never one that was hit.

    Cell by cell along the beam: Amanatides & Woo, "A Fast Voxel Traversal Algorithm" (1987).
    """
    grid, _, seen = layers
    for i in range(ends.shape[0]):
        c, r = int(np.floor(sensor[0])), int(np.floor(sensor[1]))
        dx, dy = ends[i, 0] - sensor[0], ends[i, 1] - sensor[1]
        step_c, step_r = (1 if dx > 0 else -1), (1 if dy > 0 else -1)
        delta_c = abs(1.0 / dx) if dx != 0.0 else np.inf
        delta_r = abs(1.0 / dy) if dy != 0.0 else np.inf
        next_c = ((c + (step_c > 0)) - sensor[0]) / dx if dx != 0.0 else np.inf
        next_r = ((r + (step_r > 0)) - sensor[1]) / dy if dy != 0.0 else np.inf
        while min(next_c, next_r) < 1.0:
            if seen[r, c] != scan:
                seen[r, c] = scan
                grid[r, c] = max(grid[r, c] + MISS, LOWEST)
            if next_c < next_r:
                next_c += delta_c
                c += step_c
            else:
                next_r += delta_r
                r += step_r
