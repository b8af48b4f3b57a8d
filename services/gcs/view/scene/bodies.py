"""How ground vehicles look: the meshes of their URDF, in the body frame (FLU), m."""

from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se3 import compose, inverse
from uvf.models.shapes.mesh import placed, triangles
from uvf.models.shapes.mesh_parts import Colour, MeshPart, plate
from uvf.models.shapes.textured import TexturedMesh, textured
from uvf.models.urdf.model import load_urdf
from uvf.models.urdf.robot import UrdfModel

Floats = NDArray[np.float64]


FAST = ""
"""Stands for the body among the names of links that move."""


def rover(urdf: Path) -> list[MeshPart]:
    """The visual parts of the URDF at rest, with a forward arrow in the vehicle's own colour above. Raises BadInput."""
    return [part for drawn in rover_parts(load_urdf(urdf), (), pictures=False).values() for part in drawn.plain]


@dataclass(frozen=True)
class DrawnParts:
    """What is drawn in one frame: parts of plain colours, and those under pictures."""

    plain: list[MeshPart] = field(default_factory=list)
    pictured: list[TexturedMesh] = field(default_factory=list)


def rover_parts(model: UrdfModel, moving: Collection[str], pictures: bool = True) -> dict[str, DrawnParts]:
    """The same by the links of these names that carry them, each in that link's frame, and under ``FAST`` what none of them carries.

    pictures: what has one is drawn with it, else in its plain colour.
    """
    poses, parents = model.link_poses(), model.parents
    found = {name: DrawnParts() for name in (FAST, *moving)}
    at_rest = []
    for link in model.links.values():
        carrier = link.name
        while carrier not in moving and carrier in parents:
            carrier = parents[carrier].parent
        carrier = carrier if carrier in moving else FAST
        there = poses[link.name] if carrier == FAST else compose(inverse(poses[carrier]), poses[link.name])
        for solid in link.visuals or link.collisions:
            here = placed(solid, there)
            if pictures and (mesh := textured(here)) is not None:
                found[carrier].pictured.append(mesh)
            else:
                found[carrier].plain.append(MeshPart(*triangles(here), rgb(solid.colour)))
            at_rest.append(triangles(placed(solid, poses[link.name]))[0])
    found[FAST].plain.append(_arrow(np.vstack(at_rest)))
    return found


def _arrow(points: Floats) -> MeshPart:
    """Above all points (n, 3) [m] of a vehicle."""
    (x, y, _), top = (points.max(axis=0) + points.min(axis=0)) / 2, float(points[:, 2].max())
    size = 0.25 * float(np.ptp(points[:, :2], axis=0).min())
    return plate([(x + size, y, top + 0.02), (x - size, y + size / 2, top + 0.02), (x - size, y - size / 2, top + 0.02)], 0.006)


def rgb(colour: tuple[float, float, float]) -> Colour:
    """The colour as 0..255 from parts of 0..1 [-]."""
    r, g, b = (round(255 * c) for c in colour)
    return r, g, b
