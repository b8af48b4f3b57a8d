"""Parallel swaths that cover a field in one direction: strips no wider than the tool, each as long as what of the field lies in it.

A swath must reach so far that its square end covers a slanted border, too: it spans the projection of that part of the field onto its
direction, which is found exactly, slab by slab between the corners. Where the strips lie is chosen by dynamic programming, so that the
sum of the swaths' lengths and of a cost for each swath is least.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST_STRIPS = 20_000
MOST_BOUNDARIES = 6_000  # candidates of the dynamic programming
FINEST = 8  # candidates within one width
ALIKE = 1e-7  # of the width: boundaries nearer than that are one


@dataclass(frozen=True)
class StripRules:
    """What swaths are made for: ``width`` [m] of the tool, ``each`` [m], the length that one more swath is worth, and ``gap`` [m].

    Pieces in one strip whose gap is no longer than ``gap`` become one swath.
    """

    width: float
    each: float = 0.0
    gap: float = 0.0


def swaths(edges: Floats, direction: float, rules: StripRules) -> Floats:
    """Swaths (n, 4) [m]: x, y of both ends, in ``direction`` [rad, counter-clockwise from x], strip by strip from its right to its left.

    edges: (m, 4) [m], those of all outlines and holes. Every point of the field lies within half a width beside some swath.
    Raises ValueError where there would be more than 20 000 strips.
    """
    turned = rotated(edges, -direction)
    low, high = float(turned[:, 1::2].min()), float(turned[:, 1::2].max())
    count = max(math.ceil((high - low) / rules.width - ALIKE), 1)
    if count > MOST_STRIPS:
        raise ValueError(f"{count} swaths {rules.width:g} m apart would be needed, {MOST_STRIPS} at most; give a wider spacing or less area")
    levels = np.unique(turned[:, 1::2])
    boundaries = _candidates(turned, count, rules.width)
    chosen = np.empty(len(boundaries), dtype=np.int64)
    strips = _best_strips(turned, levels, boundaries, np.array((rules.width * (1 + ALIKE), rules.each, rules.gap)), chosen)
    lines = _lines(turned, levels, boundaries[chosen[:strips]], rules.gap)
    found: Floats = rotated(lines, direction)
    return found


def rotated(lines: Floats, angle: float) -> Floats:
    """Lines (m, 4) [m] turned about the origin by ``angle`` [rad], counter-clockwise."""
    c, s = math.cos(angle), math.sin(angle)
    matrix = np.array(((c, s), (-s, c)))
    return np.ascontiguousarray(np.hstack((lines[:, :2] @ matrix, lines[:, 2:] @ matrix)))


def _candidates(edges: Floats, count: int, width: float) -> Floats:
    """Where strips may end: evenly, such that equal strips are among them, and where the field's extent jumps."""
    fine = max(min(FINEST, MOST_BOUNDARIES // count), 1)
    low, high = float(edges[:, 1::2].min()), float(edges[:, 1::2].max())
    even = np.linspace(low, high, fine * count + 1)
    if fine == 1:
        return even
    level = edges[np.abs(edges[:, 3] - edges[:, 1]) < 1e-3 * width]
    jumps = np.unique(level[:, 1::2])[: MOST_BOUNDARIES // 10]
    found = np.unique(np.concatenate((even, jumps)))
    apart = np.concatenate(((True,), np.diff(found) > ALIKE * width))
    found = found[apart]
    found[-1] = high
    return found


def _lines(edges: Floats, levels: Floats, boundaries: Floats, gap: float) -> Floats:
    """Middle lines of the strips, piece by piece."""
    room = np.empty((len(edges) + 2, 2))
    found = []
    for low, high in zip(boundaries[:-1], boundaries[1:], strict=True):
        pieces = pieces_within(edges, levels, np.array((low, high, gap)), room)
        middle = (low + high) / 2
        found += [(room[k, 0], middle, room[k, 1], middle) for k in range(pieces)]
    return np.array(found).reshape(-1, 4)


@compiled
def pieces_within(edges: Floats, levels: Floats, strip: Floats, out: Floats) -> int:
    """Writes the pieces (k, 2) [m], from x to x, of the field within a strip into ``out``, in order, and returns their number.

    edges: (m, 4) [m]; levels: the sorted y of all corners; strip: lower y, upper y, and the gap [m] up to which pieces are joined;
    out: (m + 2, 2).
    """
    low, high, gap = strip
    count = 0
    at = np.searchsorted(levels, low, side="right")
    below = low
    crossing = np.empty((len(edges), 3))
    while below < high:
        above = min(levels[at], high) if at < len(levels) else high
        at += 1
        if above - below <= 1e-12 * (high - low):
            below = above
            continue
        middle = 0.5 * (below + above)
        found = 0
        for k in range(len(edges)):
            y0, y1 = edges[k, 1], edges[k, 3]
            if (y0 > middle) == (y1 > middle):
                continue
            slope = (edges[k, 2] - edges[k, 0]) / (y1 - y0)
            x = edges[k, 0] + slope * (middle - y0)
            place = found
            while place > 0 and crossing[place - 1, 0] > x:
                crossing[place] = crossing[place - 1]
                place -= 1
            crossing[place, 0] = x
            crossing[place, 1] = edges[k, 0] + slope * (below - y0)
            crossing[place, 2] = edges[k, 0] + slope * (above - y0)
            found += 1
        for k in range(0, found - 1, 2):
            out[count, 0] = min(crossing[k, 1], crossing[k, 2])
            out[count, 1] = max(crossing[k + 1, 1], crossing[k + 1, 2])
            count += 1
        count = _joined(out, count, 0.0)
        below = above
    return _joined(out, count, gap)


@compiled
def _joined(out: Floats, count: int, gap: float) -> int:
    """Sorts pieces in place and joins those that overlap or lie within ``gap`` of one another."""
    for k in range(1, count):
        begin, end = out[k, 0], out[k, 1]
        place = k
        while place > 0 and out[place - 1, 0] > begin:
            out[place] = out[place - 1]
            place -= 1
        out[place, 0] = begin
        out[place, 1] = end
    kept = 0
    for k in range(count):
        if kept > 0 and out[k, 0] <= out[kept - 1, 1] + gap:
            out[kept - 1, 1] = max(out[kept - 1, 1], out[k, 1])
        else:
            out[kept] = out[k]
            kept += 1
    return kept


@compiled
def _best_strips(edges: Floats, levels: Floats, boundaries: Floats, rules: Floats, chosen: Ints) -> int:
    """Chooses boundaries no more than a width apart with the least cost; writes their indices and returns their number."""
    width, each, gap = rules
    n = len(boundaries)
    cost = np.full(n, np.inf)
    before = np.zeros(n, dtype=np.int64)
    room = np.empty((len(edges) + 2, 2))
    cost[0] = 0.0
    for j in range(1, n):
        for i in range(j - 1, -1, -1):
            if boundaries[j] - boundaries[i] > width:
                break
            if cost[i] >= cost[j]:
                continue
            pieces = pieces_within(edges, levels, np.array((boundaries[i], boundaries[j], gap)), room)
            sum_ = cost[i] + each * pieces
            for k in range(pieces):
                sum_ += room[k, 1] - room[k, 0]
            if sum_ < cost[j]:
                cost[j] = sum_
                before[j] = i
    count, k = 0, n - 1
    while k > 0:
        chosen[count] = k
        count += 1
        k = before[k]
    chosen[count] = 0
    count += 1
    for k in range(count // 2):
        chosen[k], chosen[count - 1 - k] = chosen[count - 1 - k], chosen[k]
    return count
