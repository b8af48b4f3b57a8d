"""The skew between scans and odometry is found from turns, said with its uncertainty, and not made up where nothing turned."""

import numpy as np
import pytest

from uvf.estimation.odometry.time_skew import PRIOR_SIGMA, UNKNOWN, TimeSkew

ODOMETRY_DT, SCAN_DT = 0.05, 0.2  # s


def turning(rng, seconds=60.0, rate=0.5):
    """Heading as a function of time: a new turn rate each second or so."""
    knots = np.arange(-2.0, seconds + 4.0, 0.01)
    wanted = rate * rng.choice((-1.0, 0.0, 1.0), len(knots) // 100 + 1).repeat(100)[: len(knots)]
    heading = np.cumsum(np.convolve(wanted, np.ones(30) / 30, mode="same")) * 0.01
    return lambda t: np.interp(t, knots, heading)


def found(heading, skew, rng, *, seconds=60.0, noise=0.004, outliers=0.0, gain=1.0, jitter=0.0):
    """The estimate after a drive whose scans stamped t were taken at t + skew."""
    estimator, scanned = TimeSkew(), None
    for k in range(round(seconds / ODOMETRY_DT)):
        t = k * ODOMETRY_DT
        estimator.add_odometry(t + jitter * rng.standard_normal(), gain * heading(t))
        if k % round(SCAN_DT / ODOMETRY_DT) == 0:
            matched = heading(t + skew) + noise * rng.standard_normal()
            if rng.random() < outliers:
                matched += rng.uniform(-0.5, 0.5)
            if scanned is not None:
                estimator.add_turn(t - SCAN_DT, t, matched - scanned)
            scanned = matched
    return estimator.estimate()


@pytest.mark.parametrize("skew", [-0.7, -0.1, 0.0, 0.03, 0.45])
def test_the_skew_is_found_with_its_sign(skew):
    rng = np.random.default_rng(1)
    estimate = found(turning(rng), skew, rng)
    assert estimate.seconds == pytest.approx(skew, abs=0.015)
    assert estimate.sigma < 0.015


@pytest.mark.parametrize("trouble", [{"outliers": 0.2}, {"gain": 1.1}, {"gain": 0.85}, {"noise": 0.02}])
def test_wrong_matches_long_wheels_and_noise_do_not_mislead_it(trouble):
    rng = np.random.default_rng(2)
    estimate = found(turning(rng), -0.1, rng, **trouble)
    assert abs(estimate.seconds + 0.1) < 3 * estimate.sigma < 0.12


def test_wheels_that_tell_every_turn_too_long_make_the_skew_no_less_certain():
    right, long = (found(turning(rng, 20.0), -0.1, rng, seconds=20.0, gain=g) for g in (1.0, 1.35) for rng in [np.random.default_rng(3)])
    assert long.sigma < 1.2 * right.sigma


def test_a_few_turns_are_enough():
    rng = np.random.default_rng(3)
    estimate = found(turning(rng, 12.0), -0.15, rng, seconds=12.0)
    assert abs(estimate.seconds + 0.15) < 3 * estimate.sigma
    assert estimate.sigma < 0.05


def test_the_error_is_as_large_as_it_says():
    errors = []
    for seed in range(30):
        rng = np.random.default_rng(seed)
        skew = rng.uniform(-0.4, 0.4)
        estimate = found(turning(rng, 20.0), skew, rng, seconds=20.0, noise=0.02)
        errors.append((estimate.seconds - skew) / estimate.sigma)
    assert 0.3 < np.mean(np.square(errors)) < 1.7


def test_nothing_is_said_while_nothing_turns():
    rng = np.random.default_rng(4)
    assert found(lambda t: 0.3, -0.2, rng) == UNKNOWN


def test_a_steady_turn_tells_little():
    rng = np.random.default_rng(5)
    estimate = found(lambda t: 0.4 * t, -0.2, rng)
    assert estimate.sigma > 0.8 * PRIOR_SIGMA or estimate == UNKNOWN


def test_stamps_out_of_order_are_left_out():
    rng = np.random.default_rng(6)
    estimate = found(turning(rng), -0.1, rng, jitter=0.03)
    assert estimate.seconds == pytest.approx(-0.1, abs=0.03)


def test_a_clock_that_begins_anew_and_broken_values_do_no_harm():
    rng = np.random.default_rng(7)
    heading, estimator = turning(rng), TimeSkew()
    for begin in (0.0, -500.0, 1e9):
        for k in range(600):
            t = k * ODOMETRY_DT
            estimator.add_odometry(begin + t, heading(t))
            estimator.add_odometry(float("nan"), 0.0)
            if k >= 4:
                estimator.add_turn(begin + t - SCAN_DT, begin + t, heading(t - 0.1) - heading(t - SCAN_DT - 0.1))
                estimator.add_turn(begin + t, begin + t - SCAN_DT, 3.0)
                estimator.add_turn(begin + t - SCAN_DT, begin + t, float("nan"))
    assert estimator.estimate().seconds == pytest.approx(-0.1, abs=0.01)
