"""How ground vehicles look: the meshes of their URDF, in the body frame (FLU), m."""

from pathlib import Path

import numpy as np

from uvf.models.shapes.mesh import placed, triangles
from uvf.models.shapes.mesh_parts import Colour, MeshPart, plate
from uvf.models.urdf.model import load_urdf


def rover(urdf: Path) -> list[MeshPart]:
    """The visual parts of the URDF, wheels at rest, with a forward arrow in the vehicle's own colour above. Raises BadInput."""
    model = load_urdf(urdf)
    poses = model.link_poses()
    shown = [placed(solid, poses[link.name]) for link in model.links.values() for solid in link.visuals or link.collisions]
    parts = [MeshPart(*triangles(solid), rgb(solid.colour)) for solid in shown]
    points = np.vstack([part.vertices for part in parts])
    (x, y, _), top = (points.max(axis=0) + points.min(axis=0)) / 2, float(points[:, 2].max())
    size = 0.25 * float(np.ptp(points[:, :2], axis=0).min())
    parts.append(plate([(x + size, y, top + 0.02), (x - size, y + size / 2, top + 0.02), (x - size, y - size / 2, top + 0.02)], 0.006))
    return parts


def rgb(colour: tuple[float, float, float]) -> Colour:
    """The colour as 0..255 from parts of 0..1 [-]."""
    r, g, b = (round(255 * c) for c in colour)
    return r, g, b
