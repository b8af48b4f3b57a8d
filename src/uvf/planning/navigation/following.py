"""Staying behind another vehicle, on the way that it has driven."""

from math import hypot

import numpy as np
from numpy.typing import NDArray

from uvf.planning.smoothing import way_along

Floats = NDArray[np.float64]
Point = tuple[float, float]

SPACING = 0.05  # m between two places of the track that are kept
LONGEST = 50.0  # m of track


class TrackBehind:
    """The way of the one that is followed, newest place last, and the place ``distance`` [m] of it behind."""

    def __init__(self, distance: float) -> None:
        if not (np.isfinite(distance) and distance > 0.0):
            raise ValueError(f"distance: {distance} m; a positive number of metres is needed")
        self.distance = distance
        self._places: list[Point] = []

    def add(self, place: Point) -> None:
        """It is at ``place`` [m] now."""
        if not self._places or hypot(place[0] - self._places[-1][0], place[1] - self._places[-1][1]) >= SPACING:
            self._places.append(place)
            del self._places[: -int((LONGEST + self.distance) / SPACING)]

    def target(self, here: Point) -> Point | None:
        """Where a follower at ``here`` [m] is to go; None where it is near enough, or nothing is known.

        Before the track is long enough the way leads straight from the follower to where the track begins.
        """
        if not self._places:
            return None
        leader = self._places[-1]
        if hypot(here[0] - leader[0], here[1] - leader[1]) <= self.distance:
            return None
        way = np.array((here, *self._places))
        back = way[::-1]
        behind = way_along(back)
        return float(np.interp(self.distance, behind, back[:, 0])), float(np.interp(self.distance, behind, back[:, 1]))
