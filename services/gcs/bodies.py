"""How vehicles look: plain meshes of triangles by kind, in the body frame (FLU), m."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvf.runtime.solid import Solid
from uvf.runtime.solid_mesh import placed, triangles
from uvf.runtime.urdf_model import load_urdf

Floats = NDArray[np.float64]
Colour = tuple[int, int, int]

PLATE, GLASS = (58, 64, 76), (40, 60, 90)


@dataclass(frozen=True)
class Part:
    """vertices: (n, 3) m, body frame; faces: (m, 3); colour None = the vehicle's own."""

    vertices: Floats
    faces: NDArray[Any]
    colour: Colour | None = None


def box(centre: Sequence[float], size: Sequence[float], colour: Colour | None = None) -> Part:
    corners = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    faces = [
        (0, 1, 3),
        (0, 3, 2),
        (4, 6, 7),
        (4, 7, 5),
        (0, 4, 5),
        (0, 5, 1),
        (2, 3, 7),
        (2, 7, 6),
        (0, 2, 6),
        (0, 6, 4),
        (1, 5, 7),
        (1, 7, 3),
    ]
    return Part(corners * np.asarray(size) + np.asarray(centre), np.array(faces), colour)


def lathe(axis: int, stations: Sequence[tuple[float, float]], centre: Sequence[float], colour: Colour | None = None) -> Part:
    """A solid of revolution about x, y or z (axis 0, 1, 2). stations: (place on the axis, radius) in rising order [m]."""
    n, a = 24, np.linspace(0, 2 * np.pi, 24, endpoint=False)
    rings = []
    for along, radius in stations:
        ring = np.zeros((n, 3))
        ring[:, axis] = along
        ring[:, (axis + 1) % 3], ring[:, (axis + 2) % 3] = radius * np.cos(a), radius * np.sin(a)
        rings.append(ring)
    middle = np.zeros((2, 3))
    middle[:, axis] = stations[0][0], stations[-1][0]
    vertices = np.vstack((*rings, middle)) + np.asarray(centre)
    faces, last = [], len(stations) * n
    for i in range(n):
        j = (i + 1) % n
        for k in range(len(stations) - 1):
            p, q = k * n, (k + 1) * n
            faces += [(p + i, p + j, q + j), (p + i, q + j, q + i)]
        faces += [(last, j, i), (last + 1, last - n + i, last - n + j)]
    return Part(vertices, np.array(faces), colour)


def plate(outline: Sequence[tuple[float, float, float]], thickness: float, colour: Colour | None = None, upright: bool = False) -> Part:
    """A flat convex slab about its outline: thick along z, or along y when upright [m]."""
    across = np.array((0.0, thickness / 2, 0.0) if upright else (0.0, 0.0, thickness / 2))
    points = np.array(outline)
    n = len(points)
    sides = [f for i in range(n) for f in ((i, (i + 1) % n, n + (i + 1) % n), (i, n + (i + 1) % n, n + i))]
    caps = [f for i in range(1, n - 1) for f in ((0, i, i + 1), (n, n + i + 1, n + i))]
    return Part(np.vstack((points + across, points - across)), np.array(sides + caps), colour)


def rover(urdf: Path) -> list[Part]:
    """What the URDF shows, wheels at rest, and above it a small arrow forward in the vehicle's own colour. Raises BadInput."""
    model = load_urdf(urdf)
    poses = model.link_poses()
    shown = [placed(solid, poses[link.name]) for link in model.links.values() for solid in link.visuals or link.collisions]
    parts = [Part(*triangles(solid), _rgb(solid)) for solid in shown]
    points = np.vstack([part.vertices for part in parts])
    (x, y, _), top = (points.max(axis=0) + points.min(axis=0)) / 2, float(points[:, 2].max())
    size = 0.25 * float(np.ptp(points[:, :2], axis=0).min())
    parts.append(plate([(x + size, y, top + 0.02), (x - size, y + size / 2, top + 0.02), (x - size, y - size / 2, top + 0.02)], 0.006))
    return parts


def _rgb(solid: Solid) -> Colour:
    r, g, b = (round(255 * c) for c in solid.colour)
    return r, g, b


def aeroplane(scale: float) -> list[Part]:
    """A high-wing pusher with twin booms and an inverted V tail, 2.9 m span times ``scale``."""
    wing = [(0.12, 0.0, 0.12), (0.1, 1.45, 0.16), (-0.08, 1.45, 0.16), (-0.17, 0.0, 0.12), (-0.08, -1.45, 0.16), (0.1, -1.45, 0.16)]
    parts = [
        lathe(0, [(-0.45, 0.05), (-0.3, 0.11), (0.35, 0.11), (0.6, 0.085), (0.75, 0.03)], (0, 0, 0.02)),
        lathe(0, [(0.3, 0.02), (0.42, 0.06), (0.55, 0.03)], (0.02, 0, 0.09), GLASS),
        plate([wing[0], wing[1], wing[2], wing[3]], 0.03),
        plate([wing[0], wing[3], wing[4], wing[5]], 0.03),
        lathe(0, [(-0.48, 0.2), (-0.47, 0.2)], (0, 0, 0.02), (150, 155, 165)),
    ]
    for side in (-1.0, 1.0):
        parts.append(lathe(0, [(-1.15, 0.018), (-0.05, 0.018)], (0, side * 0.4, 0.12), PLATE))
        tail = [(-0.92, side * 0.4, 0.12), (-0.98, 0.0, 0.45), (-1.16, 0.0, 0.45), (-1.17, side * 0.4, 0.12)]
        parts.append(plate(tail, 0.02))
    return [Part(part.vertices * scale, part.faces, part.colour) for part in parts]
