"""Maps made by others, as they are found below the folder of data: Moving AI's grids with their queries, and maps for ROS' map server.

Moving AI: Sturtevant, "Benchmarks for grid-based pathfinding" (2012); steps to eight neighbours, corners are not cut.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray
from PIL import Image

from uvf.models.yaml_data import BadInput
from uvf.planning.costmap.costmap import Costmap, make_costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation

Cells = NDArray[np.int8]
PASSABLE = ".GS"
POINT = RobotFootprint.circle(0.4)
"""In cells of 1 m: so small that only occupied cells are shut."""


@dataclass(frozen=True)
class Scenario:
    """Queries on one map: ``ends`` (n, 4) row and column of start and goal, ``lengths`` (n,) [cells] of the shortest paths."""

    name: str
    family: str
    cells: Cells
    ends: NDArray[np.int64]
    lengths: NDArray[np.float64]

    def costmap(self) -> Costmap:
        """The map in cells of 1 m for a point, without costs."""
        return make_costmap(self.cells, (1.0, (0.0, 0.0)), POINT, Inflation(0.9, 1.0))


def scenarios(data: Path | None) -> Iterator[Scenario]:
    """Every scenario below DATA/movingai that has its map, small maps first. Raises BadInput without one."""
    folder = (data or Path()) / "movingai"
    maps = {(path.parent.name, path.name): path for path in folder.rglob("*.map")}
    found = [(path, maps.get((path.parent.name, path.stem))) for path in folder.rglob("*.map.scen")]
    paired = sorted(((grid.stat().st_size, grid, path) for path, grid in found if grid is not None))
    if not paired:
        raise BadInput(f"no *.map.scen with its *.map below {folder}: give the folder of benchmark data with --data")
    for _, grid, path in paired:
        fields = [line.split() for line in path.read_text().splitlines()[1:] if line.strip()]
        ends = np.array([[int(field[k]) for k in (5, 4, 7, 6)] for field in fields])
        yield Scenario(grid.stem, grid.parent.name, read_grid(grid), ends, np.array([float(field[8]) for field in fields]))


def read_grid(path: Path) -> Cells:
    """(rows, columns) of a Moving AI map, 0 passable, 100 not; row 0 is the file's first."""
    lines = path.read_text().splitlines()
    begun = lines.index("map") + 1
    return np.array([[0 if letter in PASSABLE else 100 for letter in line] for line in lines[begun:] if line], dtype=np.int8)


@dataclass(frozen=True)
class RosMap:
    """A map of ROS' map server: ``cells`` (rows, columns) -1 unknown, 0 free, 100 occupied; ``resolution`` [m]."""

    name: str
    cells: Cells
    resolution: float


def ros_maps(data: Path | None) -> list[RosMap]:
    """Every map with a YAML file in DATA/nav_maps. Raises BadInput without one."""
    folder = (data or Path()) / "nav_maps"
    found = sorted(folder.glob("*.yaml"))
    if not found:
        raise BadInput(f"no *.yaml in {folder}: give the folder of benchmark data with --data")
    return [_ros_map(path) for path in found]


def _ros_map(path: Path) -> RosMap:
    """As map_server reads it: dark is occupied, or light with ``negate``."""
    about = yaml.safe_load(path.read_text())
    with Image.open(path.parent / about["image"]) as image:
        grey = np.asarray(image.convert("L"), dtype=np.float64)[::-1] / 255.0
    occupied = grey if about["negate"] else 1.0 - grey
    cells = np.full(grey.shape, -1, dtype=np.int8)
    cells[occupied > about["occupied_thresh"]], cells[occupied < about["free_thresh"]] = 100, 0
    return RosMap(path.stem, cells, float(about["resolution"]))
