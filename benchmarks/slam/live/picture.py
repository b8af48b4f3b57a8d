"""The picture of a map that a rover has drawn, with the true walls and both ways on it."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from uvf.maths.se2 import inverse, transform
from uvf.models.world.map_file import GridMap

Floats = NDArray[np.float64]

INCHES = 14.0
WALL, TRUE, TOLD = "#d62728", "#1f77b4", "#e07b00"


class Shown(NamedTuple):
    """All in the world frame. walls: (n, 2, 2) m; truth, told: (n, 4) t, x, y, yaw."""

    grid: GridMap
    walls: Floats
    truth: Floats
    told: Floats


def draw(shown: Shown, title: str, target: Path) -> None:
    """Along the map's own axes, so that its cells are shown as they are. Writes a PNG."""
    grid, map_from_world = shown.grid, inverse(shown.grid.origin)
    size = np.array(grid.cells.shape[::-1]) * grid.resolution
    figure = Figure(figsize=tuple(INCHES * size / size.max()), layout="constrained")
    axes = figure.add_subplot()
    grey = np.where(grid.cells < 0, 0.75, 1.0 - grid.cells / 100.0)
    axes.imshow(grey, cmap="gray", vmin=0.0, vmax=1.0, origin="lower", extent=(0.0, size[0], 0.0, size[1]), interpolation="nearest")
    walls = transform(map_from_world, shown.walls.reshape(-1, 2)).reshape(-1, 2, 2)
    axes.add_collection(LineCollection(list(walls), colors=WALL, linewidths=0.5))
    for way, colour in ((shown.truth, TRUE), (shown.told, TOLD)):
        axes.plot(*transform(map_from_world, way[:, 1:3]).T, color=colour, lw=0.6)
    axes.set_title(f"{title}: map, true walls (red), true way (blue), told way (orange)", fontsize=9, loc="left")
    axes.set_aspect("equal")
    figure.savefig(target, dpi=100)
