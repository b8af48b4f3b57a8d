"""Buildings cut open at a height, so that one looks into their rooms."""

from collections.abc import Iterable
from dataclasses import replace
from math import inf
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

from uvf.models.shapes.mesh import triangles
from uvf.models.shapes.solid import Solid
from uvf.models.shapes.textured import TexturedMesh
from uvf.models.world.file import WorldFile

Floats = NDArray[np.float64]
Faces = NDArray[Any]

CUT = 1.4  # m, where buildings are cut open
OVERHEAD = 1.8  # m, from which on what covers the floor is a roof
ROOFED = 0.25  # of the floor that a roof covers at least


def cut_height(world: WorldFile, solids: Iterable[Solid]) -> float:
    """Height [m] above which nothing is shown of a world with these solids; inf but under a roof on level ground."""
    return CUT if world.terrain is None and is_roofed(solids, world.floor) else inf


def is_roofed(solids: Iterable[Solid], floor: tuple[float, float, float, float]) -> bool:
    """Whether what stands still above people's heads hides much of the floor (x_min, y_min, x_max, y_max) [m] from above."""
    x_min, y_min, x_max, y_max = floor
    return sum(_roof(solid) for solid in solids if solid.path is None) >= ROOFED * (x_max - x_min) * (y_max - y_min)


def _roof(solid: Solid) -> float:
    """Area [m^2], seen from above, of what lies above ``OVERHEAD``; a sheet may look down."""
    vertices, faces = triangles(solid)
    corners = vertices[faces]
    high = corners[corners[:, :, 2].min(axis=1) > OVERHEAD]
    doubled = np.cross(high[:, 1] - high[:, 0], high[:, 2] - high[:, 0])[:, 2]
    return float(max(doubled[doubled > 0.0].sum(), -doubled[doubled < 0.0].sum())) / 2


def cut_open_textured(mesh: TexturedMesh, height: float) -> TexturedMesh:
    """The same of a mesh under a picture."""
    down, there = np.array((0.0, 0.0, -1.0)), np.array((0.0, 0.0, height))
    slicing: Any = trimesh.intersections.slice_faces_plane
    vertices, faces, uv = slicing(mesh.vertices, mesh.faces, down, there, uv=mesh.uv)
    return replace(mesh, vertices=np.asarray(vertices), faces=np.asarray(faces), uv=np.asarray(uv))


def cut_open(vertices: Floats, faces: Faces, height: float) -> tuple[Floats, Faces]:
    """The triangles below a ``height`` [m]: vertices (n, 3) [m] and faces (m, 3); those across it are cut there."""
    slicing: Any = trimesh.intersections.slice_faces_plane
    below = slicing(vertices, faces, np.array((0.0, 0.0, -1.0)), np.array((0.0, 0.0, height)))
    return np.asarray(below[0], dtype=np.float64), np.asarray(below[1])
