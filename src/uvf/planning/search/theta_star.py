"""Any-angle search: lazy Theta* (Nash, Koenig, Tovey 2010) over a cost grid, and pulling its path taut."""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.search.best_first import DIAGONAL, TIE
from uvf.planning.search.open_list import Heap, Record, pop, push, with_room

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float64]
Cells = NDArray[np.int64]

ROUNDS = 20
"""Most rounds of moving a path's corners; few are needed."""


@compiled
def line_cost(grid: Bytes, columns: int, factors: Floats, a: int, b: int) -> float:
    """Cost [cells] of the straight line between two cells' centres: its length in each cell times the factor there; inf if blocked.

    A line through the corner where four cells meet needs both cells beside it. (Amanatides & Woo 1987, in whole numbers.)
    """
    dr, dc = b // columns - a // columns, b % columns - a % columns
    rows_left, columns_left = abs(dr), abs(dc)
    if rows_left == 0 and columns_left == 0:
        return 0.0
    down, across = (columns if dr > 0 else -columns), (1 if dc > 0 else -1)
    size = sqrt(dr * dr + dc * dc)
    half_r, half_c = rows_left, columns_left
    next_r, next_c = half_c, half_r  # of the next border, times 2 |dr| |dc|; rows: (2 k + 1) |dc|
    i, since, cost = a, 0.0, 0.0
    scale = 1.0 / (2.0 * max(half_r, 1) * max(half_c, 1))
    while i != b:
        price = factors[grid[i]]
        if price < 0.0:
            return np.inf
        if rows_left > 0 and columns_left > 0 and next_r == next_c:
            if factors[grid[i + down]] < 0.0 or factors[grid[i + across]] < 0.0:
                return np.inf
            until = next_r * scale
            i += down + across
            next_r += 2 * half_c
            next_c += 2 * half_r
            rows_left -= 1
            columns_left -= 1
        elif columns_left == 0 or (rows_left > 0 and next_r < next_c):
            until = next_r * scale if half_c > 0 else (2.0 * (half_r - rows_left) + 1.0) / (2.0 * half_r)
            i += down
            next_r += 2 * half_c
            rows_left -= 1
        else:
            until = next_c * scale if half_r > 0 else (2.0 * (half_c - columns_left) + 1.0) / (2.0 * half_c)
            i += across
            next_c += 2 * half_r
            columns_left -= 1
        cost += (until - since) * price
        since = until
    if factors[grid[b]] < 0.0:
        return np.inf
    total: float = size * (cost + (1.0 - since) * factors[grid[b]])
    return total


@compiled
def _distance(a: int, b: int, columns: int) -> float:
    dr, dc = a // columns - b // columns, a % columns - b % columns
    return sqrt(dr * dr + dc * dc)


@compiled
def _settle(grid: Bytes, columns: int, factors: Floats, top: int, found: tuple[Record, np.uint32]) -> None:
    """Gives a cell that is expanded its true cost: from its parent in a straight line, or from a neighbour that is closed."""
    record, closed = found
    g, parent, stamp = record.g, record.parent, record.stamp
    way = g[parent[top]] + line_cost(grid, columns, factors, int(parent[top]), top)
    before = int(parent[top])
    here = factors[grid[top]]
    for dr in range(-1, 2):
        for dc in range(-1, 2):
            beside = top + dr * columns + dc
            price = factors[grid[beside]]
            if price < 0.0 or stamp[beside] != closed:
                continue
            if dr != 0 and dc != 0 and (factors[grid[top + dr * columns]] < 0.0 or factors[grid[top + dc]] < 0.0):
                continue
            other = g[beside] + (DIAGONAL if dr != 0 and dc != 0 else 1.0) * 0.5 * (here + price)
            if other < way:
                way, before = other, beside
    g[top], parent[top] = way, before


@compiled
def theta_star(grid: Bytes, columns: int, factors: Floats, ends: tuple[int, int], run: tuple[int, Record, Heap]) -> tuple[int, Heap]:
    """Expands from ``ends[0]`` to ``ends[1]``; the count of expanded cells, and the heap. Arguments as ``best_first.expand`` has them.

    The parent of a cell is the last corner of its path. A new cell is taken to be in sight of its parent's parent, at the mean factor
    of both; what it really costs is found out when it is expanded.
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
        if top != start:
            _settle(grid, columns, factors, top, (record, closed))
        stamp[top] = closed
        count += 1
        if top == goal:
            break
        heap = with_room(heap, size, 8)
        root = top if top == start else int(parent[top])
        for dr in range(-1, 2):
            for dc in range(-1, 2):
                beside = top + dr * columns + dc
                price = factors[grid[beside]]
                if price < 0.0 or stamp[beside] == closed:
                    continue
                if dr != 0 and dc != 0 and (factors[grid[top + dr * columns]] < 0.0 or factors[grid[top + dc]] < 0.0):
                    continue
                way = g[root] + _distance(root, beside, columns) * 0.5 * (factors[grid[root]] + price)
                if stamp[beside] != opened or way < g[beside]:
                    g[beside], parent[beside], stamp[beside] = way, root, opened
                    size = push(heap, size, way + TIE * _distance(beside, goal, columns), beside)
    return count, heap


@compiled
def pull_taut(grid: Bytes, columns: int, factors: Floats, path: Cells) -> tuple[Cells, float]:
    """A path (n,) of flat indices with fewer and better corners, and its cost [cells]: it never costs more than before.

    Corners are left out where the straight line costs no more, and moved to a neighbouring cell where that is cheaper, until nothing helps.
    """
    corners, n = path.copy(), path.size
    for _ in range(ROUNDS):
        changed, kept = False, 1
        for k in range(1, n):
            corner = corners[k]
            if k + 1 < n:
                a, b = corners[kept - 1], corners[k + 1]
                now = line_cost(grid, columns, factors, a, corner) + line_cost(grid, columns, factors, corner, b)
                if line_cost(grid, columns, factors, a, b) <= now + 1e-9:
                    changed = True
                    continue
                best = corner
                for dr in range(-1, 2):
                    for dc in range(-1, 2):
                        beside = corner + dr * columns + dc
                        if factors[grid[beside]] < 0.0:
                            continue
                        way = line_cost(grid, columns, factors, a, beside) + line_cost(grid, columns, factors, beside, b)
                        if way < now - 1e-9:
                            best, now, changed = beside, way, True
                corner = best
            corners[kept] = corner
            kept += 1
        n = kept
        if not changed:
            break
    cost = 0.0
    for k in range(1, n):
        cost += line_cost(grid, columns, factors, corners[k - 1], corners[k])
    return corners[:n].copy(), cost
