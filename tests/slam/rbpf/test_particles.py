"""Weights, resampling and pasts of particles."""

import numpy as np
import pytest

from uvf.slam.rbpf.particles import Particles


def moved(particles, rng):
    particles.poses = particles.poses + rng.normal(0.0, 0.1, particles.poses.shape)
    particles.keep()


def test_all_particles_count_while_their_weights_are_equal_and_one_does_when_it_has_all():
    particles = Particles(20)
    assert particles.effective == pytest.approx(20.0)
    particles.reweigh(np.where(np.arange(20) == 7, 0.0, -50.0))
    assert particles.effective == pytest.approx(1.0)
    assert particles.best == 7


def test_resampling_keeps_the_good_particle_and_drops_the_bad_ones():
    particles, rng = Particles(30), np.random.default_rng(1)
    moved(particles, rng)
    good = particles.poses[4].copy()
    particles.reweigh(np.where(np.arange(30) == 4, 0.0, -30.0))
    chosen = particles.resample(rng)
    assert (chosen == 4).all()
    assert (particles.poses == good).all()
    assert particles.effective == pytest.approx(30.0)


def test_a_particle_is_drawn_as_often_as_its_weight_says_to_within_one():
    particles = Particles(10)
    weights = np.array((0.3, 0.25, 0.15, 0.1, 0.05, 0.05, 0.04, 0.03, 0.02, 0.01))
    particles.reweigh(np.log(weights))
    counts = np.bincount(particles.resample(np.random.default_rng(5)), minlength=10)
    assert counts.sum() == 10
    assert np.abs(counts - 10 * weights).max() < 1.0


def test_a_past_is_that_of_the_ancestors():
    particles, rng = Particles(6), np.random.default_rng(2)
    pasts = [[] for _ in range(6)]
    for step in range(12):
        moved(particles, rng)
        for past, pose in zip(pasts, particles.poses, strict=True):
            past.append(pose)
        if step % 3 == 2:
            particles.reweigh(rng.normal(0.0, 2.0, 6))
            pasts = [list(pasts[k]) for k in particles.resample(rng)]
    for k in range(6):
        assert (particles.path(k) == np.array(pasts[k])).all()


def test_the_spread_is_that_of_the_weighted_poses_across_the_seam_of_angles():
    particles = Particles(2)
    particles.poses = np.array(((1.0, 0.0, np.pi - 0.1), (3.0, 0.0, -np.pi + 0.1)))
    assert particles.spread() == pytest.approx(np.array(((1.0, 0.0, 0.1), (0.0, 0.0, 0.0), (0.1, 0.0, 0.01))))
    particles.reweigh(np.array((0.0, -40.0)))
    assert particles.spread() == pytest.approx(np.zeros((3, 3)), abs=1e-12)
