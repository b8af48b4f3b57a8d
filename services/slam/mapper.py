"""Scan matching against a growing map: where the odometry frame lies in the map frame."""

from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray

from services.slam.correlative import search
from services.slam.occupancy import OccupancyMap
from services.slam.scan_match import Match, match
from uvf.maths.planar import IDENTITY, Pose2, compose, inverse, transform
from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]

LEAST_MATCHED = 25
"""Points needed before a match may correct the pose."""
LEAST_AGREEING = 0.5
"""Share of points on known ground that must find their surface, else the scan is searched for around the guess."""


@dataclass(frozen=True)
class Scan:
    """One scan in the base frame. hits: (n, 2) m, where beams ended; open_ends: (m, 2) m, free as far as there."""

    hits: Floats
    open_ends: Floats
    sensor: tuple[float, float]


class Mapper:
    """Puts scans into the map when the vehicle has moved; every scan corrects the pose."""

    def __init__(self, resolution: float, insert_distance: float, insert_turn: float) -> None:
        self.occupancy = OccupancyMap(resolution)
        self.map_from_odom: Pose2 = IDENTITY
        self.last_match: Match | None = None
        self.insert_distance = insert_distance
        self.insert_turn = insert_turn
        self._inserted_at: Pose2 | None = None

    def add(self, odom_from_base: Pose2, scan: Scan) -> bool:
        """Corrects ``map_from_odom`` by a scan taken at an odometry pose; True when the map has changed."""
        map_from_base = compose(self.map_from_odom, odom_from_base)
        if not self.occupancy.is_empty and len(scan.hits) >= LEAST_MATCHED:
            map_from_base = self._corrected(map_from_base, scan)
            self.map_from_odom = compose(map_from_base, inverse(odom_from_base))
        if not self._has_moved(map_from_base):
            return False
        sensor = transform(map_from_base, np.array((scan.sensor,)))[0]
        self.occupancy.insert(transform(map_from_base, scan.hits), transform(map_from_base, scan.open_ends), sensor)
        self._inserted_at = map_from_base
        return True

    def _corrected(self, guess: Pose2, scan: Scan) -> Pose2:
        found = match(self.occupancy, guess, scan.hits, scan.sensor)
        if found.agreeing < LEAST_AGREEING:
            start, _ = search(self.occupancy, guess, scan.hits)
            again = match(self.occupancy, start, scan.hits, scan.sensor)
            found = again if again.agreeing > found.agreeing else found
        self.last_match = found
        trusted = found.matched >= LEAST_MATCHED and found.agreeing >= LEAST_AGREEING
        return found.map_from_base if trusted else guess

    def _has_moved(self, pose: Pose2) -> bool:
        last = self._inserted_at
        if last is None:
            return True
        moved = hypot(pose[0] - last[0], pose[1] - last[1]) >= self.insert_distance
        return moved or abs(wrap(pose[2] - last[2])) >= self.insert_turn


def toward(current: Pose2, target: Pose2, distance: float, turn: float) -> Pose2:
    """``current`` moved to ``target`` by at most ``distance`` [m] and ``turn`` [rad]: corrections without jumps."""
    dx, dy, dt = target[0] - current[0], target[1] - current[1], wrap(target[2] - current[2])
    share = min(1.0, distance / max(hypot(dx, dy), 1e-12), turn / max(abs(dt), 1e-12))
    return Pose2(current[0] + share * dx, current[1] + share * dy, wrap(current[2] + share * dt))
