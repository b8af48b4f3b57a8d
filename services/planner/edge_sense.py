"""Edges of the floor, told once each, by the range finders that look down."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from schemas.messages import Range
from uvf.models.vehicle.sensors import RangeFinder
from uvf.sensors.cliffs import FloorWatch, floor_sights

Floats = NDArray[np.float64]

WIDTH, SPACING = 0.1, 0.02  # m, to each side of where a range finder looks, over which the edge is taken to go on


class EdgeSense:
    """One vehicle's."""

    def __init__(self, finders: Iterable[RangeFinder]) -> None:
        self._floor = FloorWatch(floor_sights(finders))
        self._ended: set[str] = set()

    def look(self, reading: Range) -> Floats | None:
        """Points (n, 2) [m, base frame] of an edge that a range finder has come upon; None where it sees floor, or still the same edge."""
        frame = reading.frame_id.rpartition("/")[2]
        if not self._floor.take(frame, reading.range):
            return None
        if not self._floor.has_ended(frame):
            self._ended.discard(frame)
            return None
        if frame in self._ended:
            return None
        self._ended.add(frame)
        place = np.array(self._floor.sights[frame].place)
        along = np.array((-place[1], place[0])) / max(float(np.linalg.norm(place)), 1e-9)
        found: Floats = place + np.outer(np.arange(-WIDTH, WIDTH + SPACING / 2, SPACING), along)
        return found
