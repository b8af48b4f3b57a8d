"""Where the beams of a lidar end about the vehicle, each seen from where the vehicle was when it was measured."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.messages import LaserScan
from uvf.maths import rotations, se3
from uvf.maths.se2 import Pose2, PoseHistory, compose, inverse, transform
from uvf.maths.se3 import Transform, from_above
from uvf.runtime.messages.convert import scan_rays, seconds
from uvf.sensors.sweeping import Sweeping

Floats = NDArray[np.float64]

HISTORY = 100  # poses kept, 2 s: a sweep may take one
MOST_BEAMS = 1440
LATELY = 0.3  # s over which the motion is taken
MOST = 1000.0  # m, beyond which no lidar sees


@dataclass(frozen=True)
class PlacedScan:
    """A scan at ``t`` [s], when its last beam was measured from ``pose``; what it saw, in the base frame of that pose."""

    t: float
    pose: Pose2
    eye: tuple[float, float]
    """(x, y) [m] of the lidar."""
    points: Floats
    """(n, 2) [m], ends of the beams in their order; those without return end at the farthest."""
    ranges: Floats
    """(n,) [m], 0 = no return."""
    lidar: int
    """Which of the vehicle's lidars it is of, 0 the first."""


class PlacedLidar(NamedTuple):
    """Where a lidar sits, and how it sweeps."""

    base_from_lidar: Transform
    sweeping: Sweeping


class ScanPlacer:
    """One vehicle's; poses are in one frame, whichever."""

    def __init__(self, lidars: Mapping[str, PlacedLidar], farthest: float) -> None:
        """lidars: by the frames that their scans name, the first one first; farthest: m, at which beams without return end."""
        self._lidars, self.farthest = lidars, farthest
        self._history, self._orientation = PoseHistory(HISTORY), rotations.IDENTITY
        self._placed_at = dict.fromkeys(lidars, -np.inf)
        self._waiting: dict[str, LaserScan] = {}

    @property
    def t(self) -> float:
        """Time [s] of the last scan that was placed, of the lidar of which this is longest ago: from then on there is a blind side."""
        return min(self._placed_at.values())

    @property
    def offset(self) -> float:
        """Distance [m] from the vehicle's centre to the nearest lidar, in the plane."""
        return min(hypot(*lidar.base_from_lidar.translation[:2].tolist()) for lidar in self._lidars.values())

    def move(self, t: float, pose: Pose2, orientation: Floats) -> None:
        """The vehicle was at ``pose`` at ``t`` [s]; orientation: wxyz (4,), of which the tilt counts."""
        self._history.add(t, pose)
        self._orientation = orientation

    def at(self, t: float) -> Pose2 | None:
        """Where the vehicle was at ``t`` [s]; None when that is too long ago, or not known yet."""
        return self._history.at(t)

    @property
    def newest(self) -> tuple[float, Pose2] | None:
        """Time [s] and pose of the newest that is known."""
        return self._history.newest

    @property
    def motion(self) -> tuple[float, float]:
        """Its lately driven speed [m/s], backwards negative, and turn rate [rad/s]; 0 where it is not known."""
        if self.newest is None or (before := self._history.at(self.newest[0] - LATELY)) is None:
            return 0.0, 0.0
        x, _, turned = compose(inverse(before), self.newest[1])
        return x / LATELY, turned / LATELY

    def place(self, scan: LaserScan) -> PlacedScan | None:
        """The scan, if it is newer than the last one of this lidar and the poses reach to its end.

        One that is ahead of the poses waits for the next call: of a quick lidar the newest scan always is.
        """
        if (lidar := self._lidars.get(scan.frame_id)) is None:
            return None
        if (placed := self._place(scan, lidar)) is not None:
            return placed
        waited, self._waiting[scan.frame_id] = self._waiting.get(scan.frame_id), scan
        return self._place(waited, lidar) if waited is not None and waited is not scan else None

    def _place(self, scan: LaserScan, lidar: PlacedLidar) -> PlacedScan | None:
        taken_at = lidar.sweeping.end(seconds(scan.timestamp))
        pose = self._history.at(taken_at)
        if taken_at <= self._placed_at[scan.frame_id] or pose is None:
            return None
        ranges, rays = scan_rays(scan)
        ranges = np.where((ranges > 0.0) & (ranges < MOST), ranges, 0.0)
        ends = np.where(ranges > 0.0, ranges, self.farthest)[:, None] * rays
        base_from_frame, points = inverse(pose), np.empty_like(ends)
        level_from_base = Transform(rotations.level_from(self._orientation), np.zeros(3))
        level_from_lidar = se3.compose(level_from_base, lidar.base_from_lidar)
        for at, beams in lidar.sweeping.parts(len(ranges), seconds(scan.timestamp)):
            if (frame_from_base := self._history.at(at)) is None:
                return None
            seen = transform(frame_from_base, from_above(level_from_lidar, ends[beams]))
            points[beams] = transform(base_from_frame, seen)
        self._placed_at[scan.frame_id] = taken_at
        x, y, _ = level_from_lidar.translation.tolist()
        return PlacedScan(taken_at, pose, (x, y), *_thinned(points, ranges), list(self._lidars).index(scan.frame_id))


def _thinned(points: Floats, ranges: Floats) -> tuple[Floats, Floats]:
    """Of more beams than are needed, the nearest return of each few neighbours."""
    few = -(-len(ranges) // MOST_BEAMS)
    if few <= 1:
        return points, ranges
    padded = np.concatenate((ranges, np.zeros(-len(ranges) % few))).reshape(-1, few)
    nearest = np.argmin(np.where(padded > 0.0, padded, np.inf), axis=1) + np.arange(len(padded)) * few
    return points[nearest], ranges[nearest]
