"""Vehicles of a team as discs: they are where they say they are, and in the way even where the lidar looks over them."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Point = tuple[float, float]

BLURRED = 0.15  # m between where one says it is and where another one sees it
ABOUT, WIDE = 0.75, 0.5  # of the radius: how far to the sides of the middle a disc is looked for, and how wide what shows it is
NEAREST = 16  # vehicles about one
SPACING = 0.05  # m between the points that stand for a disc
MOMENTS = 4  # at which those that move are looked at


def disc_points(discs: Floats, here: Point, reach: float) -> Floats:
    """(m, 2) m points that cover the discs (k, 3), x, y and radius [m], within ``reach`` [m] of a vehicle at ``here`` [m].

    Without one that ``here`` lies in: two vehicles cannot be there, so one of them is wrong about its place, and must not hold the other.
    Of more than ``NEAREST`` the others are left out.
    """
    gap = np.hypot(*(discs[:, :2] - here).T) - discs[:, 2]
    near = np.flatnonzero((gap > 0.0) & (gap <= reach))
    nearest = discs[near[np.argsort(gap[near], kind="stable")][:NEAREST]]
    return np.concatenate([np.zeros((0, 2)), *(_filled(radius) + np.array((x, y)) for x, y, radius in nearest.tolist())])


def unseen(discs: Floats, seen: Floats, here: Point) -> Floats:
    """Those of the discs (k, 3) [m] that the points (n, 2) [m] which a lidar at ``here`` sees do not show: what it shows is known better.

    A disc is shown by what is seen about or before the middle of it: a wall that it stands beside, or that is seen above it, hides
    nobody, if it is half the radius away from the middle or more. What is seen must be wide, too: of vehicles that carry their lidars on
    top one sees the other's lidar, and not the body below it.
    """
    middles = discs[:, None, :2]
    beams = middles - here
    ahead = beams / np.maximum(np.linalg.norm(beams, axis=2, keepdims=True), 1e-9)
    offset = seen - middles
    before = -(offset * ahead).sum(axis=2)
    beside = offset[..., 0] * ahead[..., 1] - offset[..., 1] * ahead[..., 0]
    radii = discs[:, 2:]
    about = (before >= -radii / 4) & (np.abs(beside) <= ABOUT * radii) & (np.hypot(before, beside) <= radii + BLURRED)
    is_wide = _spread(beside, about) >= WIDE * discs[:, 2]
    hidden: Floats = discs[~(is_wide & (about & (np.abs(beside) <= radii / 2)).any(axis=1))]
    return hidden


def _spread(values: Floats, chosen: NDArray[np.bool_]) -> Floats:
    """(k,) from the smallest to the largest of the chosen values (k, n), -inf where none is chosen."""
    low, high = np.where(chosen, values, np.inf), np.where(chosen, values, -np.inf)
    spread: Floats = high.max(axis=1, initial=-np.inf) - low.min(axis=1, initial=np.inf)
    return spread


def coming(discs: Floats, velocities: Floats, ahead: float) -> Floats:
    """(m, 3) m where the discs (k, 3) [m] that move by their velocities (k, 2) [m/s] are within the next ``ahead`` [s]."""
    moving = np.hypot(*velocities.T) > 0.0
    times = ahead * np.arange(1, MOMENTS + 1) / MOMENTS
    places = discs[moving, None, :2] + times[:, None] * velocities[moving, None]
    radii = np.broadcast_to(discs[moving, None, 2:], (*places.shape[:2], 1))
    return np.concatenate((places, radii), axis=2).reshape(-1, 3)


def _filled(radius: float) -> Floats:
    """(m, 2) points of a grid within ``radius`` of the origin [m]."""
    n = int(radius / SPACING)
    points = SPACING * np.indices((2 * n + 1, 2 * n + 1)).reshape(2, -1).T - SPACING * n
    inside: Floats = points[np.hypot(*points.T) <= radius]
    return inside
