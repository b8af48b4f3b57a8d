"""Margins of loops that can be worked out by hand."""

import math

import numpy as np
import pytest

from uvf.control.design.margins import margins

OMEGA = np.geomspace(0.01, 100.0, 4000)
S = 1j * OMEGA


def test_an_integrator_with_a_dead_time():
    found = margins(OMEGA, 2.0 / S * np.exp(-0.1 * S))
    assert found.crossover == pytest.approx(2.0, rel=1e-4)
    assert found.phase == pytest.approx(math.pi / 2 - 0.2, abs=1e-4)
    assert found.gain == pytest.approx(math.pi / 2 / 0.1 / 2.0, rel=1e-3)
    assert found.delay == pytest.approx(found.phase / 2.0, rel=1e-4)


def test_three_lags_that_come_near_to_instability():
    found = margins(OMEGA, 4.0 / (S + 1) ** 3)  # unstable from 8 on, at sqrt(3) rad/s
    assert found.gain == pytest.approx(2.0, rel=1e-3)


def test_the_least_of_several_crossings_counts():
    resonance = 0.1 / (S / 0.5 + 1) + 0.05 * 30**2 / (S**2 + 0.6 * S + 30**2)
    found = margins(OMEGA, 20 * 0.5 * resonance)
    assert found.crossover > 20.0


def test_a_loop_that_never_reaches_one_has_no_margin_of_phase():
    found = margins(OMEGA, 0.5 / (S + 1))
    assert math.isnan(found.phase) and math.isnan(found.gain) and found.peak <= 1.0


def test_an_unstable_loop_is_not_shown_as_one_with_room():
    found = margins(OMEGA, 1000.0 / (S + 1) ** 3)  # far beyond the 8 that it bears
    assert found.gain < 0.01 and found.gain_db < -40.0
    assert found.phase < 0.0
