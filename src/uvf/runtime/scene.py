"""Solids as the primitives that rays, footprints and drivable surfaces are computed from: the one place that turns one into the other."""

from collections.abc import Iterable

import numpy as np
import trimesh
from numpy.typing import NDArray

from uvf.maths.bvh import build
from uvf.maths.raycast3 import Scene
from uvf.maths.solids import Solids, box, cylinder, joined, mesh, sphere
from uvf.runtime.params import BadInput
from uvf.runtime.solid import Solid

Floats = NDArray[np.float64]
Triangles = tuple[Floats, NDArray[np.int64]]
"""Vertices (k, 3) [m] and faces (n, 3)."""


def primitives(solid: Solid) -> Solids:
    """One solid where it stands; what moves by script at its script's beginning. Raises BadInput for a mesh that cannot be read."""
    if solid.shape == "box":
        return box(solid.size, solid.position, solid.orientation)
    if solid.shape == "cylinder":
        radius, height = solid.size
        return cylinder(radius, height, solid.position, solid.orientation)
    if solid.shape == "sphere":
        return sphere(solid.size[0], solid.position)
    vertices, faces = triangles(solid)
    return mesh(vertices, faces, solid.position, solid.orientation)


def triangles(solid: Solid) -> Triangles:
    """A mesh's vertices (k, 3) [m] in its own frame, scaled, and faces (n, 3). Raises BadInput."""
    try:
        loaded = trimesh.load_mesh(solid.mesh)
    except (OSError, ValueError, TypeError, KeyError, AttributeError, IndexError) as error:
        raise BadInput(f"{solid.mesh}: cannot be read as a mesh: {' '.join(str(error).split())}; export it anew as STL") from error
    if len(loaded.faces) == 0:
        raise BadInput(f"{solid.mesh}: no triangles in it; export it anew as STL")
    return np.asarray(loaded.vertices) * np.array(solid.size), np.asarray(loaded.faces)


def still(solids: Iterable[Solid]) -> Solids:
    """All that never moves, in one table."""
    return joined([primitives(solid) for solid in solids if solid.path is None])


def scene(solids: Iterable[Solid], ground: float | None = 0.0) -> Scene:
    """What rays meet of the solids that never move, and of the ground."""
    return Scene(build(still(solids)), ground)
