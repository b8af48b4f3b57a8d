"""Rays in the plane against rectangles and circles, written apart from ``maths.raycast3``: its check, and a flat room for tests."""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]


def rectangles(rows: Floats) -> Floats:
    """(n, 5) x, y, half length, half width [m], yaw [rad] as the (n, 6) table of ``cast``: cosine and sine for yaw."""
    rows = np.asarray(rows, dtype=np.float64).reshape(-1, 5)
    return np.column_stack((rows[:, :4], np.cos(rows[:, 4]), np.sin(rows[:, 4])))


@compiled
def _rectangle_range(origin: Floats, dx: float, dy: float, r: Floats) -> float:
    """Distance along the ray to the first crossing of the outline; slab method (Kay & Kajiya 1986)."""
    c, s = r[4], r[5]
    px, py = origin[0] - r[0], origin[1] - r[1]
    near, far = -np.inf, np.inf
    for p, d, half in ((c * px + s * py, c * dx + s * dy, r[2]), (c * py - s * px, c * dy - s * dx, r[3])):
        if abs(d) < 1e-12:
            if abs(p) > half:
                return np.inf
            continue
        a, b = (-half - p) / d, (half - p) / d
        near = max(near, min(a, b))
        far = min(far, max(a, b))
    if near > far or far < 0.0:
        return np.inf
    return near if near >= 0.0 else far


@compiled
def _circle_range(origin: Floats, dx: float, dy: float, circle: Floats) -> float:
    """Smallest root >= 0 of |o + t d - c|^2 = r^2 for a unit direction."""
    px, py = origin[0] - circle[0], origin[1] - circle[1]
    b: float = px * dx + py * dy
    discriminant = b * b - (px * px + py * py - circle[2] * circle[2])
    if discriminant < 0.0:
        return np.inf
    root = sqrt(discriminant)
    if -b - root >= 0.0:
        return -b - root
    return -b + root if -b + root >= 0.0 else np.inf


@compiled
def _cast(origin: Floats, angles: Floats, boxes: Floats, circles: Floats) -> Floats:
    ranges = np.empty(angles.shape[0])
    for i in range(angles.shape[0]):
        dx, dy = np.cos(angles[i]), np.sin(angles[i])
        best = np.inf
        for j in range(boxes.shape[0]):
            best = min(best, _rectangle_range(origin, dx, dy, boxes[j]))
        for j in range(circles.shape[0]):
            best = min(best, _circle_range(origin, dx, dy, circles[j]))
        ranges[i] = best
    return ranges


def cast(origin: Floats, angles: Floats, boxes: Floats, circles: Floats) -> Floats:
    """(n,) distances [m] from ``origin`` to the first outline met, inf where there is none.

    origin: (2,) m; angles: (n,) rad from the x axis; boxes: (k, 6) of ``rectangles``; circles: (m, 3) x, y, radius [m].
    """
    return _cast(origin, angles, boxes, circles)
