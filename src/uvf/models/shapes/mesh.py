"""Shapes as triangles and as points: for pictures and for measuring how far a body reaches."""

import logging
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

from uvf.maths.rotations import matrix
from uvf.maths.se3 import Transform, compose
from uvf.models.shapes.solid import Solid
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]
FORMATS = (".stl", ".obj")  # what every engine reads alike: no units, no axes of their own
ROUND = 48  # sides of a circle
logging.getLogger("trimesh").setLevel(logging.CRITICAL)  # it tells of every missing texture, with a trace


def placed(solid: Solid, frame_from_link: Transform) -> Solid:
    """The same shape in the frame in which the link's pose is given."""
    pose = compose(frame_from_link, Transform(solid.orientation, solid.position))
    return Solid(solid.name, solid.shape, solid.size, pose.translation, pose.rotation, solid.colour, solid.mesh)


def triangles(solid: Solid) -> tuple[Floats, NDArray[Any]]:
    """Vertices (n, 3) [m], in the frame of the solid's pose, and faces (m, 3). Raises BadInput for a mesh that cannot be read."""
    vertices, faces = _own_triangles(solid)
    return vertices @ matrix(solid.orientation).T + solid.position, faces


def reach(solid: Solid, directions: Floats) -> Floats:
    """How far (n,) [m] the shape goes in each unit direction (n, 3) from the origin of its frame; exact, of a mesh that of its hull."""
    local = directions @ matrix(solid.orientation)
    middle: Floats = directions @ solid.position
    if solid.shape == "sphere":
        return middle + solid.size[0]
    if solid.shape == "box":
        return middle + np.abs(local) @ (np.array(solid.size) / 2)
    if solid.shape == "cylinder":
        radius, length = solid.size
        return middle + radius * np.hypot(local[:, 0], local[:, 1]) + np.abs(local[:, 2]) * length / 2
    hull: Floats = middle + (local @ _own_triangles(solid)[0].T).max(axis=1)
    return hull


def _own_triangles(solid: Solid) -> tuple[Floats, NDArray[Any]]:
    if solid.shape == "mesh":
        vertices, faces = load_mesh(solid.mesh or Path("?"))
        return vertices * np.array(solid.size), faces
    if solid.shape == "box":
        made = trimesh.creation.box(solid.size)
    elif solid.shape == "cylinder":
        made = trimesh.creation.cylinder(solid.size[0], solid.size[1], sections=ROUND)
    else:
        made = trimesh.creation.uv_sphere(solid.size[0], count=(ROUND // 2, ROUND))
    return np.asarray(made.vertices), np.asarray(made.faces)


@lru_cache(maxsize=128)
def load_mesh(path: Path) -> tuple[Floats, NDArray[Any]]:
    """Vertices (n, 3), in the file's own units, and faces (m, 3) of a mesh file. Raises BadInput."""
    if path.suffix.lower() not in FORMATS:
        raise BadInput(f"{path}: meshes are {' or '.join(FORMATS)} here; 'uvf vehicle import' makes them of others")
    try:
        mesh = trimesh.load_scene(path).to_mesh()
        vertices, faces = np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces)
    except (OSError, ValueError, KeyError, IndexError, TypeError, AttributeError, AssertionError) as error:
        raise BadInput(f"{path}: not a mesh that can be read: {' '.join(str(error).split()) or type(error).__name__}") from error
    if not len(faces) or not np.isfinite(vertices).all():
        raise BadInput(f"{path}: the mesh has no triangles, or corners that are no numbers; export it again")
    return vertices, faces
