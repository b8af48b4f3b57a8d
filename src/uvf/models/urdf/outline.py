"""The outline of a model on the ground, from its collision shapes."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import HalfspaceIntersection

from uvf.models.shapes.mesh import placed, reach
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.model import load_urdf
from uvf.models.urdf.robot import UrdfModel

Floats = NDArray[np.float64]

SIDES = 16
"""Directions that the outline is seen from; a rectangle along the axes comes out as it is."""
LEAST = 0.01  # m from base_link to each side


def plan_outline(model: UrdfModel) -> Floats | None:
    """(n, 2) [m, base_link] convex outline that holds all collision shapes as seen from above, anticlockwise; None where there are none.

    base_link lies inside of it, at least a centimetre from each side. Raises BadInput for a mesh that cannot be read.
    """
    solids = _solids(model)
    if not solids:
        return None
    angles = np.arange(SIDES) * (2.0 * np.pi / SIDES)
    normals = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(SIDES)))
    distances = np.maximum(np.max([reach(solid, normals) for solid in solids], axis=0), LEAST)
    corners: Floats = HalfspaceIntersection(np.column_stack((normals[:, :2], -distances)), np.zeros(2)).intersections
    return corners[np.argsort(np.arctan2(corners[:, 1], corners[:, 0]))]


def ground_outline(urdf: Path, radius: float) -> Floats:
    """(n, 2) [m, base_link] convex outline of a vehicle, anticlockwise; where its URDF has no collision shapes, its circle.

    radius: of that [m]. Raises BadInput as ``plan_outline``, and for a URDF that cannot be read.
    """
    outline = plan_outline(load_urdf(urdf))
    if outline is not None:
        return outline
    angles = np.arange(SIDES) * (2.0 * np.pi / SIDES)
    circle: Floats = radius / np.cos(np.pi / SIDES) * np.column_stack((np.cos(angles), np.sin(angles)))
    return circle


def highest(model: UrdfModel) -> float:
    """Height [m] of the top of all collision shapes above base_link; 0 where there are none. Raises BadInput as ``plan_outline``."""
    up = np.array(((0.0, 0.0, 1.0),))
    return max((float(reach(solid, up)[0]) for solid in _solids(model)), default=0.0)


def _solids(model: UrdfModel) -> list[Solid]:
    poses = model.link_poses()
    return [placed(solid, poses[name]) for name, link in model.links.items() if name in poses for solid in link.collisions]
