"""Places seen again: which old submap the newest keyframe fits into, if any."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, compose
from uvf.slam.graph.drift import Drift
from uvf.slam.graph.fitting import fitted, information_of
from uvf.slam.graph.nodes import KeyframeNodes, Submap
from uvf.slam.matching.branch_and_bound import Window, search
from uvf.slam.matching.cloud import Cloud

Floats = NDArray[np.float64]

SPACING = 6  # keyframes from one anchor to the next
LEAST_WAY = 12.0  # m of driving between two keyframes below which they tell nothing new of each other
VIEW = 2.5  # m from an anchor within which a keyframe sees enough of what the anchor has seen
SURE = 1.0  # m, radius of uncertainty up to which a keyframe is matched where it is believed to be
TRIES = 2  # anchors that are tried there

LEAST_SCORE = 0.5
DISTINCT = 0.93
"""A second place whose score comes as near to the best one's as that leaves it open which of them it is."""
QUERY_GRID, QUERY_RANGE = 0.1, 15.0
"""m between points and m of range of what is searched for."""


@dataclass(frozen=True)
class Closure:
    """A loop closure: keyframe j seen in the submap of i.

    information: (3, 3) of (x, y, yaw) of i_from_j [1/m^2, 1/rad^2]; score: 0..1.
    """

    i: int
    j: int
    i_from_j: Pose2
    information: Floats
    score: float


@dataclass(frozen=True)
class _Sought:
    """Keyframe k with its cloud, gathered once for all the places that it is compared with."""

    k: int
    cloud: Cloud

    @cached_property
    def thinned(self) -> Floats:
        """(n, 2) m, the points that a place is searched by."""
        points = self.cloud.points[np.hypot(*self.cloud.points.T) < QUERY_RANGE]
        _, first = np.unique(np.floor(points / QUERY_GRID).astype(np.int64), axis=0, return_index=True)
        kept: Floats = points[first]
        return kept


@dataclass
class LoopSearch:
    """Searches for loop closures; decides nothing of what becomes of them."""

    nodes: KeyframeNodes
    drift: Drift = field(default_factory=Drift)

    def near(self, k: int, ways: Floats) -> list[Closure]:
        """Closures of keyframe k at anchors that its path lengths ``ways`` (n,) [m] tie closely enough for a match at its believed pose."""
        found: list[Closure] = []
        sought, radius = _Sought(k, self.nodes.gathered(k)), self.drift.radius(ways)
        anchors = [a for a in self._anchors(k, radius) if radius[a] <= SURE]
        for a in sorted(anchors, key=lambda a: self._distance(a, k)):
            if len(found) >= TRIES or any(abs(a - c.i) < 4 * SPACING for c in found):
                continue
            closure = self._match(sought, self.nodes.submap(a), self.nodes.between(a, k), 1.0)
            if closure is None:
                closure = self._search(sought, a, Window(self.nodes.between(a, k), float(radius[a]), float(self.drift.turn(ways[a]))))
            if closure is not None:
                found.append(closure)
        return found

    def far(self, k: int, ways: Floats) -> Closure | None:
        """The closure of keyframe k anywhere within its uncertainty, by its path lengths ``ways`` (n,) [m] to all keyframes.

        None where nothing fits, or where two places fit.
        """
        sought, radius = _Sought(k, self.nodes.gathered(k)), self.drift.radius(ways)
        found: list[Closure] = []
        for a in self._anchors(k, radius):
            if radius[a] > SURE:
                centre = Pose2(0.0, 0.0, self.nodes.between(a, k).yaw)
                closure = self._search(sought, a, Window(centre, VIEW, float(self.drift.turn(ways[a]))))
                found += [closure] if closure else []
        if not found:
            return None
        best = max(found, key=lambda c: c.score)
        there = self._place(best)
        rivals = [c for c in found if _apart(self._place(c), there) and c.score > DISTINCT * best.score]
        return None if rivals else best

    def _place(self, closure: Closure) -> Pose2:
        return compose(self.nodes.poses[closure.i], closure.i_from_j)

    def _anchors(self, k: int, radius: Floats) -> list[int]:
        there = np.array([p[:2] for p in self.nodes.poses[: k + 1]])
        distance = np.hypot(*(there - there[k]).T)
        travelled = np.array([node.travelled for node in self.nodes.all[: k + 1]])
        fit = (distance < radius[: k + 1] + VIEW) & (travelled[k] - travelled > LEAST_WAY)
        return [a for a in range(SPACING, k, SPACING) if fit[a]]

    def _distance(self, a: int, k: int) -> float:
        p, q = self.nodes.poses[a], self.nodes.poses[k]
        return float(np.hypot(p[0] - q[0], p[1] - q[1]) + 0.5 * abs(wrap(p[2] - q[2])))

    def _search(self, sought: _Sought, a: int, window: Window) -> Closure | None:
        submap = self.nodes.submap(a)
        if len(submap.surfaces.points) == 0:
            return None
        found = search(sought.thinned, submap.field, window, LEAST_SCORE)
        return self._match(sought, submap, found.pose, found.score) if found else None

    def _match(self, sought: _Sought, submap: Submap, guess: Pose2, score: float) -> Closure | None:
        found = fitted(self.nodes.all[sought.k], sought.cloud, submap, self.nodes, guess)
        return Closure(submap.anchor, sought.k, found.map_from_base, information_of(found), score * found.share) if found else None


def _apart(p: Pose2, q: Pose2) -> bool:
    """Whether two poses are not the same place."""
    return bool(np.hypot(p[0] - q[0], p[1] - q[1]) > 1.0 or abs(wrap(p[2] - q[2])) > 0.3)
