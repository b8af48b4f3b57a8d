"""Nearest neighbours among nodes that come one by one: buckets over the plane, refined as there are more nodes.

Nearness of configurations is sqrt(dx^2 + dy^2 + (w dheading)^2), which is no curve's length but picks those worth a closer look.
"""

from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import Triple, wrapped

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

FEW = 4
"""Nodes in a bucket on average, from which on the buckets are halved."""
FIRST = 8  # buckets on the longer side at first
MOST = 64  # neighbours


class Buckets(NamedTuple):
    """``head`` first node of each bucket, ``link`` the next node in the same (-1: none); ``frame`` x, y of the corner, sides, side [m] of
    a bucket; ``shape`` rows, columns, nodes."""

    head: Ints
    link: Ints
    frame: Floats
    shape: NDArray[np.int64]


class NearestNodes(NamedTuple):
    """GrowthBuffers for the nearest nodes, nearest first: ``ids`` (MOST,), ``keys`` (MOST,) squared nearness [m^2]."""

    ids: Ints
    keys: Floats


def buckets(capacity: int, low: tuple[float, float], high: tuple[float, float]) -> Buckets:
    """Buckets for so many nodes in the rectangle from ``low`` to ``high`` [m]."""
    width, height = high[0] - low[0], high[1] - low[1]
    side = max(width, height) / FIRST
    made = Buckets(
        np.full(_size(width, height, side, capacity), -1, dtype=np.int32),
        np.empty(capacity, dtype=np.int32),
        np.array((low[0], low[1], width, height, side)),
        np.zeros(3, dtype=np.int64),
    )
    _lay_out(made, side)
    return made


@compiled
def found() -> NearestNodes:
    """GrowthBuffers for ``nearest``."""
    return NearestNodes(np.empty(MOST, dtype=np.int32), np.empty(MOST))


def _size(width: float, height: float, side: float, capacity: int) -> int:
    """Buckets that there will be at most."""
    most = 0
    while True:
        count = ceil(width / side) * ceil(height / side)
        most = max(most, count)
        if FEW * count >= capacity:
            return most
        side /= 2


@compiled
def _lay_out(made: Buckets, side: float) -> None:
    made.frame[4] = side
    made.shape[0], made.shape[1] = ceil(made.frame[3] / side), ceil(made.frame[2] / side)
    made.head[: made.shape[0] * made.shape[1]] = -1


@compiled
def _bucket(made: Buckets, x: float, y: float) -> tuple[int, int]:
    row, column = int((y - made.frame[1]) / made.frame[4]), int((x - made.frame[0]) / made.frame[4])
    return min(max(row, 0), made.shape[0] - 1), min(max(column, 0), made.shape[1] - 1)


@compiled
def _hang(made: Buckets, nodes: Floats, i: int) -> None:
    row, column = _bucket(made, nodes[i, 0], nodes[i, 1])
    at = row * made.shape[1] + column
    made.link[i] = made.head[at]
    made.head[at] = i


@compiled
def insert(made: Buckets, nodes: Floats, i: int) -> None:
    """Puts node ``i`` of ``nodes`` (n, 3) in. Nodes are put in in ascending order, and some may be left out."""
    made.shape[2] += 1
    half = made.frame[4] / 2.0
    room = ceil(made.frame[3] / half) * ceil(made.frame[2] / half)
    if made.shape[2] > FEW * made.shape[0] * made.shape[1] and room <= made.head.size:
        # The old buckets' nodes, in a chain that their links still hold, go into the new ones.
        chain = -1
        for at in range(made.shape[0] * made.shape[1]):
            j = made.head[at]
            while j >= 0:
                following = made.link[j]
                made.link[j] = chain
                chain, j = j, following
        _lay_out(made, half)
        while chain >= 0:
            following = made.link[chain]
            _hang(made, nodes, chain)
            chain = following
    _hang(made, nodes, i)


@compiled
def _keep(out: NearestNodes, count: int, most: int, key: float, i: int) -> int:
    """Puts a node among the nearest so far, sorted; how many there are then."""
    if count == most and key >= out.keys[count - 1]:
        return count
    k = count if count < most else count - 1
    while k > 0 and out.keys[k - 1] > key:
        out.keys[k], out.ids[k] = out.keys[k - 1], out.ids[k - 1]
        k -= 1
    out.keys[k], out.ids[k] = key, i
    return min(count + 1, most)


@compiled
def nearest(made: Buckets, nodes: Floats, at: Triple, weight: float, most: int, out: NearestNodes) -> int:
    """Writes the ``most`` nearest of ``nodes`` (n, 3) into ``out``, nearest first; how many there are.

    weight: [m/rad] of a difference in heading. Rings of buckets about the place, until the next cannot hold any that is nearer.
    """
    row, column = _bucket(made, at[0], at[1])
    rows, columns, side = made.shape[0], made.shape[1], made.frame[4]
    count, ring = 0, 0
    # A place outside of the rectangle is seen from its nearest bucket, farther from all of them than rings tell: never nearer.
    while ring <= max(row, rows - 1 - row, column, columns - 1 - column):
        beyond = (ring - 1) * side
        if count == most and beyond > 0.0 and beyond * beyond > out.keys[count - 1]:
            break
        for r in range(max(row - ring, 0), min(row + ring, rows - 1) + 1):
            step = 1 if abs(r - row) == ring else max(2 * ring, 1)
            for c in range(column - ring, column + ring + 1, step):
                if c < 0 or c >= columns:
                    continue
                i = made.head[r * columns + c]
                while i >= 0:
                    dx, dy = nodes[i, 0] - at[0], nodes[i, 1] - at[1]
                    key = dx * dx + dy * dy
                    if count < most or key < out.keys[count - 1]:
                        turn = weight * wrapped(nodes[i, 2] - at[2]) if weight > 0.0 else 0.0
                        count = _keep(out, count, most, key + turn * turn, i)
                    i = made.link[i]
        ring += 1
    return count
