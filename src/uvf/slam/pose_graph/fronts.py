"""The elimination tree of a pose graph: which dense fronts its normal matrix falls into, and what goes where in them.

Multifrontal method: Liu, "The Multifrontal Method for Sparse Matrix Solution" (1992). The front of a supernode is a dense
symmetric matrix over its pivots and then its rows; what is left of it after the pivots are eliminated is added to the parent's.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.pose_graph.ordering import Elimination, minimum_degree

Ints = NDArray[np.int64]


class Structure(NamedTuple):
    """Pairs of poses that share edges. slots: (m,) pair of each edge, -1 for one at the fixed pose.

    Neighbours of pose i by ascending edge: neighbours[start[i] : start[i + 1]], pair_of the same of the pair.
    """

    slots: Ints
    start: Ints
    neighbours: Ints
    pair_of: Ints


class Tree(NamedTuple):
    """Supernodes as eliminated (``starts``, ``rows`` by place in ``pivots``: see Elimination) and their fronts.

    parents: of each supernode, -1 for none; children of s: children[child_starts[s] : child_starts[s + 1]].
    sequence: supernodes, children before parents and close to them.
    inside: for each row its block in the parent's front. Entries of s, entry_starts[s] onwards: (pair, column block, row block).
    panels: where in the factor the columns of s begin, updates: where what it leaves to its parent.
    """

    pivots: Ints
    place: Ints
    starts: Ints
    rows: Ints
    row_starts: Ints
    parents: Ints
    sequence: Ints
    child_starts: Ints
    children: Ints
    inside: Ints
    entry_starts: Ints
    entries: Ints
    panels: Ints
    updates: Ints


def structure(poses: int, ends: Ints, fixed: int) -> Structure:
    """Structure of a graph of ``poses`` poses whose edges have the ends (m, 2)."""
    slots, pairs = _pairs(poses, ends, fixed)
    return _adjacency(poses, slots, pairs)


@compiled
def _pairs(poses: int, ends: Ints, fixed: int) -> tuple[Ints, Ints]:
    """(slots, (n, 2) poses of each pair)."""
    m = ends.shape[0]
    begin = np.zeros(poses + 1, np.int64)
    for k in range(m):
        begin[min(ends[k, 0], ends[k, 1]) + 1] += 1
    for i in range(poses):
        begin[i + 1] += begin[i]
    by_lower, fill = np.empty(m, np.int64), begin.copy()
    for k in range(m):
        i = min(ends[k, 0], ends[k, 1])
        by_lower[fill[i]] = k
        fill[i] += 1
    slots, pairs, found = np.full(m, -1), np.empty((m, 2), np.int64), 0
    seen = np.full(poses, -1)
    for i in range(poses):
        before = found
        for k in by_lower[begin[i] : begin[i + 1]]:
            u = max(ends[k, 0], ends[k, 1])
            if fixed in (i, u):
                continue
            if seen[u] < before:
                seen[u] = found
                pairs[found, 0], pairs[found, 1] = i, u
                found += 1
            slots[k] = seen[u]
    return slots, pairs[:found]


@compiled
def _adjacency(poses: int, slots: Ints, pairs: Ints) -> Structure:
    start = np.zeros(poses + 1, np.int64)
    for k in range(pairs.shape[0]):
        start[pairs[k, 0] + 1] += 1
        start[pairs[k, 1] + 1] += 1
    for i in range(poses):
        start[i + 1] += start[i]
    fill = start.copy()
    neighbours, pair_of = np.empty(2 * pairs.shape[0], np.int64), np.empty(2 * pairs.shape[0], np.int64)
    for k in range(pairs.shape[0]):
        i, j = pairs[k, 0], pairs[k, 1]
        neighbours[fill[i]], neighbours[fill[j]] = j, i
        pair_of[fill[i]], pair_of[fill[j]] = k, k
        fill[i] += 1
        fill[j] += 1
    return Structure(slots, start, neighbours, pair_of)


@compiled
def _parents(elimination: Elimination, place: Ints, owner: Ints) -> tuple[Ints, Ints]:
    """Rows by ascending place of elimination, and the supernode that each leaves its rest to; -1 is none."""
    e = elimination
    rows, parents = np.empty_like(e.rows), np.full(e.starts.shape[0] - 1, -1)
    for s in range(parents.shape[0]):
        a, b = e.row_starts[s], e.row_starts[s + 1]
        for k in range(a, b):
            at, row = k, place[e.rows[k]]
            while at > a and rows[at - 1] > row:
                rows[at] = rows[at - 1]
                at -= 1
            rows[at] = row
        if b > a:
            parents[s] = owner[rows[a]]
    return rows, parents


@compiled
def _grouped(parents: Ints) -> tuple[Ints, Ints]:
    """(starts, children) by parent."""
    starts = np.zeros(parents.shape[0] + 1, np.int64)
    for parent in parents:
        if parent >= 0:
            starts[parent + 1] += 1
    for s in range(parents.shape[0]):
        starts[s + 1] += starts[s]
    fill, children = starts.copy(), np.empty(starts[-1], np.int64)
    for s in range(parents.shape[0]):
        if parents[s] >= 0:
            children[fill[parents[s]]] = s
            fill[parents[s]] += 1
    return starts, children


@compiled
def _postorder(parents: Ints, starts: Ints, children: Ints) -> Ints:
    """Depth first, so that a front is made soon after those it is made from."""
    n = parents.shape[0]
    out, count = np.empty(n, np.int64), n
    stack, depth = np.empty(n, np.int64), 0
    for root in range(n):
        if parents[root] < 0:
            stack[depth] = root
            depth += 1
    while depth > 0:
        depth -= 1
        s = stack[depth]
        count -= 1
        out[count] = s
        for k in range(starts[s], starts[s + 1]):
            stack[depth] = children[k]
            depth += 1
    return out


@compiled
def _offsets(sequence: Ints, starts: Ints, row_starts: Ints) -> tuple[Ints, Ints]:
    """Where the columns and the rest of each supernode are kept, and how much room they take in all (last)."""
    n = sequence.shape[0]
    panels, updates = np.zeros(n + 1, np.int64), np.zeros(n + 1, np.int64)
    panel = update = 0
    for s in sequence:
        columns, rest = 3 * (starts[s + 1] - starts[s]), 3 * (row_starts[s + 1] - row_starts[s])
        panels[s], updates[s] = panel, update
        panel += columns * (columns + rest)
        update += rest * rest
    panels[n], updates[n] = panel, update
    return panels, updates


@compiled
def _placed(e: Elimination) -> tuple[Ints, Ints]:
    """(place of each pose in the pivots, supernode of each place)."""
    place, owner = np.empty_like(e.pivots), np.empty_like(e.pivots)
    for s in range(e.starts.shape[0] - 1):
        for k in range(e.starts[s], e.starts[s + 1]):
            place[e.pivots[k]], owner[k] = k, s
    return place, owner


@compiled
def _fill(given: Structure, e: Elimination, rows: Ints, place: Ints, family: tuple[Ints, Ints]) -> tuple[Ints, Ints, Ints]:
    """(inside, entry_starts, entries) of the tree; family: child_starts and children."""
    child_starts, children = family
    supernodes = e.starts.shape[0] - 1
    inside = np.zeros_like(rows)
    entry_starts, entries = np.zeros(supernodes + 1, np.int64), np.empty((given.neighbours.shape[0] // 2, 3), np.int64)
    block, found = np.zeros_like(place), 0
    for s in range(supernodes):
        a, b = e.starts[s], e.starts[s + 1]
        for k in range(a, b):
            block[k] = k - a
        for k in range(e.row_starts[s], e.row_starts[s + 1]):
            block[rows[k]] = b - a + k - e.row_starts[s]
        for c in range(child_starts[s], child_starts[s + 1]):
            for k in range(e.row_starts[children[c]], e.row_starts[children[c] + 1]):
                inside[k] = block[rows[k]]
        for k in range(a, b):
            i = e.pivots[k]
            for t in range(given.start[i], given.start[i + 1]):
                later = place[given.neighbours[t]]
                if later > k:
                    entries[found, 0], entries[found, 1], entries[found, 2] = given.pair_of[t], k - a, block[later]
                    found += 1
        entry_starts[s + 1] = found
    return inside, entry_starts, entries


def plan(given: Structure) -> Tree:
    """Elimination tree for a structure. In parts, as each kernel is compiled with all that it calls."""
    e = minimum_degree(given.start, given.neighbours)
    place, owner = _placed(e)
    rows, parents = _parents(e, place, owner)
    child_starts, children = _grouped(parents)
    sequence = _postorder(parents, child_starts, children)
    panels, updates = _offsets(sequence, e.starts, e.row_starts)
    inside, entry_starts, entries = _fill(given, e, rows, place, (child_starts, children))
    tree = (e.pivots, place, e.starts, rows, e.row_starts, parents, sequence, child_starts, children, inside)
    return Tree(*tree, entry_starts, entries, panels, updates)
