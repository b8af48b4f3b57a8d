"""Vehicles of the team that a lidar looks over: they are where they say they are, and in the way all the same."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

BLURRED = 0.15  # m between where one says it is and where another one sees it
NEAREST = 16  # vehicles about one
SPACING = 0.05  # m between the points that stand for a disc


def unseen_points(discs: Floats, seen: Floats, here: tuple[float, float], reach: float) -> Floats:
    """(m, 2) m points that cover the discs (k, 3), x, y and radius [m], within ``reach`` [m] of a vehicle at ``here`` [m].

    Without those that the points (n, 2) [m] which its lidar sees show: they are known better, and may move. And without one that
    ``here`` lies in: two vehicles cannot be there, so one of them is wrong about its place, and must not hold the other. Of more than
    ``NEAREST`` the others are left out.
    """
    gap = np.hypot(*(discs[:, :2] - here).T) - discs[:, 2]
    near = np.flatnonzero((gap > 0.0) & (gap <= reach))
    found = [np.zeros((0, 2))]
    for x, y, radius in discs[near[np.argsort(gap[near], kind="stable")][:NEAREST]].tolist():
        if not (np.hypot(seen[:, 0] - x, seen[:, 1] - y) <= radius + BLURRED).any():
            found.append(_filled(radius) + np.array((x, y)))
    return np.concatenate(found)


def _filled(radius: float) -> Floats:
    """(m, 2) points of a grid within ``radius`` of the origin [m]."""
    n = int(radius / SPACING)
    points = SPACING * np.indices((2 * n + 1, 2 * n + 1)).reshape(2, -1).T - SPACING * n
    inside: Floats = points[np.hypot(*points.T) <= radius]
    return inside
