"""Monte Carlo localization with as many particles as are needed, drawn around matched sweeps, in hypotheses of their own.

Particles that stand for the same place are a group; each group keeps its weight until sweeps tell against it, however few
particles it has: hypotheses that fit equally well are not lost by chance (Milstein et al. 2002).
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import IDENTITY, Pose2
from uvf.maths.se2_arrays import wrapped
from uvf.slam.localization.beams import BeamLikelihood, field_of, fits_at, scores, ways
from uvf.slam.localization.fit import Fit
from uvf.slam.localization.gaussian import drawn
from uvf.slam.localization.groups import LEAST_WEIGHT, ParticleGroup, groups_of
from uvf.slam.localization.kld import bins_of, enough
from uvf.slam.localization.known_map import KnownMap
from uvf.slam.localization.motion import OdometryNoise, sample_motion
from uvf.slam.localization.proposals import FITS, PoseProposal, proposal
from uvf.slam.matching.cloud import Cloud
from uvf.slam.matching.imls import Match

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

MOST_GROUPS = 12
LEAST_PART = 0.04  # of the particles, for each group
FIRST = 100  # particles drawn before they are counted
IN_GROUP = 60  # particles of a hypothesis that is put in


@dataclass(frozen=True)
class Hypothesis:
    """A pose that the vehicle may have. weight: 0..1 of all; fit: of the newest sweep."""

    pose: Pose2
    covariance: Floats
    weight: float
    fit: Fit
    matched: bool


@dataclass(frozen=True)
class FilterSweep:
    """A sweep: cloud for matching, beams for weighing, both in the base frame. news: how much new it tells, 0 to 1."""

    cloud: Cloud
    beams: BeamLikelihood
    news: float


class Prediction(NamedTuple):
    """Poses (n, 3) of all particles after the motion, and a proposal for each of their groups, the heaviest first, and for the rest."""

    poses: Floats
    proposals: list[PoseProposal]

    @property
    def only(self) -> PoseProposal | None:
        """The proposal of the only place that the particles stand for; None while there are several."""
        return self.proposals[0] if len(self.proposals) == 1 and self.proposals[0].near else None

    def instead(self, other: Match | None) -> "Prediction":
        """The prediction with another match of the heaviest group."""
        return self._replace(proposals=[replace(self.proposals[0], match=other), *self.proposals[1:]])


class _Drawn(NamedTuple):
    """poses: (n, 3); logs: (n,) of prediction over proposal; of: (n,) which proposal."""

    poses: Floats
    logs: Floats
    of: NDArray[np.int64]


class ParticleFilter:
    """Particles: poses map_from_base (n, 3) [m, m, rad] and weights (n,), of sum 1."""

    def __init__(self, known: KnownMap, limits: tuple[int, int], rng: np.random.Generator) -> None:
        """limits: fewest and most particles."""
        self.known, self.limits = known, limits
        self._rng = rng
        self._field = field_of(known)
        self._places = known.places
        self.poses, self.weights = np.zeros((1, 3)), np.ones(1)

    def begin_at(self, pose: Pose2, covariance: Floats) -> None:
        """Draws all particles around one pose, with a covariance (3, 3) of (x, y, yaw) [m, rad]."""
        self.poses = self._around(pose, covariance, self.limits[0])
        self.weights = np.full(self.limits[0], 1.0 / self.limits[0])

    def begin_anywhere(self) -> None:
        """Draws as many particles as there may be, wherever a vehicle can stand."""
        n = self.limits[1]
        places = self._places[self._rng.integers(len(self._places), size=n)]
        jitter = (self._rng.random((n, 2)) - 0.5) * self.known.grid.resolution
        self.poses = np.column_stack((places + jitter, self._rng.uniform(-np.pi, np.pi, n)))
        self.weights = np.full(n, 1.0 / n)

    def put_in(self, poses: list[Pose2], covariance: Floats, part: float) -> None:
        """Adds hypotheses at ``poses`` with a covariance (3, 3) of (x, y, yaw) [m, rad]; ``part``, 0 to 1, is their weight together."""
        if not poses:
            return
        fresh = [self._around(pose, covariance, IN_GROUP) for pose in poses]
        n = len(poses) * IN_GROUP
        self.poses = np.concatenate((self.poses, *fresh))
        self.weights = np.concatenate((self.weights * (1.0 - part), np.full(n, part / n)))

    def predict(self, step: Pose2, noise: OdometryNoise, sweep: FilterSweep) -> Prediction:
        """Moves all particles by a step and proposes where the sweep fits there. Nothing is changed yet."""
        moved = sample_motion(self.poses, step, noise, self._rng)
        groups, loose = groups_of(moved, self.weights, MOST_GROUPS)
        proposals = [self._agreeing(proposal(self.known, group, sweep.cloud), sweep.beams) for group in groups]
        rest = float(self.weights[loose].sum())
        if rest > LEAST_WEIGHT:
            proposals.append(PoseProposal(ParticleGroup(loose, rest, IDENTITY, np.eye(3)), None, near=False))
        return Prediction(moved, proposals)

    def _agreeing(self, found: PoseProposal, beams: BeamLikelihood) -> PoseProposal:
        """Without its match where the rest of the sweep contradicts it."""
        if found.match is None or found.match.share >= FITS:
            return found
        at = fits_at(np.array([found.pose]), beams, self._field)
        return found if at.fits[0] > at.against[0] else replace(found, match=None)

    def correct(self, prediction: Prediction, sweep: FilterSweep) -> list[Hypothesis]:
        """Draws and weighs new particles by a prediction and its sweep; returns the hypotheses, the heaviest first."""
        proposals = prediction.proposals
        places = np.array([p.pose for p in proposals])
        blocked = ways(places, sweep.beams, self._field)
        totals = self._weigh(proposals, self._drawn(proposals, prediction.poses), sweep, blocked)
        found = scores(places, sweep.beams, self._field, blocked, np.arange(len(places)))
        hypotheses = [
            Hypothesis(p.pose, p.covariance, float(weight), Fit(float(on_walls), float(against)), p.match is not None)
            for p, weight, on_walls, against in zip(proposals, totals, found.fits, found.against, strict=True)
            if p.near
        ]
        return sorted(hypotheses, key=lambda h: -h.weight)

    def _drawn(self, proposals: list[PoseProposal], moved: Floats) -> _Drawn:
        """New particles around what has been matched, until there are enough for the bins they are in; the others go on, those that
        are put in on top of the most that there may be."""
        before = (moved, self.weights)
        crowd = sum(len(p.group.members) for p in proposals if p.match is None)
        part = min(1.0, (self.limits[1] + MOST_GROUPS * IN_GROUP) / max(crowd, 1))
        unmatched = [(k, p.keep(part, before, self._rng)) for k, p in enumerate(proposals) if p.match is None]
        kept = [_Drawn(*particles, np.full(len(particles[0]), k)) for k, particles in unmatched]
        matched = [(k, p) for k, p in enumerate(proposals) if p.match is not None]
        parts = np.maximum([p.group.weight for _, p in matched], LEAST_PART)
        parts /= parts.sum()
        found: list[_Drawn] = []
        n, wanted = 0, min(FIRST, self.limits[0])
        while matched and n < wanted:
            for (k, p), part in zip(matched, parts, strict=True):
                count = int(np.ceil((wanted - n) * part))
                found.append(_Drawn(*p.draw(count, before, self._rng), np.full(count, k)))
                n += count
            wanted = int(np.clip(enough(bins_of(np.concatenate([d.poses for d in found]))), *self.limits))
        return _Drawn(*(np.concatenate(column) for column in zip(*kept, *found, strict=True)))

    def _weigh(self, proposals: list[PoseProposal], fresh: _Drawn, sweep: FilterSweep, blocked: Mask) -> Floats:
        """Puts the new particles in force; the weight of each proposal's.

        blocked: where beams go through walls, seen from the places of the proposals: particles about a match see them so, too.
        Groups that the sweep cannot be matched to keep their inner weights: it does not tell where in them the vehicle is.
        """
        follows = np.array([p.match is None for p in proposals])
        logs = scores(fresh.poses, sweep.beams, self._field, blocked, np.where(follows[fresh.of], -1, fresh.of)).logs * sweep.news
        top = float(logs.max())
        weights, totals = np.empty(len(logs)), np.zeros(len(proposals))
        for k, p in enumerate(proposals):
            own = fresh.of == k
            both = logs[own] + fresh.logs[own]
            totals[k] = p.group.weight * np.exp(both - top).mean()
            inner = fresh.logs[own] if p.match is None and p.near else both
            inner = np.exp(inner - inner.max())
            weights[own] = inner / inner.sum() * totals[k]
        self.poses, self.weights = fresh.poses, weights / weights.sum()
        shares: Floats = totals / totals.sum()
        return shares

    def spread(self) -> Floats:
        """Covariance (3, 3) of (x, y, yaw) of all particles [m, rad]."""
        off = self.poses - self.poses[int(np.argmax(self.weights))]
        off[:, 2] = wrapped(off[:, 2])  # about one of them: a mean of yaws near +-pi would lie opposite of all
        off = off - self.weights @ off
        covariance: Floats = (self.weights[:, None] * off).T @ off
        return covariance

    def _around(self, pose: Pose2, covariance: Floats, n: int) -> Floats:
        return drawn(np.array(pose), covariance, self._rng.standard_normal((n, 3)))
