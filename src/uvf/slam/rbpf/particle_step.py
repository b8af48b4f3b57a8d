"""What a sweep makes of one particle: a match to its map, a new pose, and a factor of its weight."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.slam.rbpf.fit import Gaussian, Sweep, climb, log_likelihood
from uvf.slam.rbpf.params import RbpfParams
from uvf.slam.rbpf.proposal import proposal
from uvf.slam.rbpf.surfaces import ParticleMap

Floats = NDArray[np.float64]

WORTH = 1.0
"""Independent beams that one is worth: its neighbours see the same surface, and what is wrong with the map is wrong for all of them."""
LEAST_POINTS, LEAST_SHARE = 10, 0.2
"""Points with a surface, and their part of all, from which on a match is one."""


@dataclass(frozen=True)
class Matched:
    """A match: pose map_from_base (3,) [m, m, rad]; h: normal matrix (3, 3) of the points; share of them on a surface, 0..1.

    found: whether this is to be believed.
    """

    pose: Floats
    h: Floats
    share: float
    found: bool

    def covariance(self, prior: Gaussian, params: RbpfParams) -> Floats:
        """Covariance (3, 3) [m, rad] by the sweep and the odometry together."""
        information: Floats = prior[1] + (self.h / params.sigma**2 * WORTH if self.found else 0.0)
        covariance: Floats = np.linalg.inv(information).astype(np.float64)
        return covariance


def match(start: Floats, sweep: Sweep, maps: ParticleMap, prior: Gaussian, params: RbpfParams) -> Matched:
    """Best pose near ``start`` (3,) [m, m, rad]: step 1 of the paper's algorithm."""
    pose, h, found, score = climb(start, sweep, maps, prior, (params.sigma, WORTH))
    share = found / max(len(sweep[0]), 1)
    good = found >= LEAST_POINTS and share >= LEAST_SHARE and score >= params.minimumScore and bool(np.isfinite(pose).all())
    return Matched(pose if good else start, h, share, good)


def draw_pose(
    matched: Matched, sweep: Sweep, maps: ParticleMap, prior: Gaussian, params: RbpfParams, rng: np.random.Generator
) -> tuple[Floats, float]:
    """(pose map_from_base (3,) [m, m, rad], log of the factor of its weight [-]), drawn from the proposal.

    Where nothing matches it is drawn from the motion model.
    """
    target = (sweep, maps, params.lsigma, WORTH)
    if matched.found:
        proposed = proposal(matched.pose, matched.h, prior, target, rng)
        root = np.linalg.cholesky(proposed.covariance)
        return proposed.mean + root @ rng.standard_normal(3), proposed.log_weight / params.ogain
    pose = prior[0] + np.linalg.cholesky(np.linalg.inv(prior[1])) @ rng.standard_normal(3)
    return pose, log_likelihood(pose, sweep, maps, params.lsigma) * WORTH / params.ogain
