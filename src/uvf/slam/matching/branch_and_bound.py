"""The best pose of a whole window, found without trying them all.

Hess et al., "Real-Time Loop Closure in 2D LIDAR SLAM" (2016), algorithm 3: depth first from squares of poses whose score has
an upper bound in the likelihood field.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.slam.matching.likelihood import FULL, LikelihoodField

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

FAR = 0.8  # quantile of the points' distances
TURN_SIGMAS = 1.5
FINEST, COARSEST = 0.004, 0.02  # rad


@dataclass(frozen=True)
class Window:
    """Poses to be searched: within ``side`` [m] of the centre in x and in y, within ``turn`` [rad] of its yaw."""

    centre: Pose2
    side: float
    turn: float


@dataclass(frozen=True)
class Found:
    """A pose and its score: the mean likelihood of the points there, 0..1."""

    pose: Pose2
    score: float


@compiled
def score_at(cells: Ints, level: NDArray[np.uint8], a: int, b: int) -> int:
    """Sum of a field's level over the points, whose cells are (n, 2), moved by (a, b) cells."""
    total = 0
    for k in range(cells.shape[0]):
        i, j = cells[k, 0] + a, cells[k, 1] + b
        if 0 <= i < level.shape[0] and 0 <= j < level.shape[1]:
            total += level[i, j]
    return total


@compiled
def cells_at(points: Floats, pose: tuple[float, float, float], corner: tuple[float, float], resolution: float) -> Ints:
    """Cells (n, 2) of points (n, 2) [m] seen from a pose [m, m, rad]; corner [m] and resolution [m] are the field's."""
    cells = np.empty(points.shape, dtype=np.int64)
    c, s = np.cos(pose[2]), np.sin(pose[2])
    for k in range(points.shape[0]):
        cells[k, 0] = int(np.floor((c * points[k, 0] - s * points[k, 1] + pose[0] - corner[0]) / resolution))
        cells[k, 1] = int(np.floor((s * points[k, 0] + c * points[k, 1] + pose[1] - corner[1]) / resolution))
    return cells


@compiled
def _roots(cells: NDArray[np.int64], levels: NDArray[np.uint8], side: int) -> tuple[Ints, Ints]:
    """(bounds, nodes) of all squares of the top level, best first; a node is (turn, x, y) in cells from the window's centre."""
    top = levels.shape[0] - 1
    step = 1 << top
    n = 2 * side // step + 1
    bounds = np.empty(cells.shape[0] * n * n, dtype=np.int64)
    nodes = np.empty((bounds.shape[0], 3), dtype=np.int64)
    m = 0
    for t in range(cells.shape[0]):
        for i in range(n):
            for j in range(n):
                nodes[m, 0], nodes[m, 1], nodes[m, 2] = t, i * step - side, j * step - side
                bounds[m] = score_at(cells[t], levels[top], nodes[m, 1], nodes[m, 2])
                m += 1
    order = np.argsort(-bounds)
    return bounds[order], nodes[order]


@compiled
def descend(cells: NDArray[np.int64], levels: NDArray[np.uint8], node: Ints, best: int, side: int, out: Ints) -> int:
    """Searches below a node of the top level for a pose better than ``best``; fills ``out`` (turn, x, y) and returns its score."""
    depth = levels.shape[0]
    stack = np.empty((4 * depth + 4, 5), dtype=np.int64)
    stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3], stack[0, 4] = depth - 1, node[0], node[1], node[2], best + 1
    size = 1
    scores = np.empty(4, dtype=np.int64)
    while size > 0:
        size -= 1
        level, t, a, b, bound = stack[size, 0], stack[size, 1], stack[size, 2], stack[size, 3], stack[size, 4]
        if bound <= best:
            continue
        if level == 0:
            best = bound
            out[0], out[1], out[2] = t, a, b
            continue
        step = 1 << (level - 1)
        for q in range(4):
            i, j = a + step * (q & 1), b + step * (q >> 1)
            scores[q] = score_at(cells[t], levels[level - 1], i, j) if i <= side and j <= side else -1
        for _ in range(4):
            worst = -1
            for q in range(4):
                if scores[q] >= 0 and (worst < 0 or scores[q] < scores[worst]):
                    worst = q
            if worst < 0:
                break
            if scores[worst] > best:
                stack[size, 0], stack[size, 1] = level - 1, t
                stack[size, 2], stack[size, 3] = a + step * (worst & 1), b + step * (worst >> 1)
                stack[size, 4] = scores[worst]
                size += 1
            scores[worst] = -1
    return best


@compiled
def _search(
    points: Floats,
    turns: Floats,
    centre: tuple[float, float, float],
    field: tuple[NDArray[np.uint8], tuple[float, float], float],
    side: int,
    least: int,
) -> tuple[int, int, int, int]:
    """(turn, x, y, score) of the best pose with more than ``least``; score = least where there is none."""
    levels, corner, resolution = field
    cells = np.empty((turns.shape[0], points.shape[0], 2), dtype=np.int64)
    for t in range(turns.shape[0]):
        cells[t] = cells_at(points, (centre[0], centre[1], centre[2] + turns[t]), corner, resolution)
    bounds, nodes = _roots(cells, levels, side)
    best = least
    out = np.zeros(3, dtype=np.int64)
    for m in range(bounds.shape[0]):
        if bounds[m] <= best:
            break
        best = descend(cells, levels, nodes[m], best, side, out)
    return out[0], out[1], out[2], best


def _turn_step(points: Floats, sigma: float) -> float:
    """rad, so fine that most points move by no more than the field is wide from one heading to the next."""
    far = float(np.quantile(np.hypot(points[:, 0], points[:, 1]), FAR))
    return min(max(TURN_SIGMAS * sigma / max(far, 1e-3), FINEST), COARSEST)


def search(points: Floats, field: LikelihoodField, window: Window, least: float) -> Found | None:
    """Pose in the window at which points (n, 2) [m] score best; None where none reaches ``least``, 0 to 1."""
    if len(points) == 0:
        return None
    points = np.ascontiguousarray(points)  # one layout, one compiled kernel
    turns = np.linspace(-window.turn, window.turn, 2 * int(window.turn / _turn_step(points, field.sigma)) + 1)
    side = int(np.ceil(window.side / field.resolution))
    whole = FULL * len(points)
    layers = (field.levels, field.corner, field.resolution)
    t, a, b, score = _search(points, turns, (window.centre.x, window.centre.y, window.centre.yaw), layers, side, int(least * whole))
    if score <= int(least * whole):
        return None
    x, y, yaw = window.centre
    return Found(Pose2(x + a * field.resolution, y + b * field.resolution, wrap(yaw + float(turns[t]))), score / whole)
