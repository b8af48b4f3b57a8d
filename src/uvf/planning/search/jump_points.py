"""Jump point search on a grid of uniform cost whose corners are not cut (Harabor & Grastien 2011; 2012 for the rule on corners)."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.search.best_first import TIE, octile
from uvf.planning.search.open_list import Heap, Record, pop, push, with_room

Mask = NDArray[np.bool_]

ALL_ROUND = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))


@compiled
def _straight(free: Mask, i: int, step: int, side: int, goal: int) -> int:
    """The next jump point from ``i`` in the direction ``step``, -1 if there is none; ``side``: the step across it."""
    while True:
        before = i
        i += step
        if not free[i]:
            return -1
        if i == goal:
            return i
        if (free[i + side] and not free[before + side]) or (free[i - side] and not free[before - side]):
            return i


@compiled
def _diagonal(free: Mask, i: int, down: int, across: int, goal: int) -> int:
    """The next jump point from ``i`` in the direction ``down + across``, -1 if there is none."""
    while True:
        if not (free[i + down] and free[i + across] and free[i + down + across]):
            return -1
        i += down + across
        if i == goal:
            return i
        if _straight(free, i, down, across, goal) >= 0 or _straight(free, i, across, down, goal) >= 0:
            return i


@compiled
def _wanted(free: Mask, i: int, came: tuple[int, int], go: tuple[int, int], columns: int) -> bool:
    """Whether the direction ``go`` (rows, columns) has to be looked at after coming to ``i`` by ``came``, (0, 0) at the start."""
    if came[0] == 0 and came[1] == 0:
        return True
    if came[0] != 0 and came[1] != 0:
        return (go[0] == came[0] or go[0] == 0) and (go[1] == came[1] or go[1] == 0)
    if go == came:
        return True
    along = go[0] * came[0] + go[1] * came[1]
    if along < 0:
        return False
    side = (go[0] - along * came[0]) * columns + go[1] - along * came[1]
    return not free[i - came[0] * columns - came[1] + side]


@compiled
def jump_point_search(free: Mask, columns: int, ends: tuple[int, int], run: tuple[int, Record, Heap]) -> tuple[int, Heap]:
    """Expands jump points from ``ends[0]`` to ``ends[1]``; their count, and the heap.

    free: flat mask with a border of False, ``columns`` wide with it; run: (its number, its record, a heap). Parents are jump points.
    """
    start, goal = ends
    number, record, heap = np.uint32(2 * run[0]), run[1], run[2]
    g, parent, stamp = record.g, record.parent, record.stamp
    opened, closed = number, np.uint32(number + np.uint32(1))
    g[start], parent[start], stamp[start] = 0.0, -1, opened
    size, count = push(heap, 0, 0.0, start), 0
    while size > 0:
        top = int(heap.items[0])
        size = pop(heap, size)
        if stamp[top] == closed:
            continue
        stamp[top] = closed
        count += 1
        if top == goal:
            break
        heap = with_room(heap, size, 8)
        came_r, came_c = 0, 0
        if parent[top] >= 0:
            came_r = np.sign(top // columns - parent[top] // columns)
            came_c = np.sign(top % columns - parent[top] % columns)
        for go in ALL_ROUND:
            if not _wanted(free, top, (came_r, came_c), go, columns):
                continue
            down, across = go[0] * columns, go[1]
            if down != 0 and across != 0:
                found = _diagonal(free, top, down, across, goal)
            else:
                found = _straight(free, top, down + across, columns if down == 0 else 1, goal)
            if found < 0 or stamp[found] == closed:
                continue
            way = g[top] + octile(top, found, columns)
            if stamp[found] != opened or way < g[found]:
                g[found], parent[found], stamp[found] = way, top, opened
                size = push(heap, size, way + TIE * octile(found, goal, columns), found)
    return count, heap


@compiled
def between(jumps: NDArray[np.int64], columns: int) -> NDArray[np.int64]:
    """(m,) flat indices of every cell on the way over the jump points (n,)."""
    n = 1
    for k in range(1, jumps.size):
        n += max(abs(jumps[k] // columns - jumps[k - 1] // columns), abs(jumps[k] % columns - jumps[k - 1] % columns))
    cells = np.empty(n, dtype=np.int64)
    cells[0] = jumps[0]
    at = 0
    for k in range(1, jumps.size):
        step = np.sign(jumps[k] // columns - jumps[k - 1] // columns) * columns + np.sign(jumps[k] % columns - jumps[k - 1] % columns)
        while cells[at] != jumps[k]:
            cells[at + 1] = cells[at] + step
            at += 1
    return cells
