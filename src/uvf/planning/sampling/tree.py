"""A tree of configurations in preallocated arrays: nodes, the curves that lead to them, costs, and who follows whom."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import MOST, Triple
from uvf.planning.sampling.neighbours import Buckets, buckets, insert

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

PARENT, CHILD, NEXT, BEFORE = 0, 1, 2, 3
SIZE, GOAL = 0, 1


class CurveTree(NamedTuple):
    """``nodes`` (n, 3); ``costs`` (n,) [m] of the way from the root; ``curves`` (n, 5, 2) segments from the parent.

    ``links`` (n, 4): parent, first child, next and previous child of the same parent, -1: none. ``state``: nodes there are, and the one
    at the goal, -1: none. ``stack`` is room for walks through the tree. ``buckets`` hold all nodes but the goal.
    """

    nodes: Floats
    costs: Floats
    curves: Floats
    links: Ints
    state: NDArray[np.int64]
    stack: Ints
    buckets: Buckets


def tree(root: Triple, capacity: int, low: tuple[float, float], high: tuple[float, float]) -> CurveTree:
    """A tree of one node, with room for so many in the rectangle from ``low`` to ``high`` [m]."""
    made = CurveTree(
        np.empty((capacity, 3)),
        np.empty(capacity),
        np.empty((capacity, MOST, 2)),
        np.empty((capacity, 4), dtype=np.int32),
        np.array((0, -1)),
        np.empty(capacity, dtype=np.int32),
        buckets(capacity, low, high),
    )
    add(made, -1, root, np.zeros((MOST, 2)), 0.0)
    return made


@compiled
def node(made: CurveTree, i: int) -> Triple:
    """The configuration of a node."""
    return made.nodes[i, 0], made.nodes[i, 1], made.nodes[i, 2]


@compiled
def is_full(made: CurveTree) -> bool:
    """Whether there is no room for another node and one at the goal."""
    return bool(made.state[SIZE] + 2 > made.nodes.shape[0])


@compiled
def add(made: CurveTree, parent: int, at: Triple, curve: Floats, cost: float) -> int:
    """Adds a node at the end of ``curve`` [5, 2] from ``parent``, at a cost [m] from the root; its number."""
    i = put(made, parent, at, curve, cost)
    insert(made.buckets, made.nodes, i)
    return i


@compiled
def put(made: CurveTree, parent: int, at: Triple, curve: Floats, cost: float) -> int:
    """The same, but no other node will be led on from it: it is not put into the buckets."""
    i = made.state[SIZE]
    made.state[SIZE] += 1
    made.nodes[i, 0], made.nodes[i, 1], made.nodes[i, 2] = at
    made.links[i, :] = -1
    _follow(made, i, parent, curve, cost)
    return int(i)


@compiled
def _follow(made: CurveTree, i: int, parent: int, curve: Floats, cost: float) -> None:
    made.costs[i] = cost
    made.curves[i] = curve
    made.links[i, PARENT], made.links[i, BEFORE] = parent, -1
    if parent >= 0:
        first = made.links[parent, CHILD]
        made.links[i, NEXT] = first
        if first >= 0:
            made.links[first, BEFORE] = i
        made.links[parent, CHILD] = i


@compiled
def lead_anew(made: CurveTree, i: int, parent: int, curve: Floats, cost: float) -> None:
    """Leads to node ``i`` from another parent; what follows costs less by as much."""
    before, after = made.links[i, BEFORE], made.links[i, NEXT]
    if before >= 0:
        made.links[before, NEXT] = after
    else:
        made.links[made.links[i, PARENT], CHILD] = after
    if after >= 0:
        made.links[after, BEFORE] = before
    change = cost - made.costs[i]
    _follow(made, i, parent, curve, cost)
    count = 0
    made.stack[0] = made.links[i, CHILD]
    while count >= 0:
        j = made.stack[count]
        if j < 0:
            count -= 1
            continue
        made.costs[j] += change
        made.stack[count] = made.links[j, NEXT]
        count += 1
        made.stack[count] = made.links[j, CHILD]


def way_to(made: CurveTree, i: int) -> list[int]:
    """Nodes from the root to node ``i``, both included."""
    found = []
    while i >= 0:
        found.append(i)
        i = int(made.links[i, PARENT])
    return found[::-1]
