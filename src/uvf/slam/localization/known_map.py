"""A map that is given: what a vehicle is localized on."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uvf.maths.grids import distance_field
from uvf.maths.se2 import IDENTITY, Pose2, compose, transform
from uvf.models.world.map_file import GridMap, load_map
from uvf.models.yaml_data import BadInput
from uvf.slam.localization import surfaces
from uvf.slam.localization.surfaces import FREE, OCCUPIED
from uvf.slam.maps.placing import cells_of, centres, values_at
from uvf.slam.maps.session import MappingSession
from uvf.slam.maps.tiles import TileMap
from uvf.slam.matching.cloud import Cloud
from uvf.slam.matching.likelihood import LikelihoodField, likelihood_field
from uvf.slam.matching.point_map import PointMap, point_map
from uvf.slam.method import Keyframe

Floats = NDArray[np.float64]

SESSION = ".npz"
CELL = 0.05  # m, of a session's grid
FARTHEST = 1.0  # m, distances are kept up to this
SEARCH_CELL, SEARCH_SIGMA, SEARCH_DEPTH = 0.1, 0.12, 3  # m, m, levels of bounds
LEAST_SURFACE = 20  # points
MOST_CELLS = 100_000_000
UNKNOWN, OUTSIDE = -1.0, -2.0  # distances where nothing is known begin at the one and end at the other


@dataclass(frozen=True)
class KnownMap:
    """A map that vehicles are localized on; all in the map frame.

    grid: occupancy, its axes those of the frame; distances: (rows, columns) [m] to the nearest occupied cell, as much below -1 where
    the map does not know whether the floor is free; surfaces: what sweeps are matched to; field: where a sweep is searched for in
    the whole map.
    """

    grid: GridMap
    distances: NDArray[np.float32]
    surfaces: PointMap
    field: LikelihoodField

    @cached_property
    def places(self) -> Floats:
        """Middles (n, 2) [m] of the cells where a vehicle may stand."""
        row, column = np.nonzero((self.grid.cells >= 0) & (self.grid.cells <= FREE))
        return transform(self.grid.origin, np.column_stack((column + 0.5, row + 0.5)) * self.grid.resolution)

    @cached_property
    def floor(self) -> NDArray[np.bool_]:
        """Mask (columns, rows) of the field's cells in which a vehicle may stand."""
        floor = np.zeros(self.field.levels.shape[1:], dtype=np.bool_)
        cells = np.floor((self.places - np.array(self.field.corner)) / self.field.resolution).astype(np.int64)
        inside = ((cells >= 0) & (cells < floor.shape)).all(axis=1)
        floor[cells[inside, 0], cells[inside, 1]] = True
        return floor

    def covers(self, pose: Pose2) -> bool:
        """Whether a pose lies within the grid."""
        return bool(cells_of(self.grid, np.array((pose[:2],)))[2][0])


def of_grid(grid: GridMap, map_from_grid: Pose2 = IDENTITY, source: str = "map") -> KnownMap:
    """Known map of an occupancy grid; map_from_grid: of the frame that its origin is in. Raises BadInput where it has too few walls."""
    placed = GridMap(grid.cells, grid.resolution, compose(map_from_grid, grid.origin))
    return _known(upright(placed), surfaces.of_grid(placed), source)


def of_keyframes(keyframes: Sequence[Keyframe], source: str = "map") -> KnownMap:
    """Known map of a session's keyframes. Raises BadInput where they show too few walls."""
    tiles = TileMap(CELL)
    tiles.follow(keyframes)
    cells, (x, y) = tiles.cells()
    grid = GridMap(cells, CELL, Pose2(x, y, 0.0))
    return _known(grid, surfaces.of_keyframes(keyframes, grid), source)


def is_session(path: Path) -> bool:
    """Whether the path is that of a session's file, by its ending."""
    return path.suffix == SESSION


def known_map(path: Path, map_from_file: Pose2) -> KnownMap:
    """Known map of a session's file or a map's. Raises BadInput."""
    if not is_session(path):
        return of_grid(load_map(path), map_from_file, str(path))
    keyframes = MappingSession.load(path).keyframes
    return of_keyframes([Keyframe(compose(map_from_file, k.map_from_base), k.reading) for k in keyframes], str(path))


def upright(grid: GridMap) -> GridMap:
    """The same map with cells along the axes of its frame; no occupied cell of a turned one is lost."""
    if abs(grid.origin.yaw) < 1e-9:
        return grid
    rows, columns = grid.cells.shape
    size = grid.resolution
    corners = transform(grid.origin, np.array(((0, 0), (columns, 0), (0, rows), (columns, rows))) * size)
    low, high = corners.min(axis=0), corners.max(axis=0)
    shape = tuple(int(n) for n in np.ceil((high - low) / size)[::-1])
    out = GridMap(np.full(shape, -1, dtype=np.int8), size, Pose2(float(low[0]), float(low[1]), 0.0))
    cells = values_at(grid, centres(out)).reshape(shape)
    occupied = grid.cells.ravel() > OCCUPIED
    row, column, inside = cells_of(out, centres(grid)[occupied])
    cells[row[inside], column[inside]] = grid.cells.ravel()[occupied][inside]
    return GridMap(cells, size, out.origin)


def _known(grid: GridMap, cloud: Cloud, source: str) -> KnownMap:
    if grid.cells.size > MOST_CELLS:
        raise BadInput(f"{source}: a map of {grid.cells.size} cells is too large to be localized on; {MOST_CELLS} are the most")
    if len(cloud.points) < LEAST_SURFACE:
        raise BadInput(f"{source}: a map with {len(cloud.points)} cells of walls beside free floor: there is nothing to be localized by")
    distances = np.minimum(distance_field(grid.cells > OCCUPIED) * grid.resolution, FARTHEST).astype(np.float32)
    unknown = (grid.cells < 0) | ((grid.cells > FREE) & (grid.cells <= OCCUPIED))
    distances[unknown] = UNKNOWN - distances[unknown]
    field = likelihood_field(cloud.points, SEARCH_CELL, SEARCH_SIGMA, SEARCH_DEPTH)
    return KnownMap(grid, distances, point_map([cloud]), field)
