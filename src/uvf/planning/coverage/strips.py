"""Parallel swaths that cover a field in one direction: strips no wider than the tool, each as long as what of the field lies in it.

A swath must reach so far that its square end covers a slanted border, too: it spans every place along the strip where the field is at
all in it. Where some of the area may be left out, it spans the places where the field fills more than a certain height of the strip:
leaving out A square metres at height h shortens swaths by A / h, so that one height for all ends shortens them most (Lagrange). The
height of the field in a strip is piecewise linear and worked out exactly. Where the strips lie is chosen by dynamic programming, so
that the sum of the swaths' lengths and of a cost for each swath is least.
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
THIN = 1e-7  # of the width: what is lower is nothing
HALVINGS = 6
STEEP = 1e-6  # of a strip's height, along it: steeper edges are steps, whose slopes would leave nothing of those of others
FLAT = 1e-9  # slope, and part of a strip's height, that are left by rounding
SHORTEST = 1e-6  # m, of a piece
FEW = 48  # rows that are sorted in place

Line = tuple[float, float, float, float]


@dataclass(frozen=True)
class StripRules:
    """What swaths are made for: ``width`` [m] of the tool, ``each`` [m], the length that one more turn is worth, and ``gap`` [m].

    Pieces in one strip whose gap is no longer than ``gap`` become one swath; others are reached by a turn, or straight on. share: of the
    area that must be covered, at least.
    """

    width: float
    each: float = 0.0
    gap: float = 0.0
    share: float = 1.0


def swaths(edges: Floats, direction: float, rules: StripRules) -> Floats:
    """Swaths (n, 4) [m]: x, y of both ends, in ``direction`` [rad, counter-clockwise from x], strip by strip from its right to its left.

    edges: (m, 4) [m], those of all outlines and holes. Every point of the field lies within half a width beside some swath.
    Raises ValueError where there would be more than 20 000 strips.
    """
    turned = rotated(edges, -direction)
    low, high = float(turned[:, 1::2].min()), float(turned[:, 1::2].max())
    count = max(math.ceil((high - low) / rules.width - ALIKE), 1)
    if count > MOST_STRIPS:
        raise ValueError(
            f"{count} swaths {rules.width:g} m apart would be needed, {MOST_STRIPS} at most; give a wider spacing or less area"
        )
    boundaries = _candidates(turned, count, rules.width)
    lines, _ = _strips(turned, boundaries, rules, 0.0)
    if rules.share < 1.0:
        lines = _shortened(turned, boundaries, rules) or lines
    found: Floats = rotated(np.array(lines).reshape(-1, 4), direction)
    return found


def _shortened(edges: Floats, boundaries: Floats, rules: StripRules) -> list[Line]:
    """The swaths for the largest height left out that leaves out no more area than the rules allow; none where there is none."""
    area = float(np.sum(edges[:, 0] * edges[:, 3] - edges[:, 2] * edges[:, 1])) / 2
    best: list[Line] = []
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        lines, missed = _strips(edges, boundaries, rules, middle * rules.width)
        if lines and missed <= (1.0 - rules.share) * area:
            low, best = middle, lines
        else:
            high = middle
    return best


def _strips(edges: Floats, boundaries: Floats, rules: StripRules, least: float) -> tuple[list[Line], float]:
    """Swaths, and the area [m^2] that they leave out, where heights below ``least`` [m] are."""
    chosen = np.empty(len(boundaries), dtype=np.int64)
    numbers = np.array((rules.gap, max(least, THIN * rules.width), rules.each))
    count = _best_strips(edges, boundaries, rules.width * (1 + ALIKE), numbers, chosen)
    return _lines(edges, boundaries[chosen[:count]], numbers)


def rotated(lines: Floats, angle: float) -> Floats:
    """Lines (m, 4) [m] turned about the origin by ``angle`` [rad], counter-clockwise."""
    c, s = math.cos(angle), math.sin(angle)
    matrix = np.array(((c, s), (-s, c)))
    turned: Floats = np.ascontiguousarray(np.hstack((lines[:, :2] @ matrix, lines[:, 2:] @ matrix)))
    return turned


def _candidates(edges: Floats, count: int, width: float) -> Floats:
    """Where strips may end: evenly, such that equal strips are among them, and where the field's extent jumps."""
    fine = max(min(FINEST, MOST_BOUNDARIES // count), 1)
    low, high = float(edges[:, 1::2].min()), float(edges[:, 1::2].max())
    even = np.linspace(low, high, fine * count + 1)
    if fine == 1:
        return even
    level = edges[np.abs(edges[:, 3] - edges[:, 1]) < 1e-3 * width]
    jumps = np.unique(level[:, 1::2])[: MOST_BOUNDARIES // 10]
    found: Floats = np.unique(np.concatenate((even, jumps)))
    apart = np.concatenate(((True,), np.diff(found) > ALIKE * width))
    kept: Floats = found[apart]
    kept[-1] = high
    return kept


def _lines(edges: Floats, boundaries: Floats, numbers: Floats) -> tuple[list[Line], float]:
    """Middle lines of the strips, piece by piece, and the area [m^2] that they leave out."""
    room = np.empty((2 * len(edges) + 2, 3))
    events = np.empty((4 * len(edges) + 2, 3))
    found: list[Line] = []
    missed = 0.0
    for low, high in zip(boundaries[:-1].tolist(), boundaries[1:].tolist(), strict=True):
        pieces, lost = pieces_within(edges, (low, high), numbers, events, room)
        missed += lost
        middle = (low + high) / 2
        found += [(float(room[k, 0]), middle, float(room[k, 1]), middle) for k in range(pieces)]
    return found, missed


@compiled
def pieces_within(edges: Floats, strip: tuple[float, float], numbers: Floats, events: Floats, out: Floats) -> tuple[int, float]:
    """Writes the pieces (k, 3), from x to x [m] and their area [m^2], of the field within a strip into ``out``, in order.

    edges: (m, 4) [m], the inside to the left; strip: lower and upper y [m]; numbers: gap [m] up to which pieces are joined, height [m]
    from which on the field counts, length [m] that a piece costs besides its own. events: (4 m + 2, 3), overwritten; out: (2 m + 2, 3).
    Returns the number of pieces and the area [m^2] that lies in none.
    """
    count = _height_events(edges, strip[0], strip[1], events)
    _sort(events, count)
    gap, least, each = numbers
    height, slope, x = 0.0, 0.0, 0.0
    pieces, total, kept = 0, 0.0, 0.0
    for k in range(count):
        at = events[k, 0]
        if at > x and (height > 0.0 or slope != 0.0):
            onto = height + slope * (at - x)
            total += 0.5 * (height + onto) * (at - x)
            if max(height, onto) >= least:
                begin, end = x, at
                if height < least:
                    begin = x + (least - height) / slope
                if onto < least:
                    end = x + (least - height) / slope
                area = (height + slope * (0.5 * (begin + end) - x)) * (end - begin)
                if pieces > 0 and begin <= out[pieces - 1, 1] + 1e-9:
                    out[pieces - 1, 1] = end
                    out[pieces - 1, 2] += area
                elif end > begin:
                    out[pieces, 0] = begin
                    out[pieces, 1] = end
                    out[pieces, 2] = area
                    pieces += 1
            height = onto
        x = at
        height += events[k, 1]
        slope += events[k, 2]
        if abs(slope) < FLAT:
            slope = 0.0
        if abs(height) < FLAT * (strip[1] - strip[0]):
            height = 0.0
    pieces = _joined(out, pieces, gap)
    pieces = _worth_while(out, pieces, each, least)
    for k in range(pieces):
        kept += out[k, 2]
    return pieces, max(total - kept, 0.0)


@compiled
def _sort(events: Floats, count: int) -> None:
    """Sorts the first ``count`` rows by their first column, in place."""
    if count > FEW:
        events[:count] = events[np.argsort(events[:count, 0], kind="mergesort")]
        return
    for k in range(1, count):
        x, jump, slope = events[k]
        place = k
        while place > 0 and events[place - 1, 0] > x:
            for column in range(3):
                events[place, column] = events[place - 1, column]
            place -= 1
        events[place, 0] = x
        events[place, 1] = jump
        events[place, 2] = slope


@compiled
def _height_events(edges: Floats, low: float, high: float, events: Floats) -> int:
    """Writes where the height of the field between two levels changes: x [m], jump [m] and change of slope; returns their number.

    The height is the sum over the edges in the strip of how far they lie above its lower level, those below the inside with a minus,
    and of the whole height where the upper level lies inside.
    """
    count = 0
    for k in range(len(edges)):
        x0, y0, x1, y1 = edges[k]
        if max(y0, y1) < low or min(y0, y1) > high:
            continue
        rise = y1 - y0
        if (y0 > high) != (y1 > high):
            events[count, 0] = x0 + (high - y0) * (x1 - x0) / rise
            events[count, 1] = (low - high) if rise > 0.0 else (high - low)
            events[count, 2] = 0.0
            count += 1
        if x0 == x1:
            continue
        ya, yb = min(max(y0, low), high), min(max(y1, low), high)
        xa = x0 if rise == 0.0 else x0 + (ya - y0) * (x1 - x0) / rise
        xb = x1 if rise == 0.0 else x0 + (yb - y0) * (x1 - x0) / rise
        if abs(xb - xa) <= STEEP * (high - low):
            continue
        sign = -1.0 if xb > xa else 1.0
        slope = sign * (yb - ya) / (xb - xa)
        first, last = (ya, yb) if xb > xa else (yb, ya)
        events[count, 0] = min(xa, xb)
        events[count, 1] = sign * (first - low)
        events[count, 2] = slope
        events[count + 1, 0] = max(xa, xb)
        events[count + 1, 1] = -sign * (last - low)
        events[count + 1, 2] = -slope
        count += 2
    return count


@compiled
def _joined(out: Floats, count: int, gap: float) -> int:
    """Joins pieces within ``gap`` of one another."""
    kept = 0
    for k in range(count):
        if kept > 0 and out[k, 0] <= out[kept - 1, 1] + gap:
            out[kept - 1, 1] = out[k, 1]
            out[kept - 1, 2] += out[k, 2]
        else:
            out[kept] = out[k]
            kept += 1
    return kept


@compiled
def _worth_while(out: Floats, count: int, each: float, least: float) -> int:
    """Keeps the pieces whose area over the height left out is more than their length and what a piece is worth."""
    kept = 0
    for k in range(count):
        length = out[k, 1] - out[k, 0]
        if length > SHORTEST and out[k, 2] > least * (length + each):
            out[kept] = out[k]
            kept += 1
    return kept


@compiled
def _best_strips(edges: Floats, boundaries: Floats, width: float, numbers: Floats, chosen: Ints) -> int:
    """Chooses boundaries no more than a width apart with the least cost; writes their indices and returns their number."""
    each, least = numbers[2], numbers[1]
    n = len(boundaries)
    cost = np.full(n, np.inf)
    before = np.zeros(n, dtype=np.int64)
    room = np.empty((2 * len(edges) + 2, 3))
    events = np.empty((4 * len(edges) + 2, 3))
    cost[0] = 0.0
    for j in range(1, n):
        for i in range(j - 1, -1, -1):
            if boundaries[j] - boundaries[i] > width:
                break
            if cost[i] >= cost[j]:
                continue
            pieces, missed = pieces_within(edges, (boundaries[i], boundaries[j]), numbers, events, room)
            sum_ = cost[i] + missed / least
            for k in range(pieces):
                sum_ += room[k, 1] - room[k, 0]
                sum_ += each if k == 0 else min(each, room[k, 0] - room[k - 1, 1])
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
