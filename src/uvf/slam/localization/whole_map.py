"""All places in a whole map where what was seen fits, by branch and bound over every pose on free floor."""

from collections import deque
from math import hypot

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2, compose, inverse, transform
from uvf.slam.localization.groups import near
from uvf.slam.localization.known_map import KnownMap
from uvf.slam.matching.branch_and_bound import Found
from uvf.slam.matching.everywhere import Floor, all_turns, everywhere

Floats = NDArray[np.float64]

RIVAL = 0.8  # part of the best score that another place has to reach
LEAST = 0.3  # score

KEPT_WAY, SPACING, SPACING_TURN = 2.5, 0.2, 0.2  # m of way, m and rad between sweeps of what was seen lately
MOST_KEPT = 60  # sweeps: who turns on the spot makes no way
GRID, POINTS, REACH = 0.1, 160, 20.0  # m between points, number of them, m


class Lately:
    """Points seen on the last metres of the way, put together by odometry alone."""

    def __init__(self) -> None:
        self._seen: deque[tuple[float, Pose2, Floats]] = deque(maxlen=MOST_KEPT)
        self.way = 0.0
        self._last: Pose2 | None = None

    def add(self, odom_from_base: Pose2, points: Floats) -> None:
        """Adds the points (n, 2) [m, base frame] of a sweep."""
        if self._last is not None:
            self.way += hypot(odom_from_base.x - self._last.x, odom_from_base.y - self._last.y)
        self._last = odom_from_base
        if self._seen and near(self._seen[-1][1], odom_from_base, SPACING, SPACING_TURN):
            return
        self._seen.append((self.way, odom_from_base, points))
        while self.way - self._seen[0][0] > KEPT_WAY:
            self._seen.popleft()

    def __len__(self) -> int:
        """Sweeps that are kept."""
        return len(self._seen)

    def forget(self) -> None:
        """Drops all points."""
        self._seen.clear()

    def points(self) -> Floats:
        """Points (n, 2) [m] in the base frame of now, thinned."""
        if self._last is None or not self._seen:
            return np.zeros((0, 2))
        base_from_odom = inverse(self._last)
        whole = np.concatenate([transform(compose(base_from_odom, pose), points) for _, pose, points in self._seen])
        whole = whole[np.hypot(*whole.T) < REACH]
        _, first = np.unique(np.floor(whole / GRID).astype(np.int64), axis=0, return_index=True)
        thinned: Floats = whole[np.sort(first)]
        return thinned[:: max(1, len(thinned) // POINTS)]


def whole_map(known: KnownMap, points: Floats, most: int) -> list[Found]:
    """At most ``most`` places of the map where points (n, 2) [m, base frame] fit best, no two of them the same, the best first."""
    return everywhere(points, all_turns(points, known.field.sigma), known.field, Floor(known.floor, LEAST, RIVAL, most))
