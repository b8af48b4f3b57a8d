"""The terrain of a world: its heights anywhere, and the same as triangles in a file, which is what every engine reads."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from uvf.models.generated_file import mesh_file
from uvf.models.world.file import Terrain, WorldFile
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

WHITE = {"L": 255.0, "I": 65535.0, "I;16": 65535.0, "I;16B": 65535.0}
"""By the kind of picture."""
FINEST = 513  # pixels a side: half a million triangles


@dataclass(frozen=True)
class Relief:
    """Heights (rows, columns) [m, world] at x (columns,) and y (rows,) [m, world], both rising.

    Each cell is two triangles, cut from the south-west.
    """

    x: Floats
    y: Floats
    heights: Floats

    def at(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Height [m, world] and slope, as a gradient [-], at points x and y [m, world] of any shape (...,); 0 and level beyond the rim."""
        dx, dy = self.x[1] - self.x[0], self.y[1] - self.y[0]
        u, v = (np.asarray(x) - self.x[0]) / dx, (np.asarray(y) - self.y[0]) / dy
        columns, rows = len(self.x) - 1, len(self.y) - 1
        inside = (u >= 0) & (u <= columns) & (v >= 0) & (v <= rows)
        c = np.clip(np.floor(u), 0, columns - 1).astype(np.int64)
        r = np.clip(np.floor(v), 0, rows - 1).astype(np.int64)
        h = self.heights
        south_west, south_east, north_west, north_east = h[r, c], h[r, c + 1], h[r + 1, c], h[r + 1, c + 1]
        is_lower = u - c >= v - r
        east = np.where(is_lower, south_east - south_west, north_east - north_west)
        north = np.where(is_lower, north_east - south_east, north_west - south_west)
        height = south_west + (u - c) * east + (v - r) * north
        return np.where(inside, height, 0.0), np.where(inside, np.hypot(east / dx, north / dy), 0.0)

    def triangles(self) -> tuple[Floats, Ints]:
        """Vertices (n, 3) [m, world] and faces (m, 3), anticlockwise from above; the rim has walls down to 0."""
        rows, columns = self.heights.shape
        grid_x, grid_y = np.meshgrid(self.x, self.y)
        top = np.column_stack((grid_x.ravel(), grid_y.ravel(), self.heights.ravel()))
        index = np.arange(rows * columns).reshape(rows, columns)
        a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
        faces = np.concatenate((np.column_stack((a, b, c)), np.column_stack((a, c, d))))
        ring = np.concatenate((index[0, :-1], index[:-1, -1], index[-1, :0:-1], index[:0:-1, 0]))
        foot = rows * columns + np.arange(len(ring))
        walls = np.array(list(_walls(ring, foot, self.heights.ravel())), dtype=np.int64).reshape(-1, 3)
        return np.concatenate((top, top[ring] * (1.0, 1.0, 0.0))), np.concatenate((faces, walls))


def _walls(ring: Ints, foot: Ints, heights: Floats) -> Iterator[tuple[int, int, int]]:
    """Between the rim and its foot on z = 0, where they are apart."""
    for i, (one, other) in enumerate(zip(ring, np.roll(ring, -1), strict=True)):
        below, below_other = foot[i], foot[(i + 1) % len(foot)]
        if heights[one] > 0:
            yield int(below), int(below_other), int(one)
        if heights[other] > 0:
            yield int(below_other), int(other), int(one)


def relief(world: WorldFile) -> Relief | None:
    """Relief of a loaded world's terrain; None where it is flat. Raises BadInput."""
    return None if world.terrain is None else relief_of(world.terrain)


def relief_of(terrain: Terrain) -> Relief:
    """Relief of a loaded world's terrain. Raises BadInput for a picture that cannot be read."""
    return _read(Path(terrain.heights), terrain)


@lru_cache(maxsize=4)
def _read(path: Path, terrain: Terrain) -> Relief:
    try:
        picture = Image.open(path)
        shares = np.flipud(np.asarray(picture, dtype=np.float64))
    except (OSError, UnidentifiedImageError, ValueError) as error:
        raise BadInput(f"{path}: not a picture that can be read ({error}); save it as PNG") from error
    if picture.mode not in WHITE:
        raise BadInput(f"{path}: a picture in colours ('{picture.mode}'); heights are grey, 8 or 16 bit: save it so")
    if not all(2 <= side <= FINEST for side in shares.shape):
        raise BadInput(f"{path}: {shares.shape[1]} x {shares.shape[0]} pixels; terrain has 2 to {FINEST} a side: scale it down")
    rows, columns = shares.shape
    (east, north, up), (x, y, z) = terrain.size, terrain.position
    return Relief(
        x + np.linspace(-east / 2, east / 2, columns),
        y + np.linspace(-north / 2, north / 2, rows),
        z + shares / WHITE[picture.mode] * up,
    )


def terrain_mesh(terrain: Terrain, folder: Path = Path()) -> Path:
    """Path of the terrain as an STL file in metres, world axes. Raises BadInput.

    folder: holds the picture of a world that was not loaded from a file.
    """
    return _written(folder / terrain.heights, terrain)


@lru_cache(maxsize=4)
def _written(path: Path, terrain: Terrain) -> Path:
    return mesh_file(path.stem, *_read(path, terrain).triangles())
