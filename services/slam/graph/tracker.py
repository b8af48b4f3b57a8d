"""Where the vehicle is from sweep to sweep: each is matched to the surfaces of the last keyframes."""

from dataclasses import dataclass, field
from math import hypot

import numpy as np
from numpy.typing import NDArray

from services.slam.matching.branch_and_bound import Window, search
from services.slam.matching.cloud import Cloud
from services.slam.matching.imls import Match, match
from services.slam.matching.likelihood import LikelihoodField, likelihood_field
from services.slam.matching.point_map import PointMap
from uvf.maths.planar import IDENTITY, Pose2, compose
from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]

WELL, LOOSE = 0.75, 2.0
"""Part of the usual share and times the usual rms at which a match is doubted."""
USUAL_SHARE, USUAL_RMS, LEARNT = 0.7, 0.02, 0.02
"""What is usual at first, and how far each sweep moves it to its own."""
LOST = 0.4
"""Part of the usual share below which the odometry alone is believed."""
LEAP, LEAP_TURN = 0.3, 0.3  # m, rad: a match that moves the prediction by more is doubted
SIDE, TURN, SIGMAS = 0.35, 0.45, 3.0
"""m, rad: the window that is searched when a match is doubted, or so many sigmas of the odometry's step if these are more."""
FARTHEST = 0.15
"""m by which a typical point may be off by the odometry's step: beyond, the nearest surface may be the wrong one."""
LEAST_SCORE = 0.3
BETTER = 0.02
PER_RMS = 4.0
"""Share that 1 m of rms costs a match when two are compared."""
RESOLUTION, SIGMA, DEPTH = 0.05, 0.08, 3  # m, m, levels: of the field in which is searched
SEARCHED = 90  # points at most


@dataclass(frozen=True)
class MotionNoise:
    """1 sigma of a step of odometry: m and rad at once, per m driven and per rad turned."""

    position: tuple[float, float, float] = (0.005, 0.1, 0.03)
    heading: tuple[float, float, float] = (0.003, 0.02, 0.15)

    def sigmas(self, step: Pose2) -> tuple[float, float]:
        """m, rad."""
        way = np.array((1.0, hypot(step[0], step[1]), abs(step[2])))
        return float(way @ self.position), float(way @ self.heading)

    def information(self, step: Pose2) -> Floats:
        """(3, 3) of (x, y, yaw)."""
        position, heading = self.sigmas(step)
        return np.diag((position**-2, position**-2, heading**-2))


@dataclass(frozen=True)
class Motion:
    """From where the vehicle was (map_from_base), by the odometry; disputed: something tells that this is wrong."""

    before: Pose2
    step: Pose2
    noise: MotionNoise
    disputed: bool = False

    @property
    def guess(self) -> Pose2:
        return compose(self.before, self.step)

    @property
    def sigmas(self) -> tuple[float, float]:
        """m, rad."""
        return self.noise.sigmas(self.step)

    @property
    def information(self) -> Floats:
        """(3, 3) of (x, y, yaw)."""
        return self.noise.information(self.step)


UNKNOWN = MotionNoise((0.25, 0.1, 0.03), (0.25, 0.02, 0.15))
"""Of a step that the odometry has not told."""


@dataclass
class LocalMap:
    """Surfaces of the last keyframes in the map frame, and their likelihood field once it is needed."""

    surfaces: PointMap
    drawn: LikelihoodField | None = None

    @property
    def field(self) -> LikelihoodField:
        if self.drawn is None:
            self.drawn = likelihood_field(self.surfaces.points, RESOLUTION, SIGMA, DEPTH)
        return self.drawn


@dataclass(frozen=True)
class Tracked:
    """match: where the sweep has been taken; its share is 0 where the odometry alone has decided. doubted: it may be wrong."""

    match: Match
    doubted: bool


@dataclass
class Tracker:
    """Matches sweeps to local maps. searched counts those that had to be looked for, lost those that were not found."""

    noise: MotionNoise = field(default_factory=MotionNoise)
    searched: int = 0
    lost: int = 0
    share: float = USUAL_SHARE
    rms: float = USUAL_RMS

    def track(self, local: LocalMap, motion: Motion, cloud: Cloud) -> Tracked:
        """The pose (map_from_base) of a sweep.

        A step after which the sweep fits badly is none of the vehicle's if it fits well near where that was before.
        """
        found = self._found(local, motion, cloud)
        if motion.disputed or (motion.noise is not UNKNOWN and self._doubts(found)):
            other = self._found(local, Motion(motion.before, IDENTITY, UNKNOWN), cloud)
            if not self._doubts(other) and _worth(other) > _worth(found) + BETTER:
                found = other
        guess, doubted = motion.guess, self._doubts(found)
        self.share += LEARNT * (found.share - self.share)
        self.rms += LEARNT * (found.rms - self.rms)
        if found.share < LOST * self.share:
            self.lost += 1
            return Tracked(Match(guess, np.zeros((3, 3)), 0.0, found.rms), True)
        return Tracked(found, doubted)

    def _found(self, local: LocalMap, motion: Motion, cloud: Cloud) -> Match:
        found = match(motion.guess, cloud, local.surfaces, motion.information)
        if self._doubts(found) or _leaps(motion.guess, found.map_from_base) or _strays(motion, cloud):
            return self._searched(local, motion, cloud, found)
        return found

    def _doubts(self, found: Match) -> bool:
        return found.share < WELL * self.share or found.rms > LOOSE * self.rms

    def _searched(self, local: LocalMap, motion: Motion, cloud: Cloud, doubted: Match) -> Match:
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
        return other if _worth(other) > _worth(doubted) + BETTER else doubted


def _strays(motion: Motion, cloud: Cloud) -> bool:
    """Whether the step is too unsure for the surface nearest to a point to be its own."""
    position, heading = motion.sigmas
    return position + heading * _usual_range(cloud.points) > FARTHEST


def _usual_range(points: Floats) -> float:
    """m, median; 0 for no points."""
    middle = len(points) // 2
    return float(np.sqrt(np.partition(points[:, 0] ** 2 + points[:, 1] ** 2, middle)[middle])) if len(points) else 0.0


def _leaps(guess: Pose2, found: Pose2) -> bool:
    return hypot(found[0] - guess[0], found[1] - guess[1]) > LEAP or abs(wrap(found[2] - guess[2])) > LEAP_TURN


def _worth(found: Match) -> float:
    return found.share - PER_RMS * found.rms
