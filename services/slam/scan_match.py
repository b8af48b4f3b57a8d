"""Scan to map by point-to-line Gauss-Newton on the map's surface points.

Each point of the scan is drawn to a line fitted to the surface points of the cells around it (implicit moving least
squares, Deschaud 2018, "IMLS-SLAM"), of the faces seen from its own side only: the two faces of a thin wall stay apart.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.slam.occupancy import OccupancyMap
from uvf.maths.compiled import compiled
from uvf.maths.planar import Pose2
from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]

REACH = 3  # cells around a point that are looked at
KERNEL = 1.2  # cells, 1 sigma of the weight of a surface point by distance
SAME_SIDE = 0.2  # least cosine between the directions a surface was and is seen from
FLAT = 0.15  # largest ratio of the two variances of a line
ITERATIONS = 12
SCALE = 0.03  # m, distance at which a point loses most of its weight (Geman-McClure)
WIDE = 0.15  # m, the same in the first iteration, halved with each

RESIDUAL_SIGMA = 0.01  # m, of a point's distance to its line
POSITION_WEIGHT = (RESIDUAL_SIGMA / 0.02) ** 2
HEADING_WEIGHT = (RESIDUAL_SIGMA / 0.02) ** 2
"""Of the start, whose 1 sigma is 0.02 m and 0.02 rad: it decides where the scan tells nothing."""

Scan = tuple[Floats, tuple[float, float]]
"""points (n, 2) and the lidar's place (x, y) [m, base frame]."""
Map = tuple[NDArray[np.float32], NDArray[np.float32], float, float, float]
"""log-odds (r, c), surface (r, c, 5), origin x and y [m], resolution [m]."""


@compiled
def _line_at(place: tuple[float, float], view: tuple[float, float], map_: Map) -> tuple[float, float, float, bool]:
    """(normal x, normal y, distance along it [cells], found) of the surface near a place [cells] seen from ``view``."""
    x, y = place
    grid, surface, _, _, _ = map_
    column, row = int(np.floor(x)), int(np.floor(y))
    w = sx = sy = sxx = sxy = syy = 0.0
    used = 0
    for r in range(max(row - REACH, 0), min(row + REACH + 1, grid.shape[0])):
        for c in range(max(column - REACH, 0), min(column + REACH + 1, grid.shape[1])):
            n = surface[r, c, 0]
            if n < 1.0 or grid[r, c] <= 0.0:
                continue
            if surface[r, c, 3] * view[0] + surface[r, c, 4] * view[1] < SAME_SIDE * n:
                continue
            px, py = c + surface[r, c, 1] / n - x, r + surface[r, c, 2] / n - y
            weight = min(n, 10.0) * np.exp(-(px * px + py * py) / (2.0 * KERNEL * KERNEL))
            w += weight
            sx += weight * px
            sy += weight * py
            sxx += weight * px * px
            sxy += weight * px * py
            syy += weight * py * py
            used += 1
    if used < 3 or w < 1e-3:
        return 0.0, 0.0, 0.0, False
    mx, my = sx / w, sy / w
    vxx, vxy, vyy = sxx / w - mx * mx, sxy / w - mx * my, syy / w - my * my
    mean, spread = (vxx + vyy) / 2.0, np.sqrt(((vxx - vyy) / 2.0) ** 2 + vxy * vxy)
    if mean - spread > FLAT * (mean + spread):
        return 0.0, 0.0, 0.0, False
    along = 0.5 * np.arctan2(2.0 * vxy, vxx - vyy)
    nx, ny = -np.sin(along), np.cos(along)
    return nx, ny, -(nx * mx + ny * my), True


@compiled
def _normal_equations(pose: tuple[float, float, float], scan: Scan, map_: Map, scale: float) -> tuple[Floats, Floats, int, int, float]:
    """(H, g, matched, misplaced, sum of squares) of the weighted residuals at a pose; robust weight of Geman-McClure."""
    points, sensor = scan
    grid, _, ox, oy, resolution = map_
    h, g = np.zeros((3, 3)), np.zeros(3)
    matched = misplaced = 0
    squares = 0.0
    cos_t, sin_t = np.cos(pose[2]), np.sin(pose[2])
    sx = pose[0] + cos_t * sensor[0] - sin_t * sensor[1]
    sy = pose[1] + sin_t * sensor[0] + cos_t * sensor[1]
    jacobian = np.zeros(3)
    for i in range(points.shape[0]):
        ax, ay = cos_t * points[i, 0] - sin_t * points[i, 1], sin_t * points[i, 0] + cos_t * points[i, 1]
        x, y = pose[0] + ax, pose[1] + ay
        length = np.sqrt((sx - x) ** 2 + (sy - y) ** 2) + 1e-9
        view = ((sx - x) / length, (sy - y) / length)
        u, v = (x - ox) / resolution, (y - oy) / resolution
        nx, ny, distance, found = _line_at((u, v), view, map_)
        if not found:
            if 0 <= u < grid.shape[1] and 0 <= v < grid.shape[0] and grid[int(v), int(u)] < -0.5:
                misplaced += 1
            continue
        matched += 1
        residual = distance * resolution
        squares += residual * residual
        weight = 1.0 / (1.0 + (residual / scale) ** 2) ** 2
        jacobian[0], jacobian[1], jacobian[2] = nx, ny, -nx * ay + ny * ax
        for a in range(3):
            g[a] += weight * jacobian[a] * residual
            for b in range(3):
                h[a, b] += weight * jacobian[a] * jacobian[b]
    return h, g, matched, misplaced, squares


@compiled
def _refine(start: tuple[float, float, float], scan: Scan, map_: Map) -> tuple[float, float, float, int, int, float]:
    """(x, y, heading, matched, misplaced, sum of squares): Gauss-Newton from ``start``."""
    x, y, heading = start
    matched = misplaced = 0
    squares = 0.0
    for i in range(ITERATIONS):
        scale = max(SCALE, WIDE * 0.5**i)
        h, g, matched, misplaced, squares = _normal_equations((x, y, heading), scan, map_, scale)
        if matched < 3:
            break
        h[0, 0] += POSITION_WEIGHT
        h[1, 1] += POSITION_WEIGHT
        h[2, 2] += HEADING_WEIGHT
        g[0] += POSITION_WEIGHT * (x - start[0])
        g[1] += POSITION_WEIGHT * (y - start[1])
        g[2] += HEADING_WEIGHT * (heading - start[2])
        step = np.linalg.solve(h, -g)
        x, y, heading = x + step[0], y + step[1], heading + step[2]
        if abs(step[0]) + abs(step[1]) < 1e-4 and abs(step[2]) < 1e-4:
            break
    return x, y, heading, matched, misplaced, squares


@dataclass(frozen=True)
class Match:
    """A refined pose and how well the scan agrees with the map there."""

    map_from_base: Pose2
    matched: int
    """Points with a surface of their own side near them."""
    agreeing: float
    """Share of the points lying on the known part of the map that found their surface, 0..1."""
    rms: float
    """m, of the distances of matched points to their lines."""


def match(occupancy: OccupancyMap, start: Pose2, points: Floats, sensor: tuple[float, float]) -> Match:
    """Refines ``start`` (map_from_base). points: (n, 2) m, base frame; sensor: the lidar's place in it [m]."""
    map_ = (occupancy.log_odds, occupancy.surface, float(occupancy.origin[0]), float(occupancy.origin[1]), occupancy.resolution)
    x, y, heading, matched, misplaced, squares = _refine(start, (points, sensor), map_)
    rms = float(np.sqrt(squares / matched)) if matched else float("inf")
    return Match(Pose2(x, y, wrap(heading)), matched, matched / max(matched + misplaced, 1), rms)
