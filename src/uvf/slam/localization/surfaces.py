"""Surfaces of a known map as points with normals: of the keyframes of a session, or of the walls of an occupancy grid."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.se2 import transform
from uvf.models.world.map_file import GridMap
from uvf.slam.maps.placing import values_at
from uvf.slam.matching.cloud import Cloud, cloud_of, joined
from uvf.slam.method import Keyframe

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

OCCUPIED, FREE = 50, 30  # per cent, from which on and up to which a cell counts as such
VOXEL, SIDES = 0.06, 8
"""m and number of directions of the normal: points that share both become one."""
FULL = 4.0  # points of a voxel that give it its full weight
LINE = 3  # cells to each side of a wall's cell to which its line is fitted
ACROSS = 0.35  # ratio of variances across and along up to which cells are a line
PROBES = (1.6, 2.4)
"""Cells off a wall at which floor has to be for the wall to be seen from there."""


def of_keyframes(keyframes: Iterable[Keyframe], grid: GridMap) -> Cloud:
    """Surfaces that keyframes have hit and that ``grid``, the map drawn of them, still has as occupied; map frame."""
    whole = joined([cloud_of(k.reading).moved(k.map_from_base) for k in keyframes])
    stands = whole.flat & _near_occupied(grid, whole.points)
    return _thinned(whole.chosen(stands))


def _near_occupied(grid: GridMap, points: Floats) -> Mask:
    """(n,) whether an occupied cell is within a cell of each point."""
    near = np.zeros(len(points), dtype=np.bool_)
    for dx in (-grid.resolution, 0.0, grid.resolution):
        for dy in (-grid.resolution, 0.0, grid.resolution):
            near |= values_at(grid, points + np.array((dx, dy))) > OCCUPIED
    return near


def _thinned(cloud: Cloud) -> Cloud:
    """One point for each voxel and direction of normals: the weighted mean."""
    side = np.floor((np.arctan2(cloud.normals[:, 1], cloud.normals[:, 0]) / (2 * np.pi) + 0.5) * SIDES).astype(np.int64) % SIDES
    keys = np.column_stack((np.floor(cloud.points / VOXEL).astype(np.int64), side))
    _, voxel = np.unique(keys, axis=0, return_inverse=True)
    total = np.bincount(voxel.ravel(), cloud.weights)
    means = [np.bincount(voxel.ravel(), cloud.weights * column) / total for column in (*cloud.points.T, *cloud.normals.T)]
    normals = np.column_stack(means[2:])
    length = np.hypot(*normals.T)
    kept = length > 0.5
    return Cloud(np.column_stack(means[:2])[kept], normals[kept] / length[kept, None], np.minimum(total[kept] / FULL, 1.0))


def of_grid(grid: GridMap) -> Cloud:
    """Surfaces of the walls that border on free floor, one point for each cell and side that can be seen; frame of the grid's origin."""
    occupied, free = grid.cells > OCCUPIED, (grid.cells >= 0) & (grid.cells <= FREE)
    points, normals = _faces(occupied, free)
    placed = transform(grid.origin, points * grid.resolution)
    turned = transform(grid.origin._replace(x=0.0, y=0.0), normals)
    return Cloud(placed, turned, np.ones(len(placed)))


@compiled
def _towards_floor(free: Mask, r: int, c: int) -> tuple[float, float]:
    """Sum of the directions to the free cells around a cell; (0, 0) where there are none, or on all sides."""
    x = y = 0.0
    for i in range(max(0, r - 2), min(free.shape[0], r + 3)):
        for j in range(max(0, c - 2), min(free.shape[1], c + 3)):
            if free[i, j]:
                x += j - c
                y += i - r
    return x, y


@compiled
def _line(front: Mask, floor: Floats, r: int, c: int) -> tuple[float, float, float, float]:
    """(normal x, normal y, mean x, mean y) of the cells of the same face around one, in cells from it; a normal of 0: no line."""
    n = sx = sy = sxx = sxy = syy = 0.0
    for i in range(max(0, r - LINE), min(front.shape[0], r + LINE + 1)):
        for j in range(max(0, c - LINE), min(front.shape[1], c + LINE + 1)):
            if front[i, j] and floor[r, c, 0] * floor[i, j, 0] + floor[r, c, 1] * floor[i, j, 1] >= 0.0:
                x, y = float(j - c), float(i - r)
                n += 1.0
                sx += x
                sy += y
                sxx += x * x
                sxy += x * y
                syy += y * y
    if n < 3.0:
        return 0.0, 0.0, 0.0, 0.0
    mx, my = sx / n, sy / n
    vxx, vxy, vyy = sxx / n - mx * mx, sxy / n - mx * my, syy / n - my * my
    mean, half = (vxx + vyy) / 2.0, np.sqrt(((vxx - vyy) / 2.0) ** 2 + vxy * vxy)
    if mean - half > ACROSS * (mean + half):
        return 0.0, 0.0, 0.0, 0.0
    along = 0.5 * np.arctan2(2.0 * vxy, vxx - vyy)
    return -np.sin(along), np.cos(along), mx, my


@compiled
def _is_floor(free: Mask, x: float, y: float) -> bool:
    r, c = int(np.floor(y)), int(np.floor(x))
    return 0 <= r < free.shape[0] and 0 <= c < free.shape[1] and bool(free[r, c])


@compiled
def _faces(occupied: Mask, free: Mask) -> tuple[Floats, Floats]:
    """Points and normals (n, 2) in cells from the grid's corner."""
    rows, columns = occupied.shape
    front = np.zeros((rows, columns), dtype=np.bool_)
    floor = np.zeros((rows, columns, 2))
    count = 0
    for r in range(rows):
        for c in range(columns):
            if not occupied[r, c]:
                continue
            for i in range(max(0, r - 1), min(rows, r + 2)):
                for j in range(max(0, c - 1), min(columns, c + 2)):
                    front[r, c] |= free[i, j]
            if front[r, c]:
                count += 1
                floor[r, c, 0], floor[r, c, 1] = _towards_floor(free, r, c)
    points, normals = np.empty((2 * count, 2)), np.empty((2 * count, 2))
    n = 0
    for r in range(rows):
        for c in range(columns):
            if not front[r, c]:
                continue
            nx, ny, mx, my = _line(front, floor, r, c)
            if nx == 0.0 and ny == 0.0:
                continue
            off = nx * mx + ny * my
            x, y = c + 0.5 + off * nx, r + 0.5 + off * ny
            for side in (-1.0, 1.0):
                near = _is_floor(free, x + side * PROBES[0] * nx, y + side * PROBES[0] * ny)
                if near or _is_floor(free, x + side * PROBES[1] * nx, y + side * PROBES[1] * ny):
                    points[n, 0], points[n, 1], normals[n, 0], normals[n, 1] = x, y, side * nx, side * ny
                    n += 1
    return points[:n], normals[:n]
