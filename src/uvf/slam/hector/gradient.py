"""Gauss-Newton on the gradient of a grid that is interpolated between its cells.

Kohlbrecher, von Stryk, Meyer & Klingauf, "A Flexible and Scalable SLAM System with Full 3D Motion Estimation" (2011), section IV.
"""

from math import exp

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.vec3 import solve
from uvf.slam.maps.shared_kernels import Grid, slot_of
from uvf.slam.maps.tile_kernels import TILE

Floats = NDArray[np.float64]

UNIT = 0.01
"""Log-odds that a cell's numbers count."""
TURN = 0.2  # rad that one step may turn: beyond, the gradient says nothing


@compiled
def _probability(row: int, column: int, grid: Grid) -> float:
    return 1.0 / (1.0 + exp(-UNIT * grid[0][slot_of(row, column, grid), row % TILE, column % TILE, 0]))


@compiled
def interpolated(x: float, y: float, grid: Grid) -> tuple[float, float, float]:
    """(M, dM/dx, dM/dy) at (x, y) [cells]: occupancy [-] between the middles of four cells and its slopes [1/cell], equations 4 to 6."""
    u, v = x - 0.5, y - 0.5
    column, row = int(np.floor(u)), int(np.floor(v))
    dx, dy = u - column, v - row
    m00, m10 = _probability(row, column, grid), _probability(row, column + 1, grid)
    m01, m11 = _probability(row + 1, column, grid), _probability(row + 1, column + 1, grid)
    below, above = (1.0 - dx) * m00 + dx * m10, (1.0 - dx) * m01 + dx * m11
    return (1.0 - dy) * below + dy * above, (1.0 - dy) * (m10 - m00) + dy * (m11 - m01), above - below


@compiled
def normal_equations(pose: Floats, points: Floats, grid: Grid) -> tuple[Floats, Floats, float]:
    """(H (3, 3), g (3,), mean occupancy 0 to 1 at the points) at a pose (3,) [m, m, rad]: equations 12 and 13.

    points: (n, 2) [m, base frame].
    """
    h, g, j = np.zeros((3, 3)), np.zeros(3), np.zeros(3)
    c, s = np.cos(pose[2]), np.sin(pose[2])
    total, cell = 0.0, grid[4]
    for i in range(points.shape[0]):
        ax, ay = c * points[i, 0] - s * points[i, 1], s * points[i, 0] + c * points[i, 1]
        m, mx, my = interpolated((pose[0] + ax) / cell, (pose[1] + ay) / cell, grid)
        total += m
        j[0], j[1], j[2] = mx / cell, my / cell, (my * ax - mx * ay) / cell
        for a in range(3):
            g[a] += j[a] * (1.0 - m)
            for b in range(3):
                h[a, b] += j[a] * j[b]
    return h, g, total / max(points.shape[0], 1)


@compiled
def climb(start: Floats, points: Floats, grid: Grid, rounds: int, hold: tuple[Floats, Floats]) -> Floats:
    """Pose (3,) [m, m, rad] after some Gauss-Newton steps from ``start`` on one map; where it is flat nothing moves. points: (n, 2) [m].

    hold: pose (3,) and weights (3,) of a weak spring, without which noise moves the pose along a bare corridor.
    """
    pose = start.copy()
    for _ in range(rounds):
        h, g, _ = normal_equations(pose, points, grid)
        away = pose - hold[0]
        away[2] = (away[2] + np.pi) % (2.0 * np.pi) - np.pi
        step = solve(h + np.diag(hold[1]), g - hold[1] * away)
        step[2] = min(max(step[2], -TURN), TURN)
        pose = pose + step
    return pose
