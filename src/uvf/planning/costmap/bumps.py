"""Touches of the vehicle's outline: where on it, and that one touch is told of once."""

from collections.abc import Sequence
from math import hypot, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2
from uvf.planning.costmap.footprint import RobotFootprint

Floats = NDArray[np.float64]
Sector = tuple[float, float]
Motion = tuple[float, float]

SPACING = 0.02  # m along the outline
OUTSIDE = 0.01  # m from the outline
LEADING = 0.7
"""Share of the quickest outward motion of the outline from which on a part of it counts as having led."""
STILL = 0.02  # m/s, slower than that nothing has led
LEFT, FREE = 0.05, 0.5  # m from where it was touched, and s without touching, from which on another touch is a new one


class Bump(NamedTuple):
    """A touch of the vehicle at ``pose``. motion: [m/s], [rad/s] that led to it; points (n, 2) [m, base frame] where it may have been."""

    pose: Pose2
    motion: Motion
    points: Floats


class BumpSense:
    """One vehicle's.

    sectors: of its bumpers by name, (right, left) [rad] counter-clockwise from forward; without any the body feels that it is touched,
    not where.
    """

    def __init__(self, footprint: RobotFootprint, sectors: dict[str, Sector]) -> None:
        self._sectors = sectors
        self._points, self._normals = _around(footprint)
        self._bearings = np.arctan2(self._points[:, 1], self._points[:, 0])
        self._touched_at: Pose2 | None = None
        self._free_since = inf

    def feel_nothing(self, t: float) -> None:
        """Nothing touches it at ``t`` [s]."""
        self._free_since = min(self._free_since, t)

    def feel(self, t: float, pose: Pose2, motion: Motion, felt: Sequence[str]) -> Bump | None:
        """A touch at ``t`` [s], with motion ([m/s], [rad/s]) and the names of the bumpers that feel it.

        None as long as it has not left the place of the touch before: it may scrape along as it leaves.
        """
        free, at = t - self._free_since, self._touched_at
        self._free_since = inf
        if at is not None and (free < FREE or hypot(pose[0] - at[0], pose[1] - at[1]) < LEFT):
            return None
        x, y = self._points.T
        outwards = self._normals[:, 0] * (motion[0] - motion[1] * y) + self._normals[:, 1] * motion[1] * x
        mask = self._in(felt)
        if (quickest := float(outwards[mask].max(initial=0.0))) > STILL:
            mask &= outwards >= LEADING * quickest
        elif not any(name in self._sectors for name in felt):
            return None  # somebody else has come against it
        self._touched_at = pose
        return Bump(pose, motion, (self._points + OUTSIDE * self._normals)[mask])

    def _in(self, felt: Sequence[str]) -> NDArray[np.bool_]:
        known = [self._sectors[name] for name in felt if name in self._sectors]
        mask = np.full(len(self._points), not known)
        for right, left in known:
            mask |= (self._bearings - right) % (2.0 * np.pi) <= left - right
        return mask


def _around(footprint: RobotFootprint) -> tuple[Floats, Floats]:
    """Points (n, 2) [m] along the outline and the outward normals (n, 2) there."""
    corners, sides = np.array(footprint.outline), footprint.sides()
    points, normals = [], []
    for begin, end, side in zip(corners, np.roll(corners, -1, axis=0), sides, strict=True):
        share = np.linspace(0.0, 1.0, int(np.hypot(*(end - begin)) / SPACING) + 2)[:-1]
        points.append(begin + share[:, None] * (end - begin))
        normals.append(np.tile(side[:2], (len(share), 1)))
    return np.concatenate(points), np.concatenate(normals)
