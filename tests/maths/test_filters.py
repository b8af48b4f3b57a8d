"""Filters on single numbers against their closed forms."""

import math

import pytest

from uvf.maths.filters import Integral, LowPass, RunningMean


def test_low_pass_starts_at_its_first_sample():
    assert LowPass(0.5).step(7.0, 0.01) == 7.0


def test_low_pass_follows_a_step_exponentially_whatever_the_step_size():
    for dt in (0.01, 0.1):
        low_pass = LowPass(0.5)
        low_pass.step(0.0, dt)
        for _ in range(round(1.0 / dt)):
            value = low_pass.step(1.0, dt)
        assert value == pytest.approx(1 - math.exp(-2.0))


def test_integral_grows_with_the_rate():
    integral = Integral(1.0)
    for _ in range(10):
        integral.step(0.5, 0.1)
    assert integral.value == pytest.approx(0.5)


def test_integral_stops_at_its_limit_and_leaves_it_at_once():
    integral = Integral(0.3)
    for _ in range(100):
        integral.step(1.0, 0.1)
    assert integral.value == 0.3
    assert integral.step(-1.0, 0.1) == pytest.approx(0.2)


def test_a_running_mean_is_that_of_all_so_far_and_then_of_the_last_of_it():
    mean = RunningMean(10.0, 0.0, 1.0)
    for _ in range(100):
        mean.step(2.0, 0.01)
    assert mean.value == pytest.approx(1.0, abs=0.01)  # one second taken for granted, one seen
    for _ in range(10_000):
        mean.step(2.0, 0.01)
    before = mean.value
    mean.step(12.0, 0.01)
    assert before == pytest.approx(2.0, abs=1e-3)
    assert mean.value - before == pytest.approx(0.01, rel=0.01)
