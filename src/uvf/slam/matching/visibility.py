"""Whether surfaces stand where a lidar has looked through: a place that only looks alike has walls in the other's free space."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

AGREE, AGREE_SLOPE = 0.2, 0.02
"""m and m/m of range: a surface and a beam's end as far apart as that are the same."""
BEHIND, BEHIND_SLOPE = 0.4, 0.04
"""m and m/m: a beam that ends so far behind a surface has gone through it."""


AGREES, THROUGH = 1, -1

Rays = tuple[tuple[float, float], Floats, Floats]
"""Of a sweep: origin in the base frame [m]; bearings, rising [rad], and ranges [m], 0 for no return, (n,) each."""


def rays_of(reading: Reading) -> Rays:
    """The beams of a reading sorted by bearing, base frame."""
    ranges = np.where(reading.returned, reading.ranges, 0.0)
    bearings = np.ascontiguousarray(reading.beams.bearings)
    if (np.diff(bearings) < 0.0).any():  # it turns clockwise, or has moved past an edge while it swept
        order = np.argsort(bearings, kind="stable")
        bearings, ranges = bearings[order], ranges[order]
    return reading.beams.origin, bearings, ranges


@compiled
def _place(rising: Floats, value: float) -> int:
    """Of the first that is not below a value."""
    low, high = 0, rising.shape[0]
    while low < high:
        middle = (low + high) // 2
        if rising[middle] < value:
            low = middle + 1
        else:
            high = middle
    return low


@compiled
def verdicts(points: Floats, base_from_points: tuple[float, float, float], rays: Rays) -> NDArray[np.int8]:
    """Verdict (n,) on surface points (n, 2) [m]: AGREES where the sweep sees them, THROUGH where it looks through them, 0 where neither.

    base_from_points: pose [m, m, rad] of the points' frame in the sweep's base frame.
    """
    origin, bearings, ranges = rays
    found = np.zeros(points.shape[0], dtype=np.int8)
    last = bearings.shape[0] - 1
    if last < 1:
        return found
    width = 1.5 * (bearings[last] - bearings[0]) / last
    c, s = np.cos(base_from_points[2]), np.sin(base_from_points[2])
    for i in range(points.shape[0]):
        dx = c * points[i, 0] - s * points[i, 1] + base_from_points[0] - origin[0]
        dy = s * points[i, 0] + c * points[i, 1] + base_from_points[1] - origin[1]
        rho = np.sqrt(dx * dx + dy * dy)
        angle = bearings[0] + (np.arctan2(dy, dx) - bearings[0]) % (2.0 * np.pi)
        k = _place(bearings, angle)
        if k > last or rho < 0.1:
            continue
        near, seen, met = np.inf, False, False
        for m in range(max(0, k - 1), min(last, k + 1) + 1):
            if ranges[m] > 0.0 and abs(bearings[m] - angle) <= width:
                seen = True
                near = min(near, ranges[m])
                met = met or abs(ranges[m] - rho) < AGREE + AGREE_SLOPE * rho
        if met:
            found[i] = AGREES
        elif seen and near > rho + BEHIND + BEHIND_SLOPE * rho:
            found[i] = THROUGH
    return found
