"""Turbulence against its own spectra: long seeded series, and the standard's figures."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.signal import welch

from uvf.maths import dryden
from uvf.maths.dryden import Strength, Turbulence, spectra, strength

SPEED, SPAN, DT = 25.0, 2.9, 0.02
AIR = Strength(sigma_u=2.0, sigma_w=1.5, length_u=60.0, length_w=25.0)  # short, so that a series holds many of them
COMPONENTS = "uvwpqr"


def series(count, seed=1, dt=DT):
    turbulence = Turbulence(SPAN, np.random.default_rng(seed))
    return np.array([turbulence.step(SPEED * dt, dt, AIR) for _ in range(count)])


@pytest.fixture(scope="module")
def long_series():
    return series(300_000)


@pytest.mark.parametrize("component", COMPONENTS)
def test_intensities_are_within_5_percent_of_the_integral_of_the_spectrum(long_series, component):
    omega = np.geomspace(1e-5, 1e5, 100_001)
    stated = np.sqrt(np.trapezoid(spectra(omega, AIR, SPEED, SPAN)[component], omega))
    assert long_series[:, COMPONENTS.index(component)].std() == pytest.approx(stated, rel=0.05)


@pytest.mark.parametrize("component", COMPONENTS)
def test_spectra_are_the_analytic_ones_over_two_decades(long_series, component):
    f, density = welch(long_series[:, COMPONENTS.index(component)], 1 / DT, nperseg=8192)
    omega = 2 * np.pi * f[1:]
    ratio = density[1:] / (2 * np.pi) / spectra(omega, AIR, SPEED, SPAN)[component]
    for low, high in ((0.15, 0.5), (0.5, 2.0), (2.0, 10.0), (10.0, 30.0)):
        assert ratio[(omega > low) & (omega < high)].mean() == pytest.approx(1.0, abs=0.12)


def test_variances_of_the_velocities_are_the_squared_intensities():
    omega = np.geomspace(1e-5, 1e5, 100_001)
    for component, sigma in (("u", AIR.sigma_u), ("v", AIR.sigma_u), ("w", AIR.sigma_w)):
        assert np.trapezoid(spectra(omega, AIR, SPEED, SPAN)[component], omega) == pytest.approx(sigma**2, rel=1e-3)


def test_the_roll_intensity_is_the_root_of_its_spectrums_integral():
    omega = np.geomspace(1e-5, 1e6, 100_001)
    assert dryden.roll_sigma(AIR, SPAN) ** 2 == pytest.approx(np.trapezoid(spectra(omega, AIR, SPEED, SPAN)["p"], omega), rel=1e-3)


@pytest.mark.parametrize("theta", [1e-6, 1e-3, 0.019, 0.021, 0.5, 3.0])
def test_the_noise_of_a_step_is_that_of_van_loans_method(theta):
    a, q = np.array(((-1.0, 1.0), (0.0, -1.0))), np.diag((0.0, 1.0))
    upper = expm(np.block([[-a, q], [np.zeros((2, 2)), a.T]]) * theta)
    whole = upper[2:, 2:].T @ upper[:2, 2:]
    c22, c12, c11 = dryden._covariance(theta)
    assert np.array(((c11, c12), (c12, c22))) == pytest.approx(whole, rel=1e-6, abs=1e-19)


def test_pitch_gusts_are_the_falling_and_yaw_gusts_the_growing_of_what_is_met_along_the_flight(long_series):
    """Rotation of the air: w = -q x and v = r x about the aircraft."""
    slow = long_series[:: round(1.0 / DT)]
    assert np.corrcoef(np.diff(long_series[:, 2]), long_series[1:, 4])[0, 1] < -0.3
    assert np.corrcoef(np.diff(long_series[:, 1]), long_series[1:, 5])[0, 1] > 0.3
    assert abs(np.corrcoef(slow[:, 0], slow[:, 3])[0, 1]) < 0.1


def test_the_figures_of_the_standard():
    light = strength(100 * dryden.FT, 15.43, "moderate")
    assert light.sigma_w == pytest.approx(1.543)
    assert light.length_w == pytest.approx(100 * dryden.FT)
    assert light.length_u == pytest.approx(100 * dryden.FT / (0.177 + 0.0823) ** 1.2)
    assert light.sigma_u == pytest.approx(1.543 / (0.177 + 0.0823) ** 0.4)
    high = strength(7500 * dryden.FT, 15.43, "moderate")
    assert high == pytest.approx((10.1 * dryden.FT, 10.1 * dryden.FT, 1750 * dryden.FT, 1750 * dryden.FT))
    assert strength(25_000.0, 7.72, "light").sigma_u == 0.0


def test_at_1000_feet_the_low_model_is_isotropic_and_joins_the_higher_ones_without_a_step():
    low = strength(dryden.LOW, 10.0, "light")
    assert low.sigma_u == pytest.approx(low.sigma_w)
    assert low.length_u == pytest.approx(low.length_w)
    for border in (dryden.LOW, dryden.HIGH):
        assert strength(border - 1e-6, 10.0, "light") == pytest.approx(strength(border + 1e-6, 10.0, "light"), rel=1e-6)


def test_below_10_feet_it_is_as_at_10_feet():
    assert strength(0.0, 10.0, "light") == strength(dryden.LOWEST, 10.0, "light")


def test_a_turn_leaves_the_air_as_it_is():
    """What an aircraft meets that turns is, in axes that do not, what it would have met flying straight but for new gusts."""
    turns, goes = (Turbulence(SPAN, np.random.default_rng(3)) for _ in range(2))
    air = strength(100.0, 15.0, "moderate")
    for _ in range(500):
        turns.step(0.2, 0.01, air)
        goes.step(0.2, 0.01, air)
    before = goes.step(1e-9, 0.01, air)
    turns.turn(np.pi / 2)
    after = turns.step(1e-9, 0.01, air)
    assert (after.u, after.v) == pytest.approx((-before.v, before.u), abs=1e-3)
    assert after.r == pytest.approx(before.r, abs=1e-3) and after.w == pytest.approx(before.w, abs=1e-3)


def test_circling_meets_gusts_of_the_same_strength():
    turbulence, air = Turbulence(SPAN, np.random.default_rng(4)), strength(100.0, 15.0, "moderate")
    met = []
    for _ in range(400_000):
        turbulence.turn(0.05)
        met.append(turbulence.step(2.0, 0.1, air)[:2])
    assert np.std(np.array(met), axis=0) == pytest.approx((air.sigma_u, air.sigma_u), rel=0.06)


def test_the_seed_decides():
    assert (series(100, seed=5) == series(100, seed=5)).all()
    assert (series(100, seed=5) != series(100, seed=6)).any()


def test_halving_the_step_leaves_the_intensities():
    fine = series(100_000, seed=3, dt=DT / 4)
    assert fine[:, 2].std() == pytest.approx(AIR.sigma_w, rel=0.05)
    assert fine[:, 3].std() == pytest.approx(dryden.roll_sigma(AIR, SPAN), rel=0.05)
