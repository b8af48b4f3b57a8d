"""All places of a whole map where what was seen fits, over every heading: branch and bound that keeps rivals of the best one.

Hess et al., "Real-Time Loop Closure in 2D LIDAR SLAM" (2016), algorithm 3, without a window.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.slam.matching.branch_and_bound import Found, cells_at, descend, score_at
from uvf.slam.matching.likelihood import FULL, LikelihoodField

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

FAR = 0.8  # quantile of the points' distances
FINEST, COARSEST = 0.01, 0.05  # rad between headings
APART, APART_TURN = 1.0, 0.4  # m, rad: two places are not the same
MOST_FOUND = 4000


@dataclass(frozen=True)
class Floor:
    """Where a search may find the base, and which places count.

    free: (columns, rows) of the field's cells in which the base may be; least: score, 0..1; rival: part of the best score that
    another place has to reach; most: number of places.
    """

    free: Mask
    least: float
    rival: float
    most: int


@compiled
def _pooled(free: Mask, depth: int) -> Mask:
    """Whether the square of 2^depth cells from each cell upwards has a free one."""
    out = free.copy()
    for level in range(depth):
        step = 1 << level
        for i in range(out.shape[0]):
            for j in range(out.shape[1]):
                a, b = min(i + step, out.shape[0] - 1), min(j + step, out.shape[1] - 1)
                out[i, j] = out[i, j] or out[a, j] or out[i, b] or out[a, b]
    return out


@compiled
def _roots(cells: Ints, levels: NDArray[np.uint8], free: Mask, least: int) -> tuple[Ints, Ints]:
    """(bounds, nodes (turn, x, y)) of the top level's squares that have free floor and a bound above ``least``, best first."""
    top = levels.shape[0] - 1
    step = 1 << top
    columns, rows = free.shape
    squares = 0
    for i in range(0, columns, step):
        for j in range(0, rows, step):
            squares += free[i, j]
    bounds, nodes = np.empty(cells.shape[0] * squares, dtype=np.int64), np.empty((cells.shape[0] * squares, 3), dtype=np.int64)
    m = 0
    for i in range(0, columns, step):
        for j in range(0, rows, step):
            if not free[i, j]:
                continue
            for t in range(cells.shape[0]):
                bound = score_at(cells[t], levels[top], i, j)
                if bound > least:
                    bounds[m], nodes[m, 0], nodes[m, 1], nodes[m, 2] = bound, t, i, j
                    m += 1
    order = np.argsort(-bounds[:m])
    return bounds[:m][order], nodes[:m][order]


@compiled
def _peaks(cells: Ints, levels: NDArray[np.uint8], roots: tuple[Ints, Ints], least: int, rival: float) -> Ints:
    """(n, 4) turn, x, y, score of the best pose of each square that comes near enough to the best of all."""
    bounds, nodes = roots
    found = np.empty((MOST_FOUND, 4), dtype=np.int64)
    out = np.zeros(3, dtype=np.int64)
    best, n = least, 0
    side = max(levels.shape[1], levels.shape[2])
    for m in range(bounds.shape[0]):
        floor = max(least, int(rival * best))
        if bounds[m] <= floor or n == MOST_FOUND:
            break
        score = descend(cells, levels, nodes[m], floor, side, out)
        if score > floor:
            found[n, 0], found[n, 1], found[n, 2], found[n, 3] = out[0], out[1], out[2], score
            best = max(best, score)
            n += 1
    return found[:n]


def all_turns(points: Floats, sigma: float) -> Floats:
    """Headings (n,) [rad] all round, so fine that most points (m, 2) [m] move by about the field's ``sigma`` [m] from one to the next."""
    far = float(np.quantile(np.hypot(*points.T), FAR)) if len(points) else 1.0
    return np.arange(-np.pi, np.pi, min(max(1.5 * sigma / max(far, 1e-3), FINEST), COARSEST), dtype=np.float64)


def everywhere(points: Floats, turns: Floats, field: LikelihoodField, floor: Floor) -> list[Found]:
    """Best places for points (n, 2) [m, base frame] at one of the headings ``turns`` (k,) [rad], no two the same, the best first."""
    if len(points) == 0 or len(turns) == 0:
        return []
    half = 0.5 * field.resolution
    origin = (field.corner[0] + half, field.corner[1] + half)
    cells = np.array([cells_at(points, (*origin, turn), field.corner, field.resolution) for turn in turns.tolist()])
    whole = FULL * len(points)
    roots = _roots(cells, field.levels, _pooled(floor.free, len(field.levels) - 1), int(floor.least * whole))
    peaks = _peaks(cells, field.levels, roots, int(floor.least * whole), floor.rival)
    found: list[Found] = []
    for t, a, b, score in peaks[np.argsort(-peaks[:, 3], kind="stable")].tolist():
        if len(found) == floor.most or score < floor.rival * whole * (found[0].score if found else 0.0):
            break
        pose = Pose2(origin[0] + a * field.resolution, origin[1] + b * field.resolution, wrap(float(turns[t])))
        if not any(_same(pose, other.pose) for other in found):
            found.append(Found(pose, score / whole))
    return found


def _same(p: Pose2, q: Pose2) -> bool:
    return bool(np.hypot(p.x - q.x, p.y - q.y) < APART and abs(wrap(p.yaw - q.yaw)) < APART_TURN)
