"""Best-first search over a flat grid with a border: A* to one goal, Dijkstra's to one goal or to everywhere."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.search.open_list import Heap, Indices, Record, pop, push, with_room

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float64]
Cells = NDArray[np.int64]

DIAGONAL = float(np.sqrt(2.0))
TIE = 1.0 + 1e-7
"""Factor on the estimate: of equal ways the one nearer to the goal is expanded first; costs are wrong by no more."""


@compiled
def octile(a: int, b: int, columns: int) -> float:
    """Length [cells] of the shortest eight-neighbour way between two flat indices over free ground."""
    dr, dc = abs(a // columns - b // columns), abs(a % columns - b % columns)
    return max(dr, dc) + (DIAGONAL - 1.0) * min(dr, dc)


@compiled
def expand(grid: Bytes, columns: int, factors: Floats, ends: tuple[int, int], run: tuple[float, int, Record, Heap]) -> tuple[int, Heap]:
    """Expands from ``ends[0]`` until ``ends[1]`` is closed (-1: until nothing is open); the count of expanded cells, and the heap.

    grid: flat values with an impassable border, ``columns`` wide with it; factors: (256,) by value, negative = impassable;
    run: (weight of the estimate, 0 = Dijkstra, the run's number, its record, a heap).
    """
    start, goal = ends
    weight, number, record, heap = run[0] * TIE, np.uint32(2 * run[1]), run[2], run[3]
    g, parent, stamp = record.g, record.parent, record.stamp
    opened, closed = number, np.uint32(number + np.uint32(1))
    goal_r, goal_c = goal // columns, goal % columns
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
        here, base = factors[grid[top]], g[top]
        row, column = top // columns, top % columns
        for dr in range(-1, 2):
            for dc in range(-1, 2):
                beside = top + dr * columns + dc
                price = factors[grid[beside]]
                if price < 0.0 or stamp[beside] == closed:
                    continue
                if dr != 0 and dc != 0:
                    if factors[grid[top + dr * columns]] < 0.0 or factors[grid[top + dc]] < 0.0:
                        continue
                    way = base + (0.5 * DIAGONAL) * (here + price)
                else:
                    way = base + 0.5 * (here + price)
                if stamp[beside] != opened or way < g[beside]:
                    g[beside], parent[beside], stamp[beside] = way, top, opened
                    key = way
                    if weight > 0.0:
                        down, across = abs(row + dr - goal_r), abs(column + dc - goal_c)
                        key += weight * (max(down, across) + (DIAGONAL - 1.0) * min(down, across))
                    size = push(heap, size, key, beside)
    return count, heap


@compiled
def trace(parent: Indices, goal: int) -> Cells:
    """(n,) flat indices from the start to ``goal``."""
    n, i = 1, goal
    while parent[i] >= 0:
        i = parent[i]
        n += 1
    path = np.empty(n, dtype=np.int64)
    i = goal
    for k in range(n - 1, -1, -1):
        path[k] = i
        i = parent[i]
    return path
