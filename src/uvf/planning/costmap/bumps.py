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
HELD, SLOWED, LONGEST = 0.4, 0.3, 2.0  # s of a touch, and part of the speed, below which it holds the vehicle up; s that it is waited for
LEFT, FREE = 0.05, 0.5  # m from where it was touched, and s without touching, from which on another touch is a new one


class Bump(NamedTuple):
    """A touch of the vehicle at ``pose``. motion: [m/s], [rad/s] that led to it; points (n, 2) [m, base frame] where it may have been.

    text, cause: what people are told.
    """

    pose: Pose2
    motion: Motion
    points: Floats
    text: str = "touched something"
    cause: str = "bumper"


class BumpSense:
    """One vehicle's. sectors: of its bumpers by name, (right, left) [rad] counter-clockwise from forward.

    Where no bumper feels it, a touch counts when it holds the vehicle up: a ramp is touched too, and driven over.
    """

    def __init__(self, footprint: RobotFootprint, sectors: dict[str, Sector]) -> None:
        self._sectors = sectors
        self._points, self._normals = _around(footprint)
        self._bearings = np.arctan2(self._points[:, 1], self._points[:, 0])
        self._bumped_at: Pose2 | None = None
        self._begun: tuple[float, Motion] | None = None
        """When a touch without bumpers began, and how the vehicle came to it."""
        self._free_since = inf

    def feel_nothing(self, t: float) -> None:
        """Nothing touches it at ``t`` [s]."""
        self._free_since = min(self._free_since, t)
        if t - self._free_since >= FREE:
            self._begun = None

    def feel(self, t: float, pose: Pose2, motion: Motion, felt: Sequence[str]) -> Bump | None:
        """A touch at ``t`` [s], with motion ([m/s], [rad/s]) and the names of the bumpers that feel it.

        None as long as it has not left the place of the touch before: it may scrape along as it leaves.
        """
        free, at = t - self._free_since, self._bumped_at
        self._free_since = inf
        if at is not None and (free < FREE or hypot(pose[0] - at[0], pose[1] - at[1]) < LEFT):
            return None
        known = [self._sectors[name] for name in felt if name in self._sectors]
        came = motion if known else self._came_to_be_held(t, motion)
        if came is None:
            return None
        self._bumped_at, self._begun = pose, None
        return Bump(pose, came, self._led(came, self._in(known)))

    def _came_to_be_held(self, t: float, motion: Motion) -> Motion | None:
        """The motion with which the vehicle came to what holds it up now; None while nothing does."""
        if self._begun is None or t - self._begun[0] > LONGEST:
            self._begun = t, motion
        begun, came = self._begun
        is_held = t - begun >= HELD and self._speed(motion) < SLOWED * self._speed(came)
        return came if is_held and self._speed(came) > STILL else None

    def _speed(self, motion: Motion) -> float:
        """m/s, that the quickest part of the outline has outwards."""
        return float(self._outwards(motion).max())

    def _outwards(self, motion: Motion) -> Floats:
        """(n,) m/s of the points of the outline."""
        x, y = self._points.T
        out: Floats = self._normals[:, 0] * (motion[0] - motion[1] * y) + self._normals[:, 1] * motion[1] * x
        return out

    def _led(self, motion: Motion, mask: NDArray[np.bool_]) -> Floats:
        """(k, 2) m just outside of the part of the outline in the mask that led."""
        outwards = self._outwards(motion)
        quickest = float(outwards[mask].max(initial=0.0))
        led = mask & (outwards >= LEADING * quickest) if quickest > STILL else mask
        found: Floats = (self._points + OUTSIDE * self._normals)[led]
        return found

    def _in(self, sectors: Sequence[Sector]) -> NDArray[np.bool_]:
        """Mask (n,) of the outline's points in any of the sectors; all where there are none."""
        mask = np.full(len(self._points), not sectors)
        for right, left in sectors:
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
