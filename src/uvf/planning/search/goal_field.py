"""Cost to go from the goal over the map at half its resolution, expanded towards the start and only as far as it is asked for.

Silver's reverse resumable A* (2005): with an estimate that is consistent each closed cell has its final cost, wherever the search stands.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.search.best_first import DIAGONAL, octile
from uvf.planning.search.open_list import Heap, Record, make_heap, make_record, pop, push, with_room

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BLOCK = 2
"""Cells on a side of a coarse cell."""
START, SIZE, RUN = 0, 1, 2


class GoalField(NamedTuple):
    """``prices`` flat with a border, the least factor of each block, negative = impassable; ``columns`` with the border; ``record``;
    ``state``: the start's flat index, entries of the heap, and the number of the run."""

    prices: Floats
    columns: int
    record: Record
    state: Ints


def goal_field(prices: Floats) -> tuple[GoalField, Heap]:
    """The field of a map of factors (rows, columns), and the heap of its search; begin it before asking."""
    rows, columns = (-(-size // BLOCK) for size in prices.shape)
    padded = np.full((rows * BLOCK, columns * BLOCK), np.inf)
    padded[: prices.shape[0], : prices.shape[1]] = np.where(prices < 0.0, np.inf, prices)
    coarse = padded.reshape(rows, BLOCK, columns, BLOCK).min(axis=(1, 3))
    coarse[np.isinf(coarse)] = -1.0
    flat = np.pad(coarse, 1, constant_values=-1.0).ravel()
    return GoalField(flat, columns + 2, make_record(flat.size), np.zeros(3, dtype=np.int64)), make_heap()


@compiled
def coarse_index(columns: int, x: float, y: float) -> int:
    """Flat index of a place [cells of the map]."""
    return (int(y) // BLOCK + 1) * columns + int(x) // BLOCK + 1


@compiled
def begin(field: GoalField, heap: Heap, goal: int, start: int) -> None:
    """Roots the search at ``goal``, to be expanded towards ``start`` first."""
    state, record = field.state, field.record
    state[RUN] += 1
    if 2 * state[RUN] + 1 > 2**32 - 1:
        record.stamp[:] = 0
        state[RUN] = 1
    state[START] = start
    record.g[goal], record.stamp[goal] = 0.0, np.uint32(2 * state[RUN])
    state[SIZE] = push(heap, 0, 0.0, goal)


@compiled
def cost_to_goal(field: GoalField, heap: Heap, wanted: int) -> tuple[float, Heap]:
    """Cost [cells of the map] of the way from ``wanted`` to the goal, inf where there is none; and the heap."""
    prices, columns, record, state = field
    g, stamp = record.g, record.stamp
    opened = np.uint32(2 * state[RUN])
    closed = np.uint32(opened + np.uint32(1))
    size = state[SIZE]
    while stamp[wanted] != closed and size > 0:
        top = int(heap.items[0])
        size = pop(heap, size)
        if stamp[top] == closed:
            continue
        stamp[top] = closed
        heap = with_room(heap, size, 8)
        for dr in range(-1, 2):
            for dc in range(-1, 2):
                beside = top + dr * columns + dc
                if prices[beside] < 0.0 or stamp[beside] == closed:
                    continue
                way = g[top] + (0.5 * BLOCK) * (DIAGONAL if dr != 0 and dc != 0 else 1.0) * (prices[top] + prices[beside])
                if stamp[beside] != opened or way < g[beside]:
                    g[beside], stamp[beside] = way, opened
                    size = push(heap, size, way + BLOCK * octile(beside, state[START], columns), beside)
    state[SIZE] = size
    return (g[wanted] if stamp[wanted] == closed else np.inf), heap
