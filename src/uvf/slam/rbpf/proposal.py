"""The improved proposal: a Gaussian about the pose that the sweep and the odometry agree on.

Grisetti, Stachniss & Burgard, "Improved Techniques for Grid Mapping with Rao-Blackwellized Particle Filters" (2007), section III.B.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.rbpf.fit import Gaussian, Sweep, log_likelihood
from uvf.slam.rbpf.surfaces import ParticleMap

Floats = NDArray[np.float64]

Target = tuple[Sweep, ParticleMap, float, float]

SAMPLES = 16
WIDER = 1.5
"""How much wider than the Gaussian expected the samples are spread: what is sampled must cover what is sought."""
FLOOR = (1e-3, 1e-3, 1e-3)
"""m, m, rad: 1 sigma that the proposal has at least."""


@dataclass(frozen=True)
class ProposalDistribution:
    """A Gaussian: mean (3,) and covariance (3, 3) of (x, y, yaw) [m, rad]; log_weight: ln of eta, by which the particle's weight grows."""

    mean: Floats
    covariance: Floats
    log_weight: float


@compiled
def weighed(offsets: Floats, normals: Floats, matched: Floats, prior: Gaussian, target: Target) -> tuple[Floats, Floats, float]:
    """(mean (3,), covariance (3, 3), ln eta [-]) of equations 16 to 19, from samples ``matched`` (3,) + ``offsets`` (K, 3).

    The paper draws the samples x_j evenly; here they are drawn from a Gaussian q, ``normals`` (K, 3) being their places in its
    unit sphere, and each counts p(z | m, x_j) p(x_j | x_t-1, u) / q(x_j). So eta is the same integral, found with fewer samples.
    target: sweep, map, sigma of a beam [m], and how many independent beams a point is worth.
    """
    sweep, maps, sigma, worth = target
    k = offsets.shape[0]
    logs = np.empty(k)
    for j in range(k):
        pose = matched + offsets[j]
        away = pose - prior[0]
        away[2] = (away[2] + np.pi) % (2.0 * np.pi) - np.pi
        logs[j] = worth * log_likelihood(pose, sweep, maps, sigma) - 0.5 * away @ (prior[1] @ away) + 0.5 * normals[j] @ normals[j]
    most = logs.max()
    parts = np.exp(logs - most)
    total = parts.sum()
    mean, covariance = np.zeros(3), np.zeros((3, 3))
    for j in range(k):
        mean += parts[j] / total * offsets[j]
    for j in range(k):
        d = offsets[j] - mean
        covariance += parts[j] / total * np.outer(d, d)
    return matched + mean, covariance, most + np.log(total / k)


def proposal(matched: Floats, h: Floats, prior: Gaussian, target: Target, rng: np.random.Generator) -> ProposalDistribution:
    """Proposal about a matched pose (3,), where the points of the sweep have the normal matrix ``h`` (3, 3). prior: the motion model."""
    _, _, sigma, worth = target
    spread = WIDER**2 * np.linalg.inv(worth * h / sigma**2 + prior[1])
    normals = rng.standard_normal((SAMPLES, 3))
    root = np.linalg.cholesky(spread)
    mean, covariance, log_weight = weighed(normals @ root.T, normals, matched, prior, target)
    log_density = float(np.log(np.diag(root)).sum() - 0.5 * np.linalg.slogdet(np.linalg.inv(prior[1]))[1])
    return ProposalDistribution(mean, covariance + np.diag(FLOOR) ** 2, log_weight + log_density)
