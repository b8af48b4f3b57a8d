"""Solids as the primitives that rays, footprints and drivable surfaces are computed from: the one place that turns one into the other."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from uvf.maths.bvh import build
from uvf.maths.raycast import Scene
from uvf.maths.solids import Solids, box, cylinder, joined, mesh, sphere
from uvf.models.shapes.mesh import load_mesh
from uvf.models.shapes.solid import Solid


def primitives(solid: Solid) -> Solids:
    """One solid as primitives; if it moves by script, at the script's beginning. Raises BadInput for a mesh that cannot be read."""
    if solid.shape == "box":
        return box(solid.size, solid.position, solid.orientation)
    if solid.shape == "cylinder":
        radius, height = solid.size
        return cylinder(radius, height, solid.position, solid.orientation)
    if solid.shape == "sphere":
        return sphere(solid.size[0], solid.position)
    vertices, faces = load_mesh(solid.mesh or Path("?"))
    return mesh(vertices * np.array(solid.size), faces, solid.position, solid.orientation)


def still(solids: Iterable[Solid]) -> Solids:
    """The primitives of all solids that never move, in one table."""
    return joined([primitives(solid) for solid in solids if solid.path is None])


def scene(solids: Iterable[Solid], ground: float | None = 0.0) -> Scene:
    """The scene of all solids that never move and of the ground plane z = ``ground`` [m]; None is no ground."""
    return Scene(build(still(solids)), ground)
