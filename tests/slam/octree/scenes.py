"""A box room, what is seen from inside of it, and random scans."""

import numpy as np

from uvf.maths.rotations import from_euler, matrix

LOW, HIGH = np.array((-3.02, -2.03, -0.01)), np.array((3.03, 2.04, 2.51))
"""m, the room's walls, floor and ceiling: inside of cells of 0.1 and 0.05 m, not on their borders."""


def distances(origin, directions):
    """(n,) m to the room's sides along unit directions (n, 3)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ahead = np.where(directions > 0, (HIGH - origin) / directions, (LOW - origin) / directions)
    return np.where(directions == 0, np.inf, ahead).min(axis=1)


def unit_rays(rng, n):
    rays = rng.normal(size=(n, 3))
    return rays / np.linalg.norm(rays, axis=1)[:, None]


def room_scan(rng, n=4000):
    """(origin, points): beams to all sides from somewhere in the room."""
    origin, rays = rng.uniform(0.7 * LOW, 0.7 * HIGH), unit_rays(rng, n)
    return origin, origin + rays * distances(origin, rays)[:, None]


def picture_scan(rng, width=64, height=48):
    """(origin, points) of a depth camera that looks somewhere."""
    rows, columns = np.mgrid[:height, :width]
    rays = np.stack((np.ones(rows.shape), (width / 2 - columns) / width, (height / 2 - rows) / width), axis=2).reshape(-1, 3)
    rays = rays @ matrix(from_euler(*rng.uniform((-0.2, -0.5, -np.pi), (0.2, 0.5, np.pi)))).T
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    origin = rng.uniform(0.7 * LOW, 0.7 * HIGH)
    return origin, origin + rays * distances(origin, rays)[:, None]


def wall_distance(points):
    """(n,) m from points to the nearest side of the room."""
    outside = np.linalg.norm(np.maximum(np.maximum(LOW - points, points - HIGH), 0.0), axis=1)
    inside = np.minimum(points - LOW, HIGH - points).min(axis=1)
    return np.where(inside >= 0, inside, outside)
