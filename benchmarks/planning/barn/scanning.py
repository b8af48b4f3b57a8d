"""A plane laser scan in a world of discs and boxes, and the robot's distance to them, both in closed form.

The scanner stays level at a height where everything stands: the robot's pitch and roll are not simulated.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]


def sides(boxes: Floats) -> Floats:
    """Sides (4 m, 4) x0 y0 x1 y1 [m] of boxes (m, 4): x, y of the middle, sizes along x and y."""
    rows = []
    for x, y, a, b in boxes.tolist():
        corners = [(x - a / 2, y - b / 2), (x + a / 2, y - b / 2), (x + a / 2, y + b / 2), (x - a / 2, y + b / 2)]
        rows += [(*corners[i], *corners[(i + 1) % 4]) for i in range(4)]
    return np.array(rows, dtype=np.float64).reshape(-1, 4)


@compiled
def see_discs(pose: Floats, discs: Floats, angles: tuple[float, float], ranges: Floats) -> None:
    """Shortens ``ranges`` (beams,) [m] to the first crossings of the beams with discs (n, 3) x, y, radius [m].

    pose: (3,) x, y, yaw of the scanner in the discs' frame; angles: that of the first beam and from beam to beam [rad]. A disc
    round the scanner makes all ranges 0.
    """
    first, step = angles
    beams = ranges.shape[0]
    for i in range(discs.shape[0]):
        dx, dy, radius = discs[i, 0] - pose[0], discs[i, 1] - pose[1], discs[i, 2]
        away = np.hypot(dx, dy)
        if away <= radius:
            ranges[:] = 0.0
            return
        bearing = np.arctan2(dy, dx) - pose[2] - first
        bearing -= 2 * np.pi * np.floor(bearing / (2 * np.pi))
        half = np.arcsin(radius / away)
        for turn in range(2):  # the window may begin before the first beam
            middle = bearing - turn * 2 * np.pi
            low, high = int(np.ceil((middle - half) / step)), int(np.floor((middle + half) / step))
            for k in range(max(low, 0), min(high + 1, beams)):
                off = k * step - middle
                across = away * np.sin(off)
                inside = radius * radius - across * across
                if inside >= 0.0:
                    ranges[k] = min(ranges[k], away * np.cos(off) - np.sqrt(inside))


@compiled
def see_segments(pose: Floats, segments: Floats, angles: tuple[float, float], ranges: Floats) -> None:
    """As ``see_discs``, with segments (n, 4) x0 y0 x1 y1 [m]."""
    first, step = angles
    for k in range(ranges.shape[0]):
        heading = pose[2] + first + k * step
        dx, dy = np.cos(heading), np.sin(heading)
        for i in range(segments.shape[0]):
            ax, ay = segments[i, 0] - pose[0], segments[i, 1] - pose[1]
            ex, ey = segments[i, 2] - segments[i, 0], segments[i, 3] - segments[i, 1]
            cross = dx * ey - dy * ex
            if cross == 0.0:
                continue
            along, share = (ax * ey - ay * ex) / cross, (ax * dy - ay * dx) / cross
            if 0.0 <= along < ranges[k] and 0.0 <= share <= 1.0:
                ranges[k] = along


@compiled
def clearance_to_discs(pose: Floats, half: tuple[float, float], discs: Floats) -> float:
    """Least distance [m] from a rectangle to discs (n, 3), negative where they overlap, inf without discs.

    pose: (3,) x, y, yaw of the rectangle's middle in the discs' frame; half: half its length and width [m].
    """
    c, s = np.cos(pose[2]), np.sin(pose[2])
    least = np.inf
    for i in range(discs.shape[0]):
        dx, dy = discs[i, 0] - pose[0], discs[i, 1] - pose[1]
        x, y = abs(c * dx + s * dy) - half[0], abs(c * dy - s * dx) - half[1]
        least = min(least, np.hypot(max(x, 0.0), max(y, 0.0)) + min(max(x, y), 0.0) - discs[i, 2])
    return least


@compiled
def clearance_to_boxes(pose: Floats, half: tuple[float, float], boxes: Floats) -> float:
    """As ``clearance_to_discs``, to boxes (m, 4) along the axes: from the corners of one to the other; 0 at most where one is inside."""
    c, s = np.cos(pose[2]), np.sin(pose[2])
    least = np.inf
    for i in range(boxes.shape[0]):
        for k in range(4):
            u, v = (1.0 if k % 2 else -1.0), (1.0 if k // 2 else -1.0)
            x = abs(pose[0] + u * half[0] * c - v * half[1] * s - boxes[i, 0]) - boxes[i, 2] / 2
            y = abs(pose[1] + u * half[0] * s + v * half[1] * c - boxes[i, 1]) - boxes[i, 3] / 2
            least = min(least, np.hypot(max(x, 0.0), max(y, 0.0)))
            dx, dy = boxes[i, 0] + u * boxes[i, 2] / 2 - pose[0], boxes[i, 1] + v * boxes[i, 3] / 2 - pose[1]
            x, y = abs(c * dx + s * dy) - half[0], abs(c * dy - s * dx) - half[1]
            least = min(least, np.hypot(max(x, 0.0), max(y, 0.0)))
    return least
