"""The odometry's steps made better by what was seen on the last metres: it leads on where the map knows nothing."""

from collections import deque
from dataclasses import dataclass
from math import hypot

from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.slam.graph.motion import OdometryMotion
from uvf.slam.graph.tracker import LocalMap, Tracker
from uvf.slam.matching.cloud import Cloud
from uvf.slam.matching.point_map import point_map

KEPT = 12  # sweeps
SPACING, SPACING_TURN = 0.35, 0.2  # m, rad between them


@dataclass(frozen=True)
class Moved:
    """Motion since the last sweep. matched: whether sweeps confirm it; fits: how well compared with what is usual, 0 to 1 and above."""

    step: Pose2
    matched: bool
    fits: float


class RecentSweeps:
    """Matches sweeps to the last ones before them, in a local frame that drifts."""

    def __init__(self) -> None:
        self._tracker = Tracker()
        self._kept: deque[tuple[Pose2, Cloud]] = deque(maxlen=KEPT)
        self._local: LocalMap | None = None
        self.pose = IDENTITY
        """local_from_base."""

    def add(self, cloud: Cloud, step: Pose2) -> Moved:
        """Matches a sweep, starting from the odometry's ``step``; returns the improved motion."""
        before = self.pose
        if not self._kept:
            self._keep(cloud)
            return Moved(step, False, 1.0)
        usual = self._tracker.share
        self._local = self._local or LocalMap(point_map([c.moved(pose) for pose, c in self._kept]))
        tracked = self._tracker.track(self._local, OdometryMotion(before, step, self._tracker.noise), cloud)
        lost = tracked.match.share == 0.0
        self.pose = tracked.match.map_from_base
        if lost:
            self._kept.clear()
        self._keep(cloud)
        return Moved(compose(inverse(before), self.pose), not tracked.doubted, tracked.match.share / max(usual, 1e-3))

    def follow(self, cloud: Cloud, step: Pose2) -> Moved:
        """Takes in a sweep after a ``step`` that is known already."""
        self.pose = compose(self.pose, step)
        self._keep(cloud)
        return Moved(step, True, 1.0)

    def _keep(self, cloud: Cloud) -> None:
        """What is needed no sooner than that the vehicle has moved on."""
        if self._kept:
            since = compose(inverse(self._kept[-1][0]), self.pose)
            if hypot(since.x, since.y) <= SPACING and abs(since.yaw) <= SPACING_TURN:
                return
        self._kept.append((self.pose, cloud))
        self._local = None
