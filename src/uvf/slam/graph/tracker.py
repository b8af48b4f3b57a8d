"""Where the vehicle is from sweep to sweep: each is matched to the surfaces of the last keyframes."""

from dataclasses import dataclass, field
from functools import cached_property
from math import hypot

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import IDENTITY, Pose2
from uvf.slam.graph.motion import UNKNOWN, MotionNoise, OdometryMotion
from uvf.slam.graph.trust import LEARNT, Trust
from uvf.slam.matching.branch_and_bound import Window, search
from uvf.slam.matching.cloud import Cloud
from uvf.slam.matching.imls import Match, match
from uvf.slam.matching.likelihood import LikelihoodField, likelihood_field
from uvf.slam.matching.point_map import PointMap

Floats = NDArray[np.float64]

WELL, LOOSE = 0.75, 2.0
"""Part of the usual share and times the usual rms at which a match is doubted."""
USUAL_SHARE, USUAL_RMS = 0.7, 0.02
"""What is usual at first; each sweep moves it a little to its own."""
LOST = 0.4
"""Part of the usual share below which the odometry alone is believed."""
INCREDIBLE, FIRM = 8.0, 0.75
"""Surprise above which a match must have such a share: half a sweep fits into vegetation at many places."""
PLAIN_SHARE, PLAIN_RMS = 0.8, 0.025
"""Sweeps that fit better show how far the odometry is off; in vegetation and crowds it is the sweeps that are."""
HELD = 5.0
"""Sigmas of its motion beyond which no place is looked for where little is seen: the odometry says how it has moved, and people walk."""
LEAP, LEAP_TURN = 0.3, 0.3  # m, rad: a match that moves the prediction by more is doubted
SIDE, TURN, SIGMAS = 0.35, 0.45, 3.0
"""m, rad: the window that is searched when a match is doubted, or so many sigmas of the odometry's step if these are more."""
FARTHEST = 0.15
"""m by which a typical point may be off by the odometry's step: beyond, the nearest surface may be the wrong one."""
LEAST_SCORE = 0.3
BETTER = 0.02
PER_RMS, PER_SURPRISE = 4.0, 0.02
"""Share that 1 m of rms, and one of surprise at where it lies, costs a match when two are compared."""
RESOLUTION, SIGMA, DEPTH = 0.05, 0.08, 3  # m, m, levels: of the field in which is searched
SEARCHED = 90  # points at most


@dataclass
class LocalMap:
    """Surfaces of the last keyframes in the map frame, and their likelihood field once it is needed."""

    surfaces: PointMap

    @cached_property
    def field(self) -> LikelihoodField:
        """Likelihood field of its surfaces, in the map frame."""
        return likelihood_field(self.surfaces.points, RESOLUTION, SIGMA, DEPTH)


@dataclass(frozen=True)
class Tracked:
    """Outcome of tracking one sweep. match: its share is 0 where the odometry alone has decided; doubted: it may be wrong."""

    match: Match
    doubted: bool


@dataclass
class Tracker:
    """Matches sweeps to local maps. ``searched`` counts those that had to be looked for, ``lost`` those that were not found."""

    noise: MotionNoise = field(default_factory=MotionNoise)
    trust: Trust = field(default_factory=Trust)
    searched: int = 0
    lost: int = 0
    share: float = USUAL_SHARE
    rms: float = USUAL_RMS

    def track(self, local: LocalMap, motion: OdometryMotion, cloud: Cloud) -> Tracked:
        """Pose (map_from_base) of a sweep, by its cloud in the base frame and the odometry's motion.

        When the sweep fits badly after the step but well near the pose before it, the step is taken for wrong.
        """
        step, motion = motion.step, self.trust.straightened(motion)
        if cloud.is_scant and motion.told:
            return Tracked(Match(motion.guess, np.zeros((3, 3)), 0.0, self.rms), True)
        found = self._found(local, motion, cloud)
        if motion.disputed or (motion.told and self._doubts(found)):
            other = self._found(local, OdometryMotion(motion.before, IDENTITY, UNKNOWN), cloud)
            wins = _is_better(other, found) if motion.disputed else self._wins((motion, cloud), other, found)
            if wins and not self._doubts(other):
                found = other
        doubted = self._doubts(found)
        self._learn(step, motion, found)
        if found.share < LOST * self.share:
            self.lost += 1
            return Tracked(Match(motion.guess, np.zeros((3, 3)), 0.0, found.rms), True)
        return Tracked(found, doubted)

    def _learn(self, step: Pose2, motion: OdometryMotion, found: Match) -> None:
        self.share += LEARNT * (found.share - self.share)
        self.rms += LEARNT * (found.rms - self.rms)
        if motion.told and _plain(found):
            self.trust.learn(step, motion, found.map_from_base)

    def _found(self, local: LocalMap, motion: OdometryMotion, cloud: Cloud) -> Match:
        known = self.trust.information(motion) if cloud.is_thin else self._with_claimed_heading(motion)
        found = match(motion.guess, cloud, local.surfaces, known)
        if motion.told and not cloud.is_thin and not _plain(found):
            found = match(motion.guess, cloud, local.surfaces, self.trust.information(motion))
        if self._doubts(found) or _leaps(motion.guess, found.map_from_base) or _strays(motion, cloud):
            return self._searched(local, motion, cloud, found)
        return found

    def _with_claimed_heading(self, motion: OdometryMotion) -> Floats:
        """Information (3, 3) of a motion [1/m^2, 1/rad^2]: wheels slip, but a gyro knows its turn better than a sweep tells it."""
        usual = motion.information
        return usual if motion.claimed is None else np.maximum(usual, np.diag((0.0, 0.0, self.trust.information(motion)[2, 2])))

    def _doubts(self, found: Match) -> bool:
        return found.share < WELL * self.share or found.rms > LOOSE * self.rms

    def _searched(self, local: LocalMap, motion: OdometryMotion, cloud: Cloud, doubted: Match) -> Match:
        self.searched += 1
        points = cloud.points[:: max(1, len(cloud.points) // SEARCHED)]
        if len(local.surfaces.points) == 0:
            return doubted
        position, heading = motion.sigmas
        window = Window(motion.guess, max(SIDE, SIGMAS * position), max(TURN, SIGMAS * heading))
        place = search(points, local.field, window, LEAST_SCORE)
        if place is None:
            return doubted
        other = match(place.pose, cloud, local.surfaces, 0.1 * motion.information)
        return other if self._wins((motion, cloud), other, doubted) else doubted

    def _wins(self, seen: tuple[OdometryMotion, Cloud], other: Match, found: Match) -> bool:
        """Whether the other one fits better by more than where it lies surprises."""
        motion, cloud = seen
        if cloud.is_thin and motion.claimed is not None and self.trust.sigmas_off(motion, other.map_from_base) > HELD:
            return False
        surprise = self.trust.surprise(motion, other.map_from_base)
        if surprise > INCREDIBLE and other.share < FIRM:
            return False
        more = surprise - self.trust.surprise(motion, found.map_from_base)
        return _is_better(other, found, PER_SURPRISE * more)


def _strays(motion: OdometryMotion, cloud: Cloud) -> bool:
    """Whether the step is too unsure for the surface nearest to a point to be its own."""
    position, heading = motion.sigmas
    return position + heading * _usual_range(cloud.points) > FARTHEST


def _usual_range(points: Floats) -> float:
    """m, median; 0 for no points."""
    middle = len(points) // 2
    return float(np.sqrt(np.partition(points[:, 0] ** 2 + points[:, 1] ** 2, middle)[middle])) if len(points) else 0.0


def _leaps(guess: Pose2, found: Pose2) -> bool:
    return hypot(found[0] - guess[0], found[1] - guess[1]) > LEAP or abs(wrap(found[2] - guess[2])) > LEAP_TURN


def _plain(found: Match) -> bool:
    return found.share > PLAIN_SHARE and found.rms < PLAIN_RMS


def _is_better(other: Match, found: Match, handicap: float = 0.0) -> bool:
    """Whether the other one fits better, by a share of more than what it is handicapped by."""
    return other.share - PER_RMS * other.rms > found.share - PER_RMS * found.rms + BETTER + handicap
