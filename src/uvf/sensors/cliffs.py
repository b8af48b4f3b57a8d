"""Range finders that look down at the floor: where each looks, and when there is no floor."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from uvf.maths.rotations import from_euler, rotate
from uvf.models.vehicle.sensors import RangeFinder

DOWN = 0.5  # downward share of a beam, from which on it looks at the floor
TWICE = 2  # readings in a row without a floor, so that one that is lost stops nobody
DROP = 0.03  # m by which a beam is longer where the floor has ended; it is more than a threshold and noise


class FloorSight(NamedTuple):
    """Where a beam meets the floor under the vehicle: x, y [m, base frame], and after how many metres."""

    place: tuple[float, float]
    length: float

    def has_ended(self, measured: float) -> bool:
        """Whether a measured range [m], 0 = no return, says that there is no floor."""
        return not 0.0 < measured <= self.length + DROP


def floor_sights(finders: Iterable[RangeFinder]) -> dict[str, FloorSight]:
    """By frame, those of the range finders that look down and reach the floor, z = 0 of the base frame."""
    found = {}
    for finder in finders:
        x, y, z = finder.mount.xyz
        ahead, left, up = rotate(from_euler(*finder.mount.rpy), np.array((1.0, 0.0, 0.0))).tolist()
        if -up >= DOWN and z > 0.0 and (length := z / -up) + DROP <= finder.range_max:
            found[finder.frame] = FloorSight((x + length * ahead, y + length * left), length)
    return found


class FloorWatch:
    """Which range finders, by their frames, see no floor."""

    def __init__(self, sights: Mapping[str, FloorSight]) -> None:
        self.sights = sights
        self._misses: dict[str, int] = {}

    def take(self, frame: str, measured: float) -> bool:
        """Takes a measured range [m], 0 = no return; whether it is of a range finder that looks at the floor."""
        sight = self.sights.get(frame)
        if sight is None:
            return False
        self._misses[frame] = self._misses.get(frame, 0) + 1 if sight.has_ended(measured) else 0
        return True

    def has_ended(self, frame: str) -> bool:
        """Whether the floor has ended where that one looks, by more than one reading."""
        return self._misses.get(frame, 0) >= TWICE
