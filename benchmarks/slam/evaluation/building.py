"""Made-up buildings of corridors, doors and rooms."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]

WIDTH = 2.4  # m, of a corridor
DOOR, RECESS = 1.0, 0.25  # m, width and depth of a closed door's niche
ROOM = (4.0, 5.0)  # m, depth and width of a room behind an open door


def corridors(corners: Floats, rng: np.random.Generator) -> Floats:
    """(n, 4) walls x0 y0 x1 y1 [m] around a network of straight corridors along the axes.

    corners: (m, 4) centre lines of corridors. Doors stand at uneven places; one in four is open, with a room behind it.
    """
    walls = []
    for x0, y0, x1, y1 in corners.tolist():
        length = float(np.hypot(x1 - x0, y1 - y0))
        along, across = np.array((x1 - x0, y1 - y0)) / length, np.array((-(y1 - y0), x1 - x0)) / length
        for side in (-1.0, 1.0):
            walls += _side(np.array((x0, y0)), (along, side * across), length, rng)
    return _without_crossings(np.array(walls), corners)


def _side(start: Floats, axes: tuple[Floats, Floats], length: float, rng: np.random.Generator) -> list[list[float]]:
    """The wall of one side of a corridor, from half a width before its beginning to half a width behind its end."""
    along, across = axes
    outline = [(-WIDTH / 2, 0.0)]
    s = rng.uniform(1.5, 4.0)
    while s < length - 3.0:
        wide = rng.uniform(0.8, 1.2) * DOOR
        if rng.uniform() < 0.25:
            deep, broad = rng.uniform(0.7, 1.3) * ROOM[0], rng.uniform(0.5, 0.9) * ROOM[1]
            outline += [(s, 0.0), (s, 0.15), (s - broad / 3, 0.15), (s - broad / 3, deep), (s + wide + broad / 3, deep)]
            outline += [(s + wide + broad / 3, 0.15), (s + wide, 0.15), (s + wide, 0.0)]
        else:
            outline += [(s, 0.0), (s, RECESS), (s + wide, RECESS), (s + wide, 0.0)]
        s += wide + rng.uniform(2.0, 9.0)
    outline.append((length + WIDTH / 2, 0.0))
    points = [start + a * along + (WIDTH / 2 + b) * across for a, b in outline]
    return [[*p, *q] for p, q in pairwise(points)]


def _without_crossings(walls: Floats, corners: Floats) -> Floats:
    """Walls cut open where another corridor runs through them."""
    low = np.minimum(corners[:, :2], corners[:, 2:]) - WIDTH / 2 + 1e-6
    high = np.maximum(corners[:, :2], corners[:, 2:]) + WIDTH / 2 - 1e-6
    kept = []
    for wall in walls:
        p, way = wall[:2], wall[2:] - wall[:2]
        n = max(2, int(np.hypot(*way) / 0.05) + 1) - 1
        middle = p + (np.arange(n)[:, None] + 0.5) / n * way
        inside = ((middle[:, None] > low) & (middle[:, None] < high)).all(axis=2).any(axis=1)
        edges = np.flatnonzero(np.diff(np.concatenate(([True], inside, [True])).astype(np.int8)))
        kept += [np.concatenate((p + a / n * way, p + b / n * way)) for a, b in edges.reshape(-1, 2)]
    return np.array(kept)


@compiled
def cast(pose: Floats, directions: Floats, walls: Floats, farthest: float) -> Floats:
    """(n,) ranges [m] from a pose along directions (n, 2) of its frame; ``farthest`` where nothing is hit."""
    c, s = np.cos(pose[2]), np.sin(pose[2])
    ranges = np.full(directions.shape[0], farthest)
    for w in range(walls.shape[0]):
        ax, ay = walls[w, 0] - pose[0], walls[w, 1] - pose[1]
        ex, ey = walls[w, 2] - walls[w, 0], walls[w, 3] - walls[w, 1]
        if min(ax * ax + ay * ay, (ax + ex) ** 2 + (ay + ey) ** 2) > (farthest + 60.0) ** 2:
            continue
        for k in range(directions.shape[0]):
            dx, dy = c * directions[k, 0] - s * directions[k, 1], s * directions[k, 0] + c * directions[k, 1]
            cross = dx * ey - dy * ex
            if cross == 0.0:
                continue
            r, u = (ax * ey - ay * ex) / cross, (ax * dy - ay * dx) / cross
            if 0.0 < r < ranges[k] and 0.0 <= u <= 1.0:
                ranges[k] = r
    return ranges
