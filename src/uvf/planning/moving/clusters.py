"""A scan cut into the things it sees: runs of neighbouring beams without a jump in range, each taken for a disc.

What is round bulges towards the sensor: its ranges fall and rise again. A run whose ranges rise and fall in between is two things.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.moving.circles import fit_circle

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

GAP, GAP_PER_METRE = 0.12, 0.03  # m between neighbouring points of one thing, and more of it by range
LEAST_POINTS = 3
MISSED = 3  # beams without return that a thing may hide
DENT = 0.08  # m by which the ranges must fall on both sides of a dent between two things
SMALLEST, LARGEST = 0.05, 1.0
"""m, radii that a disc is given."""
CURVED = 0.15
"""Part of the chord by which an arc must bulge for its radius to be read off it; else half the chord is taken."""
COVERED = 0.3  # m by which a neighbouring beam must end nearer to hide an edge
ROUND_POINTS, SMALLEST_ROUND = 8, 0.15  # least, m
ROUGH, VAGUE = 0.015, 0.05
"""m, root mean square of the points' distances from a circle, and 1 sigma of its middle, up to which a thing is round."""
COLUMNS = 6
X, Y, RADIUS, LABEL, HIDDEN, SPREAD = range(COLUMNS)
"""Columns of a disc; hidden: 1 where something nearer covers an edge of it, or the sensor's view ends there; spread: 1 sigma [m] of the
middle of what is round, which counts as hidden nowhere, for a part of it tells its middle; 0 where it is not known to be round."""


@compiled
def labels_of(points: Floats, ranges: Floats) -> Indices:
    """(n,) number of the thing that each beam sees, -1 without a return.

    points: (n, 2) [m] in the order of the beams; ranges: (n,) [m], 0 = none.
    """
    n = ranges.size
    labels = np.full(n, -1, dtype=np.int64)
    current, last, highest, peak = -1, -1, 0.0, -1
    for i in range(n):
        if not ranges[i] > 0.0:
            continue
        joined = False
        if last >= 0 and i - last <= MISSED:
            dx, dy = points[i, 0] - points[last, 0], points[i, 1] - points[last, 1]
            reach = GAP + GAP_PER_METRE * min(ranges[i], ranges[last])
            joined = dx * dx + dy * dy <= reach * reach
        if not joined:
            current += 1
            highest, peak = ranges[i], i
        else:
            if ranges[i] > highest:
                highest, peak = ranges[i], i
            if ranges[i] < highest - DENT and _falls_before(ranges, labels, peak, current, highest):
                current += 1  # what came after the dent is another thing
                for k in range(peak, i):
                    if labels[k] >= 0:
                        labels[k] = current
                highest, peak = ranges[i], i
        labels[i] = current
        last = i
    return labels


@compiled
def part_new(labels: Indices, wide: NDArray[np.bool_], entered: NDArray[np.bool_]) -> None:
    """Parts from each wide thing (by label) what stands on ground that was free before: it has come out of a wall, or along it.

    labels (n,) are changed: each run of beams that see such ground (entered (n,)) gets a number of its own, after all others.
    """
    following, last = wide.size, -1
    for i in range(labels.size):
        label = labels[i]
        if label < 0:
            continue
        if wide[label] and entered[i]:
            if label != last:
                following += 1
            labels[i] = following - 1
            last = label
        else:
            last = -1


@compiled
def _falls_before(ranges: Floats, labels: Indices, peak: int, label: int, highest: float) -> bool:
    """Whether the same thing has a beam before ``peak`` that is nearer by a dent."""
    k = peak - 1
    while k >= 0 and (labels[k] == label or labels[k] < 0):
        if labels[k] == label and ranges[k] < highest - DENT:
            return True
        k -= 1
    return False


@compiled
def discs_of(points: Floats, ranges: Floats, labels: Indices, eye: tuple[float, float]) -> Floats:
    """(k, COLUMNS) discs (columns above) of the things that at least three beams see, by their labels.

    eye: (x, y) [m] of the sensor; of a disc it sees the near side. Radius and centre follow from the arc's chord and bulge where it
    bulges enough, else the chord counts as the diameter. Wider ones than ``LARGEST`` come out with that radius; ``chords_of`` tells them.
    """
    n = labels.size
    out = np.empty((n // LEAST_POINTS + 1, COLUMNS))
    own = np.zeros(n, dtype=np.bool_)
    count, first = 0, 0
    while first < n:
        label = labels[first]
        if label < 0:
            first += 1
            continue
        end, total, i = first, 0, first
        while i < n and (labels[i] == label or labels[i] < 0):
            if labels[i] == label:
                end = i
                total += 1
            i += 1
        if total >= LEAST_POINTS:
            _fit(points, labels, (first, end), eye, out[count])
            out[count, LABEL] = label
            out[count, HIDDEN] = _is_hidden(ranges, first, -1) or _is_hidden(ranges, end, 1)
            out[count, SPREAD] = 0.0
            if total >= ROUND_POINTS:
                own[first : end + 1] = labels[first : end + 1] == label
                _round(points[first : end + 1], own[first : end + 1], out[count])
            count += 1
        first = end + 1
    return out[:count].copy()


@compiled
def _is_hidden(ranges: Floats, edge: int, step: int) -> bool:
    """Whether what lies beside an edge ends nearer, so that the thing may go on behind it; so it may where the view ends."""
    for k in range(1, MISSED + 1):
        i = edge + k * step
        if i < 0 or i >= ranges.size:
            return True
        if ranges[i] > 0.0:
            return bool(ranges[i] < ranges[edge] - COVERED)
    return False


@compiled
def _fit(points: Floats, labels: Indices, ends: tuple[int, int], eye: tuple[float, float], out: Floats) -> None:
    """Centre and radius from the chord between the outermost points and the bulge towards the eye."""
    first, end = ends
    chord = np.hypot(points[end, 0] - points[first, 0], points[end, 1] - points[first, 1])
    half_x, half_y = 0.5 * (points[end, 0] + points[first, 0]), 0.5 * (points[end, 1] + points[first, 1])
    ahead_x, ahead_y = half_x - eye[0], half_y - eye[1]
    away = max(np.hypot(ahead_x, ahead_y), 1e-6)
    ahead_x, ahead_y = ahead_x / away, ahead_y / away
    bulge = 0.0
    for i in range(first, end + 1):
        if labels[i] == labels[first]:
            bulge = max(bulge, (half_x - points[i, 0]) * ahead_x + (half_y - points[i, 1]) * ahead_y)
    radius = 0.5 * chord
    if bulge > CURVED * chord:
        radius = (0.25 * chord * chord + bulge * bulge) / (2.0 * bulge)
    radius = min(max(radius, SMALLEST), LARGEST)
    out[X], out[Y], out[RADIUS] = half_x + (radius - bulge) * ahead_x, half_y + (radius - bulge) * ahead_y, radius


@compiled
def _round(points: Floats, own: NDArray[np.bool_], out: Floats) -> None:
    """Puts the circle through a thing's own points in the place of its disc, if it is round."""
    x, y, radius, rough, spread, _ = fit_circle(points, own, (out[X], out[Y], out[RADIUS]), True)
    if rough <= ROUGH and spread <= VAGUE and SMALLEST_ROUND <= radius <= LARGEST:
        out[X], out[Y], out[RADIUS], out[HIDDEN], out[SPREAD] = x, y, radius, 0.0, spread


@compiled
def widths_of(points: Floats, labels: Indices, count: int) -> Floats:
    """(count,) m between the outermost points of each thing, by label."""
    first = np.full(count, -1, dtype=np.int64)
    out = np.zeros(count)
    for i in range(labels.size):
        label = labels[i]
        if label >= 0:
            if first[label] < 0:
                first[label] = i
            out[label] = np.hypot(points[i, 0] - points[first[label], 0], points[i, 1] - points[first[label], 1])
    return out
