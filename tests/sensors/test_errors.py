"""Error processes against their closed forms, and that each keeps to its own generator."""

import numpy as np
import pytest

from uvf.sensors.errors import Channel, Errors, GaussMarkov, RandomWalk, sample_sigma

DT = 0.1
ZERO = np.zeros(3)


def rng(seed=1):
    return np.random.default_rng(seed)


def stream(errors, true=ZERO, count=200, seed=1):
    channel = Channel(errors, len(true), rng(seed))
    return np.array([channel.read(true, DT) for _ in range(count)])


def ensemble(errors, size=4000, true=0.0):
    """One reading of each of many sensors."""
    return Channel(errors, size, rng()).read(np.full(size, true), DT)


def test_without_errors_the_truth_is_read():
    assert (stream(Errors(), np.array((1.0, -2.0, 3.0))) == (1.0, -2.0, 3.0)).all()


def test_white_noise_has_its_sigma_and_no_memory():
    read = stream(Errors(noise=np.array((0.1, 1.0, 10.0))), count=4000)
    assert read.std(axis=0) == pytest.approx((0.1, 1.0, 10.0), rel=0.05)
    assert np.mean(read[1:] * read[:-1], axis=0) / read.var(axis=0) == pytest.approx(ZERO, abs=0.06)


def test_a_density_gives_more_noise_on_faster_samples():
    assert sample_sigma(0.01, 400.0) == pytest.approx(2 * sample_sigma(0.01, 100.0)) == pytest.approx(0.2)


def test_a_bias_is_drawn_once_for_each_sensor():
    read = stream(Errors(bias=0.5))
    assert (read == read[0]).all()
    assert ensemble(Errors(bias=0.5)).std() == pytest.approx(0.5, rel=0.05)


def test_a_scale_error_grows_with_what_is_measured():
    at_ten, at_twenty = ensemble(Errors(scale=0.01), true=10.0), ensemble(Errors(scale=0.01), true=20.0)
    assert at_ten.std() == pytest.approx(0.1, rel=0.05)
    assert at_twenty == pytest.approx(2 * at_ten)


@pytest.mark.parametrize("dt", [0.1, 3.0])
def test_gauss_markov_noise_keeps_its_sigma_and_forgets_within_its_time(dt):
    process = GaussMarkov(np.full(20_000, 2.0), 5.0, rng())
    begin = process.value
    for k in (1, 2, 3):
        now = process.step(dt)
        assert now.std() == pytest.approx(2.0, rel=0.03)
        assert np.mean(begin * now) / 4.0 == pytest.approx(np.exp(-k * dt / 5.0), abs=0.03)


def test_a_gauss_markov_step_is_two_half_steps_in_law():
    """The variance given the start: 1 - exp(-2 dt / T), however the time is divided."""
    whole, halves = (GaussMarkov(np.ones(40_000), 2.0, rng()) for _ in range(2))
    start = whole.value.copy()
    change = whole.step(1.0) - start * np.exp(-0.5), (halves.step(0.5), halves.step(0.5))[1] - start * np.exp(-0.5)
    assert [c.var() for c in change] == pytest.approx([1 - np.exp(-1.0)] * 2, rel=0.03)


def test_a_random_walk_grows_with_the_root_of_time():
    walk = RandomWalk(np.full(5000, 0.3), rng())
    spread = [walk.step(DT).std() for _ in range(400)]
    assert spread[99] == pytest.approx(0.3 * np.sqrt(10.0), rel=0.04)
    assert spread[399] == pytest.approx(0.3 * np.sqrt(40.0), rel=0.04)


def test_readings_saturate_on_both_sides_and_come_in_whole_steps():
    errors = Errors(limit=2.0, resolution=0.25)
    assert stream(errors, np.array((5.0, -5.0, 0.3)))[0] == pytest.approx((2.0, -2.0, 0.25))


def test_quantisation_noise_is_that_of_a_uniform_error():
    true = rng().uniform(-10, 10, 20_000)
    error = Channel(Errors(resolution=0.5), true.size, rng()).read(true, DT) - true
    assert np.abs(error).max() <= 0.25
    assert error.std() == pytest.approx(0.5 / np.sqrt(12), rel=0.02)


def test_the_same_seed_gives_the_same_stream_and_another_seed_another():
    errors = Errors(noise=0.1, bias=0.1, scale=0.1, drift=0.1, random_walk=0.1)
    assert (stream(errors) == stream(errors)).all()
    assert (stream(errors) != stream(errors, seed=2)).all()


@pytest.mark.parametrize("other", [{"bias": 5.0}, {"drift": 5.0}, {"random_walk": 5.0}])
def test_one_kind_of_error_does_not_change_the_draws_of_another(other):
    both, alone, without = stream(Errors(noise=0.1, **other)), stream(Errors(**other)), stream(Errors(noise=0.1))
    assert both - alone == pytest.approx(without)
