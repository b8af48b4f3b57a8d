"""Worlds for global planners, what can be reached in them by a flood that knows no planner, and an independent look at paths."""

from collections import deque

import numpy as np

from tests.planning.search.driving import SIDE, blocks, costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import INSCRIBED

SMALL = RobotFootprint.circle(0.04)
"""So small that only occupied cells are shut."""
BURGER = RobotFootprint.circle(0.2)


def rooms():
    """(100, 160) cells: four rooms in a row, joined by doors on alternate sides; the last one is half unknown."""
    cells = np.zeros((100, 160), dtype=np.int8)
    for k, column in enumerate((40, 80, 120)):
        cells[:, column : column + 2] = 100
        cells[slice(5, 17) if k % 2 else slice(83, 95), column : column + 2] = 0
    cells[50:60, 130:150] = -1
    return cells


def spiral():
    """(90, 90) cells: corridors of 1.3 m that lead to the middle."""
    cells = np.zeros((90, 90), dtype=np.int8)
    for k in range(3):
        low, high = 13 * k + 13, 90 - 13 * (k + 1)
        cells[low : low + 2, low - 13 : high] = 100
        cells[low:high, high - 2 : high] = 100
        cells[high - 2 : high, low:high] = 100
        cells[low + 13 : high, low : low + 2] = 100
    return cells


def comb():
    """(80, 120) cells: teeth from both sides."""
    cells = np.zeros((80, 120), dtype=np.int8)
    for k, column in enumerate(range(20, 110, 20)):
        cells[slice(0, 62) if k % 2 else slice(18, 80), column : column + 4] = 100
    return cells


WORLDS = {
    "boxes 1": (blocks(1), (1.5, 1.5, 0.4), (18.4, 10.4, -0.9)),
    "boxes 5": (blocks(5), (18.4, 10.4, -2.6), (1.5, 1.5, -2.0)),
    "rooms": (rooms(), (1.5, 1.5, 0.0), (15.0, 9.0, 1.0)),
    "spiral": (spiral(), (1.0, 0.65, 0.0), (4.55, 4.5, 2.0)),
    "comb": (comb(), (1.0, 4.0, 0.3), (11.5, 4.0, 0.0)),
    "open": (np.zeros((50, 70), dtype=np.int8), (0.51, 0.52, 0.1), (6.03, 4.04, 3.0)),
}


def world(name, footprint=BURGER):
    """Costmap, start, goal."""
    cells, start, goal = WORLDS[name]
    return costmap(cells, footprint), start, goal


def scattered(seed, shape=(14, 17), share=0.35, unknown=0.05):
    """Cells of chance, as a costmap for the small vehicle, and all its free ones."""
    rng = np.random.default_rng(seed)
    cells = np.where(rng.random(shape) < share, 100, 0).astype(np.int8)
    cells[rng.random(shape) < unknown] = -1
    costs = costmap(cells, SMALL)
    return costs, np.argwhere(costs.values < INSCRIBED)


def flood(free, start):
    """(rows, columns) cells that four-connected steps lead to."""
    seen, queue = np.zeros_like(free), deque([tuple(start)])
    seen[tuple(start)] = True
    while queue:
        r, c = queue.popleft()
        for cell in ((r, c + 1), (r, c - 1), (r + 1, c), (r - 1, c)):
            if 0 <= cell[0] < free.shape[0] and 0 <= cell[1] < free.shape[1] and free[cell] and not seen[cell]:
                seen[cell] = True
                queue.append(cell)
    return seen


def pose(cell, yaw=0.0):
    """At the centre of a cell of 0.1 m."""
    return (cell[1] + 0.5) * SIDE, (cell[0] + 0.5) * SIDE, yaw


def check(costs, path, start, goal, free=None):
    """From start to goal, poses no farther apart than a cell, every point at a fiftieth of a cell on free ground, no squeezing through."""
    free = costs.passable if free is None else free
    assert path.ndim == 2 and path.shape[1] == 3 and np.isfinite(path).all()
    np.testing.assert_allclose(path[0, :2], start[:2], atol=1e-9)
    np.testing.assert_allclose(path[-1], goal, atol=1e-9)
    steps = np.hypot(*np.diff(path[:, :2], axis=0).T)
    assert (steps <= costs.resolution * (1 + 1e-6)).all() and (steps > 0.0).all()
    share = np.linspace(0.0, 1.0, 51)[:-1, None, None]
    points = np.vstack(((path[None, :-1, :2] + share * np.diff(path[:, :2], axis=0)).transpose(1, 0, 2).reshape(-1, 2), path[-1:, :2]))
    columns, rows = np.floor((points - costs.origin) / costs.resolution + 1e-9).astype(int).T
    near = np.floor((points - costs.origin) / costs.resolution - 1e-9).astype(int).T  # on a border either side will do
    assert (free[rows, columns] | free[near[1], near[0]]).all()
    across = np.flatnonzero((np.diff(rows) != 0) & (np.diff(columns) != 0))
    assert (free[rows[across], columns[across + 1]] | free[rows[across + 1], columns[across]]).all()
