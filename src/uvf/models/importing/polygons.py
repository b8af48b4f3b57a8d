"""Outlines pulled up into solids."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def extruded(outline: Floats, height: float) -> tuple[Floats, Ints]:
    """Vertices (2n, 3) [m] and faces (m, 3) of the prism over a simple outline (n, 2) [m] up to z = ``height`` [m]. Raises ValueError."""
    if len(outline) > 1 and np.allclose(outline[0], outline[-1]):
        outline = outline[:-1]
    if len(outline) < 3:
        raise ValueError("an outline has three corners or more")
    if _area(outline) < 0:
        outline = outline[::-1]
    n = len(outline)
    cap = triangulated(outline)
    following = np.roll(np.arange(n), -1)
    here = np.arange(n)
    sides = np.concatenate((np.stack((here, following, following + n), 1), np.stack((here, following + n, here + n), 1)))
    vertices = np.concatenate([np.column_stack((outline, np.full(n, z))) for z in (0.0, height)])
    return vertices, np.concatenate((cap[:, ::-1], cap + n, sides))


def triangulated(outline: Floats) -> Ints:
    """Corners (n - 2, 3) of triangles that fill a simple outline (n, 2), anticlockwise, by cutting off ears (Meisters 1975)."""
    left, made = list(range(len(outline))), []
    while len(left) > 3:
        ear = next((k for k in range(len(left)) if _is_ear(outline, left, k)), None)
        if ear is None:
            raise ValueError("the outline crosses itself")
        made.append((left[ear - 1], left[ear], left[(ear + 1) % len(left)]))
        left.pop(ear)
    return np.array([*made, tuple(left)], dtype=np.int64)


def _is_ear(outline: Floats, left: list[int], k: int) -> bool:
    corners = (left[k - 1], left[k], left[(k + 1) % len(left)])
    a, b, c = (outline[i] for i in corners)
    if _turn(a, b, c) < 0:
        return False
    others = [outline[i] for i in left if i not in corners]
    return not any(_turn(a, b, p) > 0 and _turn(b, c, p) > 0 and _turn(c, a, p) > 0 for p in others)


def _turn(a: Floats, b: Floats, c: Floats) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _area(outline: Floats) -> float:
    x, y = outline.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2
