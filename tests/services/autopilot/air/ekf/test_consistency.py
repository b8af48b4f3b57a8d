"""The filter knows how wrong it is: over twenty seeds its errors are as large as its covariance says, and so are its innovations."""

import functools

import numpy as np
import pytest
from scipy.stats import chi2

from tests.services.autopilot.air.ekf.flying import Flown, fly

SEEDS = range(20)
SECONDS = 8.0
SETTLED = 4.0  # s
PARTS = {"tilt": (0, 3), "velocity": (3, 6), "position": (6, 9), "gyro bias": (9, 12), "accel bias": (12, 15), "iron": (15, 18)}


@functools.cache
def flights():
    """Errors (20, 25), covariances (20, 25, 25) at the end, and mean innovations (20, 6), normalised and squared."""
    errors, covariances, innovations = [], [], []
    for seed in SEEDS:
        flown, seen = Flown(seed=seed), []

        def each(flown, now, seen=seen):
            if flown.k * 0.01 > SETTLED:
                r = now.ratios
                seen.append((r.position, r.velocity, r.airspeed, r.field))

        estimator = fly(flown, SECONDS, each)
        errors.append(flown.errors(estimator))
        covariances.append(estimator._aiding.filter.p)
        innovations.append(25.0 * np.mean(seen, axis=0))
    return np.array(errors), np.array(covariances), np.mean(innovations, axis=0)


@pytest.mark.parametrize("part", PARTS)
def test_the_errors_are_as_large_as_the_covariance_says(part):
    errors, covariances, _ = flights()
    k = slice(*PARTS[part])
    nees = [e[k] @ np.linalg.solve(p[k, k], e[k]) for e, p in zip(errors, covariances, strict=True)]
    low, high = chi2.ppf((0.005, 0.995), 3 * len(SEEDS))
    assert low < sum(nees) < high


def test_all_states_together_are_not_believed_too_well():
    errors, covariances, _ = flights()
    nees = [e[:20] @ np.linalg.solve(p[:20, :20], e[:20]) for e, p in zip(errors, covariances, strict=True)]
    assert 0.5 * 20 < np.mean(nees) < chi2.ppf(0.995, 20 * len(SEEDS)) / len(SEEDS)


@pytest.mark.parametrize(("kind", "size"), [(0, 2), (1, 3), (2, 1), (3, 3)])
def test_innovations_are_as_large_as_foretold(kind, size):
    _, _, innovations = flights()
    assert innovations[kind] == pytest.approx(size, rel=0.25)


def test_the_covariance_stays_symmetric_and_positive():
    for p in flights()[1]:
        np.testing.assert_array_equal(p, p.T)
        known = p[:22, :22]
        assert np.linalg.eigvalsh(known).min() > 0.0
