"""Simple bodies as meshes of triangles, all wound outwards: what vehicles are drawn from."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Colour = tuple[int, int, int]
Point = tuple[float, float, float]
Place = Sequence[float] | Floats
"""(3,) m."""


@dataclass(frozen=True)
class MeshPart:
    """A mesh: vertices (n, 3) [m, body frame FLU], faces (m, 3), counter-clockwise from outside.

    colour: None is the vehicle's own.
    """

    vertices: Floats
    faces: NDArray[Any]
    colour: Colour | None = None


def box(centre: Place, size: Sequence[float], colour: Colour | None = None) -> MeshPart:
    """An axis-aligned box of full edges ``size`` (3,) [m] about ``centre`` (3,) [m]."""
    corners = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    sides = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    faces = [face for a, b, c, d in sides for face in ((a, b, c), (a, c, d))]
    return _outward(corners * np.asarray(size) + np.asarray(centre), faces, colour)


def lathe(axis: int, stations: Sequence[tuple[float, float]], centre: Place, colour: Colour | None = None) -> MeshPart:
    """A solid of revolution about x, y or z (axis 0, 1, 2) through ``centre`` (3,) [m].

    stations: (place on the axis, radius) [m] in rising order.
    """
    n, a = 24, np.linspace(0, 2 * np.pi, 24, endpoint=False)
    rings = []
    for along, radius in stations:
        ring = np.zeros((n, 3))
        ring[:, axis] = along
        ring[:, (axis + 1) % 3], ring[:, (axis + 2) % 3] = radius * np.cos(a), radius * np.sin(a)
        rings.append(ring)
    return _tube(rings, np.asarray(centre), colour)


def rod(start: Place, end: Place, radius: float, colour: Colour | None = None) -> MeshPart:
    """A straight rod of six sides and ``radius`` [m] from ``start`` (3,) to ``end`` (3,) [m]."""
    a, b = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    along = (b - a) / max(float(np.linalg.norm(b - a)), 1e-9)
    across = np.cross(along, (0.0, 0.0, 1.0) if abs(along[2]) < 0.9 else (1.0, 0.0, 0.0))
    across /= np.linalg.norm(across)
    turn = np.linspace(0, 2 * np.pi, 6, endpoint=False)[:, None]
    ring = radius * (np.cos(turn) * across + np.sin(turn) * np.cross(along, across))
    return _tube([a + ring, b + ring], np.zeros(3), colour)


def plate(outline: Sequence[Point], thickness: float, colour: Colour | None = None) -> MeshPart:
    """A flat convex slab of ``thickness`` [m], half of it to each side of its outline of points (3,) [m]."""
    points = np.array(outline)
    normal = np.cross(points[1] - points[0], points[-1] - points[0])
    across = normal / max(float(np.linalg.norm(normal)), 1e-12) * thickness / 2
    n = len(points)
    sides = [f for i in range(n) for f in ((i, n + (i + 1) % n, (i + 1) % n), (i, n + i, n + (i + 1) % n))]
    caps = [f for i in range(1, n - 1) for f in ((0, i, i + 1), (n, n + i + 1, n + i))]
    return _outward(np.vstack((points + across, points - across)), sides + caps, colour)


def _tube(rings: Sequence[Floats], centre: Floats, colour: Colour | None) -> MeshPart:
    """Closed at both ends."""
    n, last = len(rings[0]), len(rings) * len(rings[0])
    vertices = np.vstack((*rings, rings[0].mean(axis=0), rings[-1].mean(axis=0))) + centre
    faces = []
    for i in range(n):
        j = (i + 1) % n
        for k in range(len(rings) - 1):
            p, q = k * n, (k + 1) * n
            faces += [(p + i, p + j, q + j), (p + i, q + j, q + i)]
        faces += [(last, j, i), (last + 1, last - n + i, last - n + j)]
    return _outward(vertices, faces, colour)


def _outward(vertices: Floats, faces: Sequence[tuple[int, int, int]], colour: Colour | None) -> MeshPart:
    """Turns all faces over where the volume that they enclose is negative."""
    wound = np.array(faces)
    a, b, c = (vertices[wound[:, k]] for k in range(3))
    return MeshPart(vertices, wound if (np.cross(a, b) * c).sum() >= 0 else wound[:, ::-1].copy(), colour)


def joined(parts: Sequence[MeshPart]) -> tuple[Floats, NDArray[Any]]:
    """All parts as one mesh: vertices (n, 3) [m] and faces (m, 3)."""
    offsets = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    return np.vstack([p.vertices for p in parts]), np.vstack([p.faces + o for p, o in zip(parts, offsets, strict=True)])
