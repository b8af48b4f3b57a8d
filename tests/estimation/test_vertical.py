"""Height and climb rate from barometer, acceleration and fixes."""

import math

import numpy as np
import pytest

from uvf.estimation.vertical import Vertical

DT = 0.02


def test_an_offset_of_the_barometer_is_learnt_from_fixes():
    rng = np.random.default_rng(1)
    vertical = Vertical(60.0 + 2.0, 0.0)
    for k in range(1, 3001):
        vertical.step(380.0 + 0.25 * rng.standard_normal(), 0.0, DT)
        if k % 10 == 0:
            vertical.correct_offset(60.0 + 1.5 * rng.standard_normal(), 380.0)
    assert vertical.height == pytest.approx(60.0, abs=0.4)
    assert vertical.climb == pytest.approx(0.0, abs=0.2)


def test_a_swinging_height_is_followed_without_delay():
    vertical = Vertical(0.0, 0.5)
    for k in range(1, 2001):
        t = k * DT
        vertical.step(math.sin(0.5 * t), -0.25 * math.sin(0.5 * t), DT)
    assert vertical.height == pytest.approx(math.sin(20.0), abs=0.03)
    assert vertical.climb == pytest.approx(0.5 * math.cos(20.0), abs=0.03)


def test_a_bias_of_the_accelerometer_is_learnt():
    vertical = Vertical(0.0, 0.0)
    for _ in range(2000):
        vertical.step(0.0, 0.3, DT)
    assert vertical.height == pytest.approx(0.0, abs=1e-3)
    assert vertical.climb == pytest.approx(0.0, abs=1e-3)


def test_without_a_barometer_the_fixes_hold_the_height():
    vertical = Vertical(60.0, 0.0)
    for k in range(1, 3001):
        vertical.step(None, 0.05, DT)
        if k % 10 == 0:
            vertical.correct(60.0, 0.0)
    assert vertical.height == pytest.approx(60.0, abs=0.2)
    assert vertical.climb == pytest.approx(0.0, abs=0.05)


def test_a_barometer_that_comes_later_begins_at_the_height_known_by_then():
    vertical = Vertical(60.0, 0.0)
    vertical.step(380.0, 0.0, DT)
    assert vertical.height == 60.0
