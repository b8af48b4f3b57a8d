"""Gaussians of poses in machine code, against scipy and numpy."""

import numpy as np
from scipy.stats import multivariate_normal

from uvf.slam.localization.gaussian import drawn, inverse, log_density

COVARIANCE = np.array(((0.04, 0.01, -0.002), (0.01, 0.09, 0.003), (-0.002, 0.003, 0.01)))
MEAN = np.array((1.0, -2.0, 3.1))


def test_the_inverse_is_the_inverse():
    assert np.allclose(inverse(COVARIANCE) @ COVARIANCE, np.eye(3))


def test_densities_differ_by_a_constant_from_scipys():
    poses = MEAN + np.random.default_rng(1).normal(size=(20, 3)) * 0.2
    wide = 4.0 * COVARIANCE
    for covariance in (COVARIANCE, wide):
        off = log_density(poses, MEAN, covariance) - multivariate_normal(MEAN, covariance).logpdf(poses)
        assert np.allclose(off, 1.5 * np.log(2.0 * np.pi))


def test_headings_beyond_a_half_turn_are_near():
    turned = np.array(((0.0, 0.0, 0.1), (0.0, 0.0, 0.1 - 2.0 * np.pi)))
    assert np.allclose(*log_density(MEAN + turned, MEAN, COVARIANCE))


def test_what_is_drawn_has_mean_and_covariance():
    poses = drawn(MEAN, COVARIANCE, np.random.default_rng(2).standard_normal((40_000, 3)))
    assert np.allclose(poses.mean(axis=0), MEAN, atol=0.01)
    assert np.allclose(np.cov(poses.T), COVARIANCE, atol=0.002)
