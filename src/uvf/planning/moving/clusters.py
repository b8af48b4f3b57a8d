"""A scan cut into the things it sees: runs of neighbouring beams without a jump in range, each taken for a disc."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

GAP, GAP_PER_METRE = 0.12, 0.03  # m between neighbouring points of one thing, and more of it by range
LEAST_POINTS = 3
SMALLEST, LARGEST = 0.05, 1.0
"""m, radii that a disc is given."""
CURVED = 0.15
"""Part of the chord by which an arc must bulge for its radius to be read off it; else half the chord is taken."""


@compiled
def labels_of(points: Floats, ranges: Floats) -> Indices:
    """(n,) number of the thing that each beam sees, -1 without a return; points (n, 2) [m] in the order of the beams, ranges (n,) [m], 0 = none."""
    n = ranges.size
    labels = np.full(n, -1, dtype=np.int64)
    current, last = -1, -1
    for i in range(n):
        if not ranges[i] > 0.0:
            continue
        joined = False
        if last >= 0 and i - last <= 3:
            dx, dy = points[i, 0] - points[last, 0], points[i, 1] - points[last, 1]
            reach = GAP + GAP_PER_METRE * min(ranges[i], ranges[last])
            joined = dx * dx + dy * dy <= reach * reach
        if not joined:
            current += 1
        labels[i] = current
        last = i
    return labels


@compiled
def discs_of(points: Floats, labels: Indices, eye: tuple[float, float], widest: float) -> Floats:
    """(k, 4) x, y, radius [m] and label of each thing of at least three beams that is no wider than ``widest`` [m].

    eye: (x, y) [m] of the sensor; of a disc it sees the near side. Radius and centre follow from the arc's chord and bulge where it
    bulges enough, else the chord counts as the diameter, and the centre lies half of it behind the middle of what is seen.
    """
    n = labels.size
    out = np.empty((n, 4))
    count, first = 0, 0
    while first < n:
        label = labels[first]
        last = first
        while last + 1 < n and (labels[last + 1] == label or labels[last + 1] < 0):
            last += 1
        if label >= 0:
            end = last
            while labels[end] < 0:
                end -= 1
            total = 0
            middle_x, middle_y = 0.0, 0.0
            for i in range(first, end + 1):
                if labels[i] == label:
                    total += 1
                    middle_x += points[i, 0]
                    middle_y += points[i, 1]
            chord = np.hypot(points[end, 0] - points[first, 0], points[end, 1] - points[first, 1])
            if total >= LEAST_POINTS and chord <= widest:
                middle_x, middle_y = middle_x / total, middle_y / total
                half_x, half_y = 0.5 * (points[end, 0] + points[first, 0]), 0.5 * (points[end, 1] + points[first, 1])
                ahead_x, ahead_y = half_x - eye[0], half_y - eye[1]
                away = max(np.hypot(ahead_x, ahead_y), 1e-6)
                ahead_x, ahead_y = ahead_x / away, ahead_y / away
                bulge = 0.0
                for i in range(first, end + 1):
                    if labels[i] == label:
                        bulge = max(bulge, (half_x - points[i, 0]) * ahead_x + (half_y - points[i, 1]) * ahead_y)
                radius = 0.5 * chord
                if bulge > CURVED * chord:
                    radius = (0.25 * chord * chord + bulge * bulge) / (2.0 * bulge)
                radius = min(max(radius, SMALLEST), LARGEST)
                nearest = -bulge
                out[count, 0] = half_x + (nearest + radius) * ahead_x
                out[count, 1] = half_y + (nearest + radius) * ahead_y
                out[count, 2], out[count, 3] = radius, label
                count += 1
        first = last + 1
    return out[:count].copy()
