"""``python -m benchmarks.slam.octree.picture LOG docs/images`` draws docs/images/map-3d.png from a log of the mission ``mapping``."""

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from schemas import topics
from schemas.messages import Grid, OctreeMap
from uvf.runtime.log.reading import read_log
from uvf.runtime.messages.convert import occupancy_cells
from uvf.slam.octree.files import read_octree
from uvf.slam.octree.leaves import Leaves, boxes, coarser, leaves_of

Floats = NDArray[np.float64]

HOUSE = (-1.0, 13.0, -1.0, 10.0)  # m: x and y shown


def newest(log: Path) -> dict[str, bytes]:
    """The last message of each key."""
    return {sample.key: sample.payload for sample in read_log(log)}


def occupied(message: bytes, depth: int) -> tuple[Floats, float]:
    """Middles (n, 3) of the occupied cells of the house, and their side [m]."""
    told = OctreeMap.FromString(message)
    leaves = coarser(leaves_of(read_octree(told.data, "log")), depth)
    here = Leaves(*(part[leaves.values >= 0] for part in leaves))
    middles, sides = boxes(here, told.resolution)
    x_min, x_max, y_min, y_max = HOUSE
    inside = (middles[:, 0] > x_min) & (middles[:, 0] < x_max) & (middles[:, 1] > y_min) & (middles[:, 1] < y_max)
    return middles[inside], float(sides.min())


def draw(said: dict[str, bytes], path: Path) -> None:
    """Occupied cells of rover and aircraft, each in perspective and from above."""
    figure = Figure(figsize=(13.0, 10.5), layout="constrained")
    for k, (vehicle, depth, what) in enumerate((("burger", 15, "burger, depth camera"), ("milvus", 16, "aircraft, lidar from 20 m"))):
        middles, side = occupied(said[topics.OCTREE.at(vehicle)], depth)
        axes = figure.add_subplot(2, 2, 1 + 2 * k, projection="3d")
        order = np.argsort(middles[:, 0] + middles[:, 1])
        shown = middles[order]
        axes.scatter(*shown.T, c=shown[:, 2], cmap="viridis", vmin=0.0, vmax=2.5, s=3.0 if k == 0 else 14.0, marker="s", depthshade=False)
        axes.set(xlim=HOUSE[:2], ylim=HOUSE[2:], zlim=(0, 3), box_aspect=(14, 11, 3), title=f"{what}: occupied cells of {side:g} m")
        axes.view_init(elev=48, azim=-112)
        _from_above(figure.add_subplot(2, 2, 2 + 2 * k), said, vehicle)
    figure.savefig(path, dpi=75)


def _from_above(axes: Axes, said: dict[str, bytes], vehicle: str) -> None:
    """The heights of what is highest, and the slice in black."""
    heights, level = (Grid.FromString(said[topic.at(vehicle)]) for topic in (topics.HEIGHTS, topics.SLICE))
    values = np.frombuffer(heights.data, dtype="<f4").reshape(-1, heights.column_count, 2)
    x, y, side = heights.pose.position.x, heights.pose.position.y, heights.cell_size.x
    extent = (x, x + side * values.shape[1], y, y + side * values.shape[0])
    drawn = axes.imshow(values[:, :, 0], origin="lower", extent=extent, vmin=0.0, vmax=2.5, cmap="viridis")
    axes.figure.colorbar(drawn, ax=axes, label="top, m", shrink=0.8)
    walls = np.where(occupancy_cells(level) == 100, 1.0, np.nan)
    axes.imshow(walls, origin="lower", extent=extent, cmap="gray", vmin=1.0, vmax=2.0)
    axes.set(xlim=HOUSE[:2], ylim=HOUSE[2:], title="top by colour; black: occupied in the slice", xlabel="east, m", ylabel="north, m")


if __name__ == "__main__":
    draw(newest(Path(sys.argv[1])), Path(sys.argv[2]) / "map-3d.png")
