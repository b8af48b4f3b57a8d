"""The outline of a model on the ground, from its collision shapes."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import HalfspaceIntersection

from uvf.models.shapes.mesh import placed, reach
from uvf.models.urdf.robot import UrdfModel

Floats = NDArray[np.float64]

SIDES = 16
"""Directions that the outline is seen from; a rectangle along the axes comes out as it is."""
LEAST = 0.01  # m from base_link to each side


def plan_outline(model: UrdfModel) -> Floats | None:
    """(n, 2) [m, base_link] convex outline that holds all collision shapes as seen from above; None where there are none.

    base_link lies inside of it, at least a centimetre from each side. Raises BadInput for a mesh that cannot be read.
    """
    poses = model.link_poses()
    solids = [placed(solid, poses[name]) for name, link in model.links.items() if name in poses for solid in link.collisions]
    if not solids:
        return None
    angles = np.arange(SIDES) * (2.0 * np.pi / SIDES)
    normals = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(SIDES)))
    distances = np.maximum(np.max([reach(solid, normals) for solid in solids], axis=0), LEAST)
    corners: Floats = HalfspaceIntersection(np.column_stack((normals[:, :2], -distances)), np.zeros(2)).intersections
    return corners
