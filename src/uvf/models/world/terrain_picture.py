"""What of a terrain stands out of the ground, for pictures.

A renderer without a graphics card pays for each pixel that it shades. Where the terrain is the ground, z = 0, a patch of its colour on the
ground looks the same.
"""

from functools import lru_cache
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from uvf.models.generated_file import mesh_file
from uvf.models.world.file import Field, Terrain, WorldFile
from uvf.models.world.terrain import Relief, relief_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def with_ground_of(world: WorldFile) -> WorldFile:
    """The world with a patch of the terrain's colour on its ground, below all other patches."""
    if world.terrain is None:
        return world
    (east, north, _), (x, y, _) = world.terrain.size, world.terrain.position
    area = (x - east / 2, y - north / 2, x + east / 2, y + north / 2)
    return msgspec.structs.replace(world, fields=[*world.fields, Field(area=area, colour=world.terrain.colour)])


@lru_cache(maxsize=4)
def raised_mesh(terrain: Terrain) -> Path | None:
    """Path of what stands out of a loaded world's terrain as an STL file [m, world]; None where nothing does. Raises BadInput."""
    vertices, faces = raised_triangles(relief_of(terrain))
    return mesh_file(f"{Path(terrain.heights).stem}-raised", vertices, faces) if len(faces) else None


def raised_triangles(relief: Relief) -> tuple[Floats, Ints]:
    """Vertices (n, 3) [m, world] and faces (m, 3), anticlockwise from above: those of ``relief`` that are not wholly on z = 0."""
    vertices, faces = relief.triangles()
    return vertices, faces[(vertices[faces, 2] != 0.0).any(axis=1)]
