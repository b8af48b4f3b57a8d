"""What a search remembers: a heap of four children with the smallest key on top, and a record by cell that needs no clearing."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Indices = NDArray[np.int32]
Stamps = NDArray[np.uint32]

HEAP_ROOM = 4096
"""Entries of a heap at first; it grows with what waits."""


class Record(NamedTuple):
    """By flat index of the cell: what run ``n`` has found; ``stamp`` is 2 n where a cell is open, 2 n + 1 where it is closed."""

    g: Floats
    """Cost of the way from the start."""
    parent: Indices
    """Flat index of the cell before, -1 at the start."""
    stamp: Stamps


def make_record(cells: int) -> Record:
    """A record for so many cells; run numbers begin at 1."""
    return Record(np.empty(cells), np.empty(cells, dtype=np.int32), np.zeros(cells, dtype=np.uint32))


class Heap(NamedTuple):
    """Keys and items (n,) of an open list; the first ``size`` count, which its user keeps."""

    keys: Floats
    items: Indices


def make_heap() -> Heap:
    """An empty heap."""
    return Heap(np.empty(HEAP_ROOM), np.empty(HEAP_ROOM, dtype=np.int32))


@compiled
def push(heap: Heap, size: int, key: float, item: int) -> int:
    """Puts ``item`` with ``key`` into a heap of ``size`` entries, which must have room; the new size."""
    keys, items = heap.keys, heap.items
    i = size
    while i > 0:
        above = (i - 1) >> 2
        if keys[above] <= key:
            break
        keys[i], items[i] = keys[above], items[above]
        i = above
    keys[i], items[i] = key, item
    return size + 1


@compiled
def pop(heap: Heap, size: int) -> int:
    """Takes the top off a heap of ``size`` entries; the new size. The caller has read the top before."""
    keys, items = heap.keys, heap.items
    size -= 1
    key, item = keys[size], items[size]
    i = 0
    while True:
        first = 4 * i + 1
        if first >= size:
            break
        least, low = first, keys[first]
        for child in range(first + 1, min(first + 4, size)):
            if keys[child] < low:
                least, low = child, keys[child]
        if low >= key:
            break
        keys[i], items[i] = low, items[least]
        i = least
    keys[i], items[i] = key, item
    return size


@compiled
def with_room(heap: Heap, size: int, more: int) -> Heap:
    """The heap, with its arrays doubled when they lack room for ``more`` entries."""
    if size + more <= heap.keys.size:
        return heap
    keys, items = np.empty(2 * heap.keys.size + more), np.empty(2 * heap.keys.size + more, dtype=np.int32)
    keys[:size], items[:size] = heap.keys[:size], heap.items[:size]
    return Heap(keys, items)
