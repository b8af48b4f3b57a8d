"""A bounding volume hierarchy over solids: a binary tree of axis-aligned boxes, built once and never changed.

Built by the surface area heuristic over 16 bins an axis (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies",
2007): the cost of a cut is the sum over both sides of area times number of primitives.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.solids import Solids

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BINS = 16
LARGEST_LEAF = 8
PAD = 1e-6
"""[m] Added to every bound: far above rounding, so that a tree never loses what a test of all primitives would find."""


class Bvh(NamedTuple):
    """Read-only arrays. kinds (n,) and rows (n, 12) as in Solids, in the order of the leaves.

    bounds (m, 6): low x y z, high x y z [m] of each node; links (m, 2): first primitive and number of them in a leaf, first child
    (the second follows it) and 0 in an inner node. Node 0 is the root, which an empty tree has not. depth: longest way to a leaf.
    """

    kinds: Ints
    rows: Floats
    bounds: Floats
    links: Ints
    depth: int


def build(solids: Solids) -> Bvh:
    """Tree over a table of primitives, in their frame. Its leaves hold the primitives in another order than the table."""
    n = len(solids.kinds)
    order = np.arange(n)
    bounds, links = np.empty((max(2 * n - 1, 0), 6)), np.zeros((max(2 * n - 1, 0), 2), dtype=np.int64)
    nodes, depth = _build((solids.low, solids.high), order, bounds, links) if n else (0, 0)
    arrays = (solids.kinds[order], solids.rows[order], bounds[:nodes].copy(), links[:nodes].copy())
    for array in arrays:
        array.flags.writeable = False
    return Bvh(*arrays, depth)


@compiled
def _build(extents: tuple[Floats, Floats], order: Ints, bounds: Floats, links: Ints) -> tuple[int, int]:
    """Number of nodes and depth; sorts ``order`` so that each leaf holds a run of it. A child always comes after its parent."""
    depths = np.zeros(links.shape[0], dtype=np.int64)
    links[0, 1] = order.shape[0]
    nodes, node = 1, 0
    while node < nodes:
        first, count = links[node, 0], links[node, 1]
        part = order[first : first + count]
        _fit(extents, part, bounds[node])
        left = _split(extents, part, _area(bounds[node]))
        if left > 0:
            links[node, 0], links[node, 1] = nodes, 0
            links[nodes, 0], links[nodes, 1] = first, left
            links[nodes + 1, 0], links[nodes + 1, 1] = first + left, count - left
            depths[nodes] = depths[nodes + 1] = depths[node] + 1
            nodes += 2
        node += 1
    return nodes, depths[nodes - 1]


@compiled
def _fit(extents: tuple[Floats, Floats], part: Ints, bound: Floats) -> None:
    """The padded box round some primitives."""
    low, high = extents
    bound[:3], bound[3:] = np.inf, -np.inf
    for i in range(part.shape[0]):
        for axis in range(3):
            bound[axis] = min(bound[axis], low[part[i], axis] - PAD)
            bound[3 + axis] = max(bound[3 + axis], high[part[i], axis] + PAD)


@compiled
def _area(bound: Floats) -> float:
    """Half the surface of a box [m^2]."""
    x, y, z = bound[3] - bound[0], bound[4] - bound[1], bound[5] - bound[2]
    area: float = x * y + y * z + z * x
    return area


@compiled
def _split(extents: tuple[Floats, Floats], part: Ints, area: float) -> int:
    """Sorts ``part`` into a left and a right side; the number on the left, 0 when it had better stay a leaf."""
    n: int = part.shape[0]
    if n == 1:
        return 0
    bins = np.empty((3, n), dtype=np.int64)
    best, best_axis, last = np.inf, -1, 0
    for axis in range(3):
        _fill_bins(extents, part, axis, bins[axis])
        cost, cut = _cheapest(extents, part, bins[axis])
        if cost < best:
            best, best_axis, last = cost, axis, cut
    if n <= LARGEST_LEAF and not best + area < n * area:
        return 0
    return _partition(part, bins[best_axis], last) if best_axis >= 0 else n // 2


@compiled
def _partition(part: Ints, bins: Ints, last: int) -> int:
    """Brings the primitives of the bins up to ``last`` to the front; their number."""
    left = 0
    for i in range(part.shape[0]):
        if bins[i] <= last:
            part[i], part[left] = part[left], part[i]
            bins[i], bins[left] = bins[left], bins[i]
            left += 1
    return left


@compiled
def _fill_bins(extents: tuple[Floats, Floats], part: Ints, axis: int, bins: Ints) -> None:
    """The bin of each primitive's middle (twice it) along an axis; all in the first when they do not differ."""
    low, high = extents
    begin, end = np.inf, -np.inf
    for i in range(part.shape[0]):
        middle = low[part[i], axis] + high[part[i], axis]
        begin, end = min(begin, middle), max(end, middle)
    for i in range(part.shape[0]):
        middle = low[part[i], axis] + high[part[i], axis]
        bins[i] = min(BINS - 1, int((middle - begin) / (end - begin) * BINS)) if end > begin else 0


@compiled
def _cheapest(extents: tuple[Floats, Floats], part: Ints, bins: Ints) -> tuple[float, int]:
    """Least cost of a cut between two bins and the last bin on its left; inf when all lie in one bin."""
    low, high = extents
    counts, boxes = np.zeros(BINS), np.empty((BINS, 6))
    boxes[:, :3], boxes[:, 3:] = np.inf, -np.inf
    for i in range(part.shape[0]):
        b = bins[i]
        counts[b] += 1.0
        for axis in range(3):
            boxes[b, axis] = min(boxes[b, axis], low[part[i], axis])
            boxes[b, 3 + axis] = max(boxes[b, 3 + axis], high[part[i], axis])
    left, right = np.empty(BINS), np.empty(BINS)
    _running_cost(counts, boxes, left)
    _running_cost(counts[::-1], boxes[::-1], right)
    best, last = np.inf, 0
    for b in range(BINS - 1):
        cost = left[b] + right[BINS - 2 - b]
        if cost < best:
            best, last = cost, b
    return best, last


@compiled
def _running_cost(counts: Floats, boxes: Floats, costs: Floats) -> None:
    """Area times number of primitives of the first 1, 2, ... bins; inf while they are empty."""
    bound, total = boxes[0].copy(), 0.0
    for b in range(BINS):
        total += counts[b]
        for axis in range(3):
            bound[axis] = min(bound[axis], boxes[b, axis])
            bound[3 + axis] = max(bound[3 + axis], boxes[b, 3 + axis])
        costs[b] = total * _area(bound) if total > 0.0 else np.inf
