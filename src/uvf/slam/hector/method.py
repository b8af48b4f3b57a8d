"""Scan matching on a pyramid of occupancy grids, without odometry and without loops.

Kohlbrecher, von Stryk, Meyer & Klingauf, "A Flexible and Scalable SLAM System with Full 3D Motion Estimation" (2011): the part
in the plane. Each level is a map of its own that the beams are drawn into, no coarser copy of the finest one.
"""

from dataclasses import dataclass, field
from math import log

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.slam.hector.gradient import UNIT, climb, normal_equations
from uvf.slam.hector.params import HectorParams
from uvf.slam.incremental import IncrementalMethod
from uvf.slam.logs.jumps import step_between
from uvf.slam.maps.shared_tiles import SharedEvidence, SharedTiles
from uvf.slam.matching.points import points_of
from uvf.slam.method import Keyframe, SlamEstimate
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

POINTS = 360  # of a sweep that are matched, at most
LEAST_POINTS = 10
ROUNDS, FINEST_ROUNDS = 4, 6
"""Steps on each coarse map, and on the finest one."""
BOUND = 5.0
"""Log-odds that no cell goes beyond."""
SIGMA = 0.3
"""Of an occupancy that is looked up: the covariance is sigma^2 H^-1 (equation 14)."""
HOLD = (SIGMA / np.array((0.1, 0.1, 0.1))) ** 2
"""Weights of the guess, whose 1 sigma is 0.1 m and 0.1 rad."""
DOUBTED, TURNS = 0.7, (-0.48, -0.36, -0.24, -0.12, 0.12, 0.24, 0.36, 0.48)
"""Mean occupancy below which turned starts [rad] are tried, too."""
MEMORY = 300e6
"""Bytes that each level may take; of the finest one that is as much as 370 000 m^2 at 0.05 m."""
BETTER = 0.05
"""By which a turned start has to be better than a straight one."""
LEAST = 0.3
"""Mean occupancy at the points below which a match is not believed."""
NOTHING = np.diag((1.0, 1.0, 0.3)) ** 2
"""Covariance of a pose that nothing tells of."""


@dataclass
class HectorSlam(IncrementalMethod):
    """Scan matching on a pyramid of occupancy grids; see ``SlamMethod``."""

    params: HectorParams = field(default_factory=HectorParams)

    def __post_init__(self) -> None:
        super().__init__()
        p = self.params
        self.levels = [SharedTiles(1, np.int16, p.map_resolution * 2**level, MEMORY) for level in range(p.map_multi_res_levels)]
        bound = round(BOUND / UNIT)
        self._evidence = SharedEvidence(_units(p.update_factor_occupied), _units(p.update_factor_free), -bound, bound)
        self._last: Reading | None = None

    def add(self, reading: Reading) -> SlamEstimate:
        """Matches one reading to the maps, and draws it into them if the vehicle has moved enough."""
        last, self._last = self._last, reading
        if last is None:
            self._poses.append(IDENTITY)
            self._insert(reading)
            return SlamEstimate(IDENTITY, np.zeros((3, 3)), 1.0)
        guess = self._poses[-1]
        if self.params.use_odometry:
            guess = compose(guess, step_between(last, reading) or IDENTITY)
        estimate = self._best(guess, reading)
        self._poses.append(estimate.map_from_base)
        if self._has_moved(self.params.map_update_distance_thresh, self.params.map_update_angle_thresh):
            self._insert(reading)
        return estimate

    def _best(self, guess: Pose2, reading: Reading) -> SlamEstimate:
        """Of several starts: a lidar that is slow, or turned quickly, is farther away than a hill is wide."""
        found = self._matched(guess, reading)
        if self.params.use_odometry:
            return found
        if len(self._poses) > 1:
            found = max(found, self._matched(self._rolled_on(), reading), key=_quality)
        if found.quality >= DOUBTED:
            return found
        turned = max((self._matched(compose(guess, Pose2(0.0, 0.0, turn)), reading) for turn in TURNS), key=_quality)
        return turned if turned.quality > found.quality + BETTER else found

    def _matched(self, guess: Pose2, reading: Reading) -> SlamEstimate:
        """From the coarsest map, which sees far, to the finest, which sees sharply."""
        points = self._points(reading)
        if len(points) < LEAST_POINTS:
            return SlamEstimate(guess, NOTHING, 0.0)
        pose, begin = np.array(guess), np.array(guess)
        for level in reversed(self.levels):
            pose = climb(pose, points, level.grid(0), FINEST_ROUNDS if level is self.levels[0] else ROUNDS, (begin, HOLD))
        h, _, occupancy = normal_equations(pose, points, self.levels[0].grid(0))
        if not np.isfinite(pose).all() or occupancy < LEAST:
            return SlamEstimate(guess, NOTHING, 0.0)
        found = Pose2(float(pose[0]), float(pose[1]), wrap(float(pose[2])))
        information: Floats = h / SIGMA**2 + np.linalg.inv(NOTHING)
        return SlamEstimate(found, np.linalg.inv(information).astype(np.float64), float(occupancy))

    def _rolled_on(self) -> Pose2:
        """Where the vehicle is if it goes on as it went."""
        before, last = self._poses[-2:]
        return compose(last, compose(inverse(before), last))

    def _points(self, reading: Reading) -> Floats:
        points = points_of(reading, self.params.laser_max_dist, POINTS)
        ranges = np.hypot(*(points - np.array(reading.beams.origin)).T)
        used: Floats = points[ranges >= self.params.laser_min_dist]
        return used

    def _insert(self, reading: Reading) -> None:
        if reading.ranges.shape != reading.beams.bearings.shape:
            return
        for level in self.levels:
            level.draw(0, reading, self._poses[-1], self._evidence, self.params.laser_max_dist)
        self._keyframes.append(Keyframe(self._poses[-1], reading))


def _quality(estimate: SlamEstimate) -> float:
    return estimate.quality


def _units(probability: float) -> int:
    """What makes this of a cell of probability 0.5."""
    return round(log(probability / (1.0 - probability)) / UNIT)
