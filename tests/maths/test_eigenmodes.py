"""Modes get the names that a pilot gives them, whatever the order of the eigenvalues and with real ones among them."""

import numpy as np
import pytest
import scipy.linalg

from tests import aerosonde
from uvf.maths.eigenmodes import Mode, lateral_modes, longitudinal_modes

RNG = np.random.default_rng(4)
TURNED = np.linalg.qr(RNG.normal(size=(5, 5)))[0]


def with_eigenvalues(*values):
    """(5, 5) with these; a complex one stands for its pair."""
    blocks = [np.array(((v.real, v.imag), (-v.imag, v.real))) if isinstance(v, complex) else np.array(((v,),)) for v in values]
    return TURNED @ scipy.linalg.block_diag(*blocks) @ TURNED.T


def named(modes):
    return [(mode.name, mode.eigenvalue) for mode in modes]


def approx(expected):
    return [(name, pytest.approx(value, abs=1e-9)) for name, value in expected]


def test_the_fast_pair_is_the_short_period_and_the_slow_one_the_phugoid():
    found = named(longitudinal_modes(with_eigenvalues(-0.1 + 0.4j, -1e-3, -5.0 + 9.0j)))
    assert found == approx([("short period", -5 + 9j), ("phugoid", -0.1 + 0.4j), ("altitude", -1e-3)])


def test_an_overdamped_short_period_is_two_times():
    found = named(longitudinal_modes(with_eigenvalues(-2.0, -0.1 + 0.4j, 1e-3, -6.0)))
    assert found == approx([("short period", -6.0), ("short period", -2.0), ("phugoid", -0.1 + 0.4j), ("altitude", 1e-3)])


def test_a_pair_between_two_real_ones_is_not_torn_apart():
    found = named(longitudinal_modes(with_eigenvalues(-1.75, 0.0, -0.5, -0.8 + 0.2j)))
    assert found == approx([("subsidence", -1.75), ("pitch oscillation", -0.8 + 0.2j), ("subsidence", -0.5), ("altitude", 0.0)])


def test_the_lateral_pair_is_the_dutch_roll_even_when_slower_than_the_roll():
    found = named(lateral_modes(with_eigenvalues(0.05, -20.0, 0.0, -1.0 + 4.0j)))
    assert found == approx([("Dutch roll", -1 + 4j), ("roll", -20.0), ("spiral", 0.05), ("heading", 0.0)])


def test_four_real_lateral_ones_are_roll_spiral_and_an_overdamped_dutch_roll():
    found = named(lateral_modes(with_eigenvalues(-0.1, -9.0, 0.0, -1.0, -2.0)))
    assert found == approx([("Dutch roll", -2.0), ("Dutch roll", -1.0), ("roll", -9.0), ("spiral", -0.1), ("heading", 0.0)])


def test_roll_and_spiral_may_swing_together():
    found = named(lateral_modes(with_eigenvalues(-0.2 + 0.3j, 0.0, -1.0 + 4.0j)))
    assert found == approx([("Dutch roll", -1 + 4j), ("roll and spiral", -0.2 + 0.3j), ("heading", 0.0)])


def test_frequency_damping_and_times_are_those_of_a_second_order_oscillator():
    frequency, damping = 3.0, 0.2
    pair = np.roots((1.0, 2 * damping * frequency, frequency**2))
    mode = Mode("it", complex(pair[pair.imag > 0][0]))
    assert (mode.frequency, mode.damping) == pytest.approx((frequency, damping))
    assert mode.time_constant == pytest.approx(1 / (damping * frequency))
    assert mode.period == pytest.approx(2 * np.pi / (frequency * np.sqrt(1 - damping**2)))


def test_what_grows_has_a_time_and_a_damping_below_zero():
    assert (Mode("it", 0.5 + 0j).time_constant, Mode("it", 0.5 + 0j).damping) == (-2.0, -1.0)


def test_the_modes_of_the_aerosonde_are_scipys_eigenvalues_of_the_books_matrices():
    trim = aerosonde.trimmed(25.0, 1.225, 9.81)
    matrices = aerosonde.longitudinal(trim, 1.225, 9.81).a, aerosonde.lateral(trim, 1.225, 9.81).a
    modes = longitudinal_modes(matrices[0]), lateral_modes(matrices[1])
    assert [[m.name for m in side] for side in modes] == [
        ["short period", "phugoid", "altitude"],
        ["Dutch roll", "roll", "spiral", "heading"],
    ]
    for matrix, side in zip(matrices, modes, strict=True):
        expected = sorted((v for v in scipy.linalg.eigvals(matrix) if v.imag >= 0), key=lambda v: (v.real, v.imag))
        assert sorted((m.eigenvalue for m in side), key=lambda v: (v.real, v.imag)) == pytest.approx(expected, abs=1e-9)
