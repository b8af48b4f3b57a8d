"""Where a group's new particles are drawn from: around the pose to which the sweep is matched, or where odometry leads.

Grisetti, Stachniss & Burgard, "Improved Techniques for Grid Mapping with Rao-Blackwellized Particle Filters" (2007), section III:
the proposal is a Gaussian about the match; a part is drawn by the motion model, so that a wrong match can be outlived.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2
from uvf.slam.localization.gaussian import drawn, inverse, log_density
from uvf.slam.localization.groups import ParticleGroup
from uvf.slam.localization.known_map import KnownMap
from uvf.slam.matching.branch_and_bound import Window, search
from uvf.slam.matching.cloud import Cloud
from uvf.slam.matching.imls import Match, match

Floats = NDArray[np.float64]

LEAST_SHARE, MOST_RMS = 0.35, 0.07
"""Of the sweep's points that have to find a surface, and m of their distance, for a match to be followed."""
HELD_SHARE = 0.15  # the same where the motion is known so well that the nearest surface is the right one
FITS = 0.6  # share from which on nothing better is looked for
SIDE, TURN, SIGMAS = 0.3, 0.2, 3.0
"""m, rad: where so many sigmas are more, a match may have begun too far off, and is looked for in as wide a window."""
SEARCHED, LEAST_SCORE = 90, 0.4  # points, mean likelihood
BETTER = 0.1  # share by which what is found there has to be better
FLOOR = np.diag((0.01, 0.01, 0.003)) ** 2
"""Covariance that no match is better than: maps are not exact [m^2, rad^2]."""
LEAST_SPREAD = np.diag((1e-3, 1e-3, 3e-4)) ** 2
BY_MOTION = 0.3  # part that is drawn by the motion model
FEWEST = 30  # particles of a group
MOST_UNEQUAL = 2.0  # mean square of weights that are 1 on average
WIDER = 4.0  # factor of the match's covariance, whose Gaussian has to cover the tails


@dataclass(frozen=True)
class PoseProposal:
    """Where new particles of a group are drawn from. group: after the motion; match: None where the sweep fits nowhere near.

    near: whether its particles stand for one place.
    """

    group: ParticleGroup
    match: Match | None
    near: bool = True

    @property
    def pose(self) -> Pose2:
        """Pose map_from_base of the match, or the group's mean without one."""
        return self.match.map_from_base if self.match else self.group.mean

    @cached_property
    def covariance(self) -> Floats:
        """Covariance (3, 3) of (x, y, yaw) of the pose [m, rad]."""
        predicted: Floats = self.group.covariance + LEAST_SPREAD
        if self.match is None:
            return predicted
        found: Floats = inverse(self.match.information + inverse(predicted)) + FLOOR
        return found

    def draw(self, n: int, moved: tuple[Floats, Floats], rng: np.random.Generator) -> tuple[Floats, Floats]:
        """n new particles: (poses (n, 3), log of prediction over proposal (n,)).

        moved: poses (m, 3) of all particles after the motion, and their weights (m,).
        """
        by_motion = int(np.ceil(BY_MOTION * n))
        poses = moved[0][resampled(self.group.members, moved[1][self.group.members], by_motion, rng)]
        wide = WIDER * self.covariance
        poses = np.concatenate((poses, drawn(np.array(self.pose), wide, rng.standard_normal((n - by_motion, 3)))))
        predicted = log_density(poses, np.array(self.group.mean), WIDER * (self.group.covariance + LEAST_SPREAD) + FLOOR)
        matched = log_density(poses, np.array(self.pose), wide)
        mixed = np.logaddexp(np.log(BY_MOTION) + predicted, np.log(1.0 - BY_MOTION) + matched)
        return poses, predicted - mixed

    def keep(self, part: float, moved: tuple[Floats, Floats], rng: np.random.Generator) -> tuple[Floats, Floats]:
        """The group's particles (k, 3) and the log of their weights (k,), which are 1 on average.

        They are resampled where few have most of the weight, or where only a ``part``, 0 to 1, of them is to be kept.
        moved: poses (m, 3) of all particles after the motion, and their weights (m,).
        """
        own = moved[1][self.group.members]
        weights = own * len(own) / own.sum()
        if part >= 1.0 and (weights**2).mean() < MOST_UNEQUAL and len(own) >= FEWEST:
            return moved[0][self.group.members], np.log(np.maximum(weights, 1e-300))
        n = max(int(part * len(own)), FEWEST)
        return moved[0][resampled(self.group.members, own, n, rng)], np.zeros(n)


def resampled(members: NDArray[np.int64], weights: Floats, n: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """n of the members (k,) drawn by their weights (k,), with low variance (Thrun et al. 2005, table 4.4)."""
    ends = np.cumsum(weights)
    places = (rng.random() + np.arange(n)) / n * ends[-1]
    found: NDArray[np.int64] = members[np.minimum(np.searchsorted(ends, places), len(members) - 1)]
    return found


def proposal(known: KnownMap, group: ParticleGroup, cloud: Cloud) -> PoseProposal:
    """Proposal for a group: the sweep matched to the map from the group's mean, or searched for around it where that fits badly."""
    if len(cloud.points) == 0:
        return PoseProposal(group, None)
    spread = group.covariance + LEAST_SPREAD
    prior = inverse(spread)
    found = match(group.mean, cloud, known.surfaces, prior)
    side, turn = _window(spread)
    held = side < SIDE and turn < TURN
    if (found.share < FITS or found.rms > MOST_RMS) and not held:
        place = _searched(known, cloud, Window(group.mean, side, turn))
        other = match(place, cloud, known.surfaces, 0.1 * prior) if place else found
        found = other if other.share > found.share + BETTER else found
    least = HELD_SHARE if held else LEAST_SHARE
    return PoseProposal(group, found if found.share >= least and found.rms <= MOST_RMS else None)


def _window(spread: Floats) -> tuple[float, float]:
    sigmas = SIGMAS * np.sqrt(np.diag(spread))
    return float(sigmas[:2].max()), float(sigmas[2])


def _searched(known: KnownMap, cloud: Cloud, window: Window) -> Pose2 | None:
    found = search(cloud.points[:: max(1, len(cloud.points) // SEARCHED)], known.field, window, LEAST_SCORE)
    return found.pose if found else None
