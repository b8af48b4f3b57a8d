"""Keyframes of the graph: what was seen from each, and small maps of some that follow one another."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.maths.se2_arrays import wrapped
from uvf.slam.matching.cloud import Cloud, joined
from uvf.slam.matching.likelihood import LikelihoodField, likelihood_field
from uvf.slam.matching.point_map import PointMap, point_map
from uvf.slam.matching.visibility import Rays, rays_of, verdicts
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

HALF = 6
"""Keyframes of a submap to either side of its anchor."""
LOOKED = 8
"""Keyframes before one of which every second tells which of its points have moved, as it tells them."""
GATHERED = 12
"""Keyframes before one of which little came back that are seen along with it."""
MOVED, TURNED = 0.01, 0.003
"""m, rad: a submap is drawn anew when one of its keyframes has moved by more against its anchor."""

RESOLUTION, SIGMA, DEPTH = 0.1, 0.1, 4
"""Of the field in which a place is searched: m, m, levels of bounds."""


@dataclass(frozen=True)
class Node:
    """A keyframe. cloud: in the base frame; travelled [m], turned [rad]: the way to it by odometry."""

    reading: Reading
    cloud: Cloud
    travelled: float
    turned: float

    @cached_property
    def rays(self) -> Rays:
        """The beams of its sweep, sorted by bearing."""
        return rays_of(self.reading)


@dataclass
class Submap:
    """Keyframes around an anchor and their surfaces, in the anchor's frame."""

    anchor: int
    members: range
    anchor_from_member: list[Pose2]
    surfaces: PointMap

    @cached_property
    def field(self) -> LikelihoodField:
        """Likelihood field of its surfaces, in the anchor's frame."""
        return likelihood_field(self.surfaces.points, RESOLUTION, SIGMA, DEPTH)


class KeyframeNodes:
    """All keyframes with their poses as known now (map_from_node), and the submaps made of them."""

    def __init__(self) -> None:
        self.all: list[Node] = []
        self.poses: list[Pose2] = []
        self._submaps: dict[int, Submap] = {}
        self._seen: list[NDArray[np.int8]] = []

    def __len__(self) -> int:
        return len(self.all)

    def add(self, node: Node, map_from_node: Pose2) -> int:
        """Adds a keyframe; returns its number."""
        k = len(self.all)
        self.all.append(node)
        self.poses.append(map_from_node)
        self._seen.append(np.zeros(len(node.cloud.points), dtype=np.int8))
        for i in range(k - 1, max(0, k - LOOKED) - 1, -2):
            self._compare(i, k)
            self._compare(k, i)
        return k

    def _compare(self, i: int, j: int) -> None:
        """Counts for the points of j whether i sees them or looks through them."""
        self._seen[j] += verdicts(self.all[j].cloud.points, self.between(i, j), self.all[i].rays)

    def still(self, i: int) -> Cloud:
        """Cloud of a keyframe without moving things: without points that more of its neighbours look through than see."""
        return self.all[i].cloud.chosen(self._seen[i] >= 0)

    def gathered(self, k: int) -> Cloud:
        """Cloud of a keyframe in its own frame; where little of it came back, along with that of those before it, for a few posts in
        view tell no heading."""
        cloud = self.all[k].cloud
        if not cloud.is_scant:
            return cloud
        before = [self.still(i).moved(self.between(k, i)) for i in range(max(0, k - GATHERED), k)]
        return joined([*before, cloud])

    def nearest(self, map_from_base: Pose2) -> int:
        """Number of the keyframe taken nearest to a pose; half a metre counts as much as a radian."""
        poses = np.array(self.poses)
        turn = np.abs(wrapped(poses[:, 2] - map_from_base.yaw))
        return int(np.argmin(np.hypot(poses[:, 0] - map_from_base.x, poses[:, 1] - map_from_base.y) + 0.5 * turn))

    def surfaces(self, members: range) -> PointMap:
        """Surfaces of some keyframes, in the map frame."""
        return point_map([self.still(i).moved(self.poses[i]) for i in members])

    def between(self, i: int, j: int) -> Pose2:
        """Pose i_from_j by the poses known now."""
        return compose(inverse(self.poses[i]), self.poses[j])

    def submap(self, anchor: int) -> Submap:
        """Submap around a keyframe; it is made anew when its keyframes have moved relative to each other."""
        members = range(max(0, anchor - HALF), min(len(self.all), anchor + HALF + 1))
        now = [self.between(anchor, i) for i in members]
        kept = self._submaps.get(anchor)
        if kept is None or kept.members != members or _differ(kept.anchor_from_member, now):
            clouds = [self.still(i).moved(pose) for i, pose in zip(members, now, strict=True)]
            kept = self._submaps[anchor] = Submap(anchor, members, now, point_map(clouds))
        return kept


def _differ(before: list[Pose2], now: list[Pose2]) -> bool:
    return any(
        abs(p[0] - q[0]) > MOVED or abs(p[1] - q[1]) > MOVED or abs(wrap(p[2] - q[2])) > TURNED for p, q in zip(before, now, strict=True)
    )
