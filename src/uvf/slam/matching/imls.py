"""Sweep to point map by point-to-line Gauss-Newton on an implicit surface.

Each point of the sweep is drawn to the mean of the map's points around its nearest one, across their mean normal: implicit
moving least squares after Deschaud, "IMLS-SLAM" (2018). Only surfaces that are seen from the same side count: the two faces
of a thin wall stay apart.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.maths.vec3 import solve
from uvf.slam.matching.cloud import Cloud
from uvf.slam.matching.point_map import CELL, PointMap, Table

Floats = NDArray[np.float64]

SMOOTHING = 0.05  # m, 1 sigma of a map point's weight by its distance
SAME_SIDE = 0.6  # least cosine between the normals of a point and of the map
KERNEL = 0.05  # m, distance at which a point loses most of its weight (Geman-McClure)
SIGMA = 0.03
"""m, of a point's distance to its surface, as correlated as neighbouring points are."""
TILT = 0.2
"""rad, 1 sigma of a normal, and of what it is not: a surface that is not even."""

ROUNDS, STEPS = 7, 3
"""Associations at most, and Gauss-Newton steps on each."""
STILL, STILL_TURN = 5e-4, 1e-4  # m, rad: a round that moves less is the last one
CAP = 0.1  # m, a residual counts no more than that in the root mean square


@dataclass(frozen=True)
class Match:
    """A match: map_from_base; information (3, 3) of (x, y, yaw) [1/m^2, 1/rad^2], of the sweep alone.

    share: of the points that found a surface, 0..1; rms: of their distances to it [m].
    """

    map_from_base: Pose2
    information: Floats
    share: float
    rms: float


@compiled
def _surface(x: float, y: float, normal: tuple[float, float], table: Table, reach: float) -> tuple[float, float, float]:
    """(normal x, normal y, distance along it to the surface from (x, y)); a normal of 0 where there is none within ``reach``."""
    points, normals, weights, first, left, low, columns, rows = table
    column, row = int(np.floor((x - left) / CELL)), int(np.floor((y - low) / CELL))
    any_side = normal[0] == 0.0 and normal[1] == 0.0
    nearest = reach * reach
    found = False
    for c in range(max(0, column - 1), min(columns, column + 2)):
        for k in range(
            first[c * rows + max(0, row - 1)] if row - 1 < rows and row + 1 >= 0 else 0,
            first[c * rows + min(rows, row + 2)] if row - 1 < rows and row + 1 >= 0 else 0,
        ):
            dx, dy = x - points[k, 0], y - points[k, 1]
            d = dx * dx + dy * dy
            if d < nearest and (any_side or normals[k, 0] * normal[0] + normals[k, 1] * normal[1] > SAME_SIDE):
                nearest = d
                found = True
    if not found:
        return 0.0, 0.0, 0.0
    h = max(SMOOTHING, 0.5 * np.sqrt(nearest))
    twice, limit = 2.0 * h * h, nearest + 9.0 * h * h
    w = e = nx = ny = 0.0
    for c in range(max(0, column - 1), min(columns, column + 2)):
        for k in range(first[c * rows + max(0, row - 1)], first[c * rows + min(rows, row + 2)]):
            dx, dy = x - points[k, 0], y - points[k, 1]
            d = dx * dx + dy * dy
            if d < limit and (any_side or normals[k, 0] * normal[0] + normals[k, 1] * normal[1] > SAME_SIDE):
                weight = weights[k] * np.exp((nearest - d) / twice)
                w += weight
                e += weight * (dx * normals[k, 0] + dy * normals[k, 1])
                nx += weight * normals[k, 0]
                ny += weight * normals[k, 1]
    length = np.sqrt(nx * nx + ny * ny)
    if length < 0.5 * w:
        return 0.0, 0.0, 0.0
    return nx / length, ny / length, e / w


@compiled
def _associate(pose: Floats, cloud: tuple[Floats, Floats, Floats], table: Table, reach: float) -> Floats:
    """(n, 4) for each point: normal of its surface and its offset along it in the map frame, weight (0: no surface)."""
    points, normals, weights = cloud
    lines = np.zeros((points.shape[0], 4))
    c, s = np.cos(pose[2]), np.sin(pose[2])
    for i in range(points.shape[0]):
        x, y = c * points[i, 0] - s * points[i, 1] + pose[0], s * points[i, 0] + c * points[i, 1] + pose[1]
        mx, my = c * normals[i, 0] - s * normals[i, 1], s * normals[i, 0] + c * normals[i, 1]
        nx, ny, e = _surface(x, y, (mx, my), table, reach)
        if nx != 0.0 or ny != 0.0:
            lines[i, 0], lines[i, 1], lines[i, 2] = nx, ny, nx * x + ny * y - e
            lines[i, 3] = weights[i]
    return lines


@compiled
def _normal_equations(pose: Floats, points: Floats, lines: Floats, sharp: bool) -> tuple[Floats, Floats, int, float]:
    """(H, g, surfaces found, sum of squares) of the weighted distances to the lines; sharp: outliers lose their weight faster."""
    h, g = np.zeros((3, 3)), np.zeros(3)
    j = np.zeros(3)
    found, squares = 0, 0.0
    c, s = np.cos(pose[2]), np.sin(pose[2])
    for i in range(points.shape[0]):
        if lines[i, 3] == 0.0:
            continue
        ax, ay = c * points[i, 0] - s * points[i, 1], s * points[i, 0] + c * points[i, 1]
        nx, ny = lines[i, 0], lines[i, 1]
        e = nx * (ax + pose[0]) + ny * (ay + pose[1]) - lines[i, 2]
        weight = 1.0 / (1.0 + (e / KERNEL) ** 2)
        weight *= weight * lines[i, 3] if sharp else lines[i, 3]
        found += 1
        squares += min(e * e, CAP * CAP)
        j[0], j[1], j[2] = nx, ny, ny * ax - nx * ay
        for a in range(3):
            g[a] += weight * j[a] * e
            for b in range(a + 1):
                h[a, b] += weight * j[a] * j[b]
    h[0, 1], h[0, 2], h[1, 2] = h[1, 0], h[2, 0], h[2, 1]
    return h, g, found, squares


@compiled
def _step(pose: Floats, h: Floats, g: Floats, prior: tuple[Floats, Floats]) -> Floats:
    """(3,) of Gauss-Newton, held by the prior."""
    away = np.empty(3)
    for a in range(3):
        away[a] = pose[a] - prior[0][a]
    away[2] = (away[2] + np.pi) % (2 * np.pi) - np.pi
    left, right = np.empty((3, 3)), np.empty(3)
    for a in range(3):
        right[a] = -g[a]
        for b in range(3):
            left[a, b] = h[a, b] + prior[1][a, b]
            right[a] -= prior[1][a, b] * away[b]
        left[a, a] += 1e-6
    return solve(left, right)


@compiled
def refine(
    start: Floats, cloud: tuple[Floats, Floats, Floats], table: Table, prior: tuple[Floats, Floats], reach: float
) -> tuple[Floats, Floats, float, float]:
    """(pose (3,), H (3, 3), share [-], rms [m]) of a cloud's points (n, 2), normals (n, 2), weights (n,) near ``start`` (3,) [m, m, rad].

    prior: pose (3,) and weight (3, 3) in units of one point's; reach: of the first association [m].
    """
    pose = start.copy()
    h = np.zeros((3, 3))
    share = rms = 0.0
    for turn in range(ROUNDS):
        before = pose.copy()
        lines = _associate(pose, cloud, table, reach if turn == 0 else max(0.5 * reach, 0.1))
        for _ in range(STEPS):
            h, g, found, squares = _normal_equations(pose, cloud[0], lines, turn > 0)
            share, rms = found / max(cloud[0].shape[0], 1), np.sqrt(squares / max(found, 1))
            step = _step(pose, h, g, prior)
            for a in range(3):
                pose[a] += step[a]
            if abs(step[0]) + abs(step[1]) < STILL and abs(step[2]) < STILL_TURN:
                break
        moved = abs(pose[0] - before[0]) + abs(pose[1] - before[1])
        if turn > 0 and moved < STILL and abs(pose[2] - before[2]) < STILL_TURN:
            break
    return pose, h, share, rms


def match(start: Pose2, cloud: Cloud, surfaces: PointMap, prior_information: Floats, reach: float = CELL) -> Match:
    """Match of a cloud near ``start``, held there by a prior with information (3, 3) of (x, y, yaw) [1/m^2, 1/rad^2].

    reach: how far from a point its surface may be at first [m], at most CELL.
    """
    begin = np.array(start)
    prior = (begin, prior_information * SIGMA**2)
    pose, h, share, rms = refine(begin, (cloud.points, cloud.normals, cloud.weights), surfaces.table, prior, min(reach, CELL))
    found = Pose2(float(pose[0]), float(pose[1]), wrap(float(pose[2])))
    return Match(found, honest(h) / SIGMA**2, float(share), float(rms))


def honest(h: Floats) -> Floats:
    """Information (3, 3) without what only the noise of the normals tells: along a bare corridor there is nothing to be known.

    Each eigenvalue of the position's part loses in proportion as it is no more than ``TILT`` squared of the largest one.
    """
    values, axes = np.linalg.eigh(h[:2, :2])
    values = np.maximum(values, 0.0)
    kept = values / np.maximum(values + TILT**2 * values[1], 1e-12)
    shrink = np.eye(3)
    shrink[:2, :2] = axes @ np.diag(np.sqrt(kept)) @ axes.T
    less: Floats = shrink @ h @ shrink
    return less


def offsets(points: Floats, normals: Floats, surfaces: PointMap) -> Floats:
    """Distances (n,) [m] from points with normals, (n, 2) each, to the surface of the same side; infinite where none is within CELL."""
    return _offsets(points, normals, surfaces.table)


@compiled
def _offsets(points: Floats, normals: Floats, table: Table) -> Floats:
    found = np.full(points.shape[0], np.inf)
    for i in range(points.shape[0]):
        nx, ny, e = _surface(points[i, 0], points[i, 1], (normals[i, 0], normals[i, 1]), table, CELL)
        if nx != 0.0 or ny != 0.0:
            found[i] = e
    return found
