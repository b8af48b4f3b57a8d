"""How well a sweep fits a particle's map at a pose, and the pose nearby at which it fits best."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.vec3 import solve
from uvf.slam.maps.shared_kernels import slot_of
from uvf.slam.maps.tile_kernels import TILE
from uvf.slam.rbpf.surfaces import ParticleMap, line_at

Floats = NDArray[np.float64]
Sweep = tuple[Floats, tuple[float, float]]
"""Points (n, 2) and the lidar's place (x, y) [m, base frame]."""
Gaussian = tuple[Floats, Floats]
"""Mean (3,) and information (3, 3) of a pose (x, y, yaw) [m, rad]."""

STRAY, UNKNOWN = 0.05, 0.4
"""Likelihood, beside 1 for a point on its surface, of a point where the map is free, and of one where nothing is known."""
FREE = -10  # log-odds below which a cell is free
ITERATIONS = 12
WIDE = 3.0  # times sigma, of the first iteration; halved with each
STILL, STILL_TURN = 2e-4, 1e-4  # m, rad: a step that moves less is the last one


@compiled
def _wrapped(angle: float) -> float:
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


@compiled
def normal_equations(pose: Floats, sweep: Sweep, maps: ParticleMap, sigma: float) -> tuple[Floats, Floats, int, float]:
    """(H (3, 3), g (3,), points that found their surface, score) at a pose (3,) [m, m, rad].

    The score is the sum of exp(-d^2 / 2 sigma^2), sigma [m]. H is in units of 1 / m^2 of a point: what the sweep tells is H / sigma^2.
    """
    points, sensor = sweep
    cell = maps[0][4]
    h, g, j = np.zeros((3, 3)), np.zeros(3), np.zeros(3)
    found_, score = 0, 0.0
    c, s = np.cos(pose[2]), np.sin(pose[2])
    sx, sy = pose[0] + c * sensor[0] - s * sensor[1], pose[1] + s * sensor[0] + c * sensor[1]
    for i in range(points.shape[0]):
        ax, ay = c * points[i, 0] - s * points[i, 1], s * points[i, 0] + c * points[i, 1]
        x, y = pose[0] + ax, pose[1] + ay
        length = np.sqrt((sx - x) ** 2 + (sy - y) ** 2) + 1e-9
        nx, ny, distance, found = line_at(x / cell, y / cell, ((sx - x) / length, (sy - y) / length), maps)
        if not found:
            continue
        found_ += 1
        e = distance * cell
        weight = np.exp(-e * e / (2.0 * sigma * sigma))
        score += weight
        j[0], j[1], j[2] = nx, ny, ny * ax - nx * ay
        for a in range(3):
            g[a] += weight * j[a] * e
            for b in range(3):
                h[a, b] += weight * j[a] * j[b]
    return h, g, found_, score


@compiled
def climb(start: Floats, sweep: Sweep, maps: ParticleMap, prior: Gaussian, scale: tuple[float, float]) -> tuple[Floats, Floats, int, float]:
    """(pose (3,), H (3, 3), points that found their surface, score [-]) at the best pose near ``start`` (3,) [m, m, rad].

    Gauss-Newton on the score with weights of the last step, which climbs it. prior: holds the pose where the sweep does not;
    scale: sigma [m], and how many independent beams a point is worth.
    """
    sigma, worth = scale
    pose = start.copy()
    h, found, score = np.zeros((3, 3)), 0, 0.0
    unit = sigma * sigma / worth
    for k in range(ITERATIONS):
        h, g, found, score = normal_equations(pose, sweep, maps, sigma * max(1.0, WIDE * 0.5**k))
        away = pose - prior[0]
        away[2] = _wrapped(away[2])
        step = solve(h + unit * prior[1], -(g + unit * (prior[1] @ away)))
        pose = pose + step
        if k > 1 and abs(step[0]) + abs(step[1]) < STILL and abs(step[2]) < STILL_TURN:
            break
    return pose, h, found, score


@compiled
def log_likelihood(pose: Floats, sweep: Sweep, maps: ParticleMap, sigma: float) -> float:
    """Log-likelihood ln p(z | x, m) [-] at a pose (3,) of all points as if they were independent; 0 where each lies on its surface.

    sigma: of a beam's end [m].
    """
    points, sensor = sweep
    cell = maps[0][4]
    total = 0.0
    c, s = np.cos(pose[2]), np.sin(pose[2])
    sx, sy = pose[0] + c * sensor[0] - s * sensor[1], pose[1] + s * sensor[0] + c * sensor[1]
    for i in range(points.shape[0]):
        x, y = pose[0] + c * points[i, 0] - s * points[i, 1], pose[1] + s * points[i, 0] + c * points[i, 1]
        length = np.sqrt((sx - x) ** 2 + (sy - y) ** 2) + 1e-9
        _, _, distance, found = line_at(x / cell, y / cell, ((sx - x) / length, (sy - y) / length), maps)
        if found:
            e = distance * cell
            total += np.log(STRAY + (1.0 - STRAY) * np.exp(-e * e / (2.0 * sigma * sigma)))
            continue
        row, column = int(np.floor(y / cell)), int(np.floor(x / cell))
        known = maps[0][0][slot_of(row, column, maps[0]), row % TILE, column % TILE, 0]
        total += np.log(STRAY if known < FREE else UNKNOWN)
    return total
