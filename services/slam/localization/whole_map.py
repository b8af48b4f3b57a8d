"""All places in a whole map where what was seen fits, by branch and bound over every pose on free floor."""

from collections import deque
from math import hypot

import numpy as np
from numpy.typing import NDArray

from services.slam.localization.groups import near
from services.slam.localization.known_map import KnownMap
from services.slam.matching.branch_and_bound import Found, cells_at, descend, score_at
from services.slam.matching.likelihood import FULL
from uvf.maths.compiled import compiled
from uvf.maths.planar import Pose2, compose, inverse, transform
from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

FAR = 0.8  # quantile of the points' distances
FINEST, COARSEST = 0.01, 0.05  # rad between headings
RIVAL = 0.8  # part of the best score that another place has to reach
LEAST = 0.3  # score
MOST_FOUND = 4000
APART, APART_TURN = 1.0, 0.4  # m, rad: two places are not the same

KEPT_WAY, SPACING, SPACING_TURN = 2.5, 0.2, 0.2  # m of way, m and rad between sweeps of what was seen lately
GRID, POINTS, REACH = 0.1, 160, 20.0  # m between points, number of them, m


class Lately:
    """The points seen on the last metres of the way, put together by odometry alone."""

    def __init__(self) -> None:
        self._seen: deque[tuple[float, Pose2, Floats]] = deque()
        self.way = 0.0
        self._last: Pose2 | None = None

    def add(self, odom_from_base: Pose2, points: Floats) -> None:
        """points: (n, 2) m, base frame."""
        if self._last is not None:
            self.way += hypot(odom_from_base.x - self._last.x, odom_from_base.y - self._last.y)
        self._last = odom_from_base
        if self._seen and near(self._seen[-1][1], odom_from_base, SPACING, SPACING_TURN):
            return
        self._seen.append((self.way, odom_from_base, points))
        while self.way - self._seen[0][0] > KEPT_WAY:
            self._seen.popleft()

    def forget(self) -> None:
        self._seen.clear()

    def points(self) -> Floats:
        """(n, 2) m in the base frame of now, thinned."""
        if self._last is None or not self._seen:
            return np.zeros((0, 2))
        base_from_odom = inverse(self._last)
        whole = np.concatenate([transform(compose(base_from_odom, pose), points) for _, pose, points in self._seen])
        whole = whole[np.hypot(*whole.T) < REACH]
        _, first = np.unique(np.floor(whole / GRID).astype(np.int64), axis=0, return_index=True)
        thinned: Floats = whole[np.sort(first)]
        return thinned[:: max(1, len(thinned) // POINTS)]


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
    most = cells.shape[0] * (columns // step + 1) * (rows // step + 1)
    bounds, nodes = np.empty(most, dtype=np.int64), np.empty((most, 3), dtype=np.int64)
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


def whole_map(known: KnownMap, points: Floats, most: int) -> list[Found]:
    """The best places for points (n, 2) [m, base frame], no two of them the same, the best first."""
    if len(points) == 0:
        return []
    field = known.field
    far = float(np.quantile(np.hypot(*points.T), FAR))
    turns = np.arange(-np.pi, np.pi, min(max(1.5 * field.sigma / max(far, 1e-3), FINEST), COARSEST))
    half = 0.5 * field.resolution
    origin = (field.corner[0] + half, field.corner[1] + half)
    cells = np.array([cells_at(points, (*origin, turn), field.corner, field.resolution) for turn in turns.tolist()])
    whole = FULL * len(points)
    roots = _roots(cells, field.levels, _pooled(_free(known), len(field.levels) - 1), int(LEAST * whole))
    peaks = _peaks(cells, field.levels, roots, int(LEAST * whole), RIVAL)
    found: list[Found] = []
    for t, a, b, score in peaks[np.argsort(-peaks[:, 3], kind="stable")].tolist():
        if len(found) == most or score < RIVAL * FULL * len(points) * (found[0].score if found else 0.0):
            break
        pose = Pose2(origin[0] + a * field.resolution, origin[1] + b * field.resolution, wrap(float(turns[t])))
        if not any(near(pose, other.pose, APART, APART_TURN) for other in found):
            found.append(Found(pose, score / whole))
    return found


def _free(known: KnownMap) -> Mask:
    """(columns, rows) of the field's cells in which a vehicle may stand."""
    field = known.field
    free = np.zeros(field.levels.shape[1:], dtype=np.bool_)
    cells = np.floor((known.places - np.array(field.corner)) / field.resolution).astype(np.int64)
    inside = ((cells >= 0) & (cells < free.shape)).all(axis=1)
    free[cells[inside, 0], cells[inside, 1]] = True
    return free
