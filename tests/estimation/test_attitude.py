"""The attitude filter against exact motion."""

import math

import pytest

from uvf.estimation.attitude import AttitudeFilter

G = 9.80665
DT = 0.01


def gravity(roll, pitch):
    return -G * math.sin(pitch), G * math.cos(pitch) * math.sin(roll), G * math.cos(pitch) * math.cos(roll)


def turn_rates(roll, pitch, yaw_rate):
    """Body rates of a steady turn (3.3 inverted)."""
    return -yaw_rate * math.sin(pitch), yaw_rate * math.cos(pitch) * math.sin(roll), yaw_rate * math.cos(pitch) * math.cos(roll)


def test_starts_at_the_angles_that_gravity_shows():
    attitude = AttitudeFilter()
    gx, gy, gz = gravity(0.2, -0.1)
    attitude.start((-gx, -gy, -gz))
    assert (attitude.roll, attitude.pitch) == pytest.approx((0.2, -0.1))


def test_a_wrong_start_is_corrected_by_gravity():
    attitude = AttitudeFilter(roll=0.1, pitch=-0.1)
    for _ in range(12_000):
        attitude.predict((0.0, 0.0, 0.0), DT)
        attitude.correct(gravity(0.0, 0.05), DT)
    assert (attitude.roll, attitude.pitch) == pytest.approx((0.0, 0.05), abs=0.01)


def test_gyroscopes_alone_follow_a_roll():
    attitude = AttitudeFilter()
    for _ in range(100):
        attitude.predict((0.5, 0.0, 0.0), DT)
    assert attitude.roll == pytest.approx(0.5)


def test_a_steady_turn_keeps_its_bank():
    attitude = AttitudeFilter(roll=0.7, pitch=0.08)
    rates = turn_rates(0.7, 0.08, G / 25 * math.tan(0.7))
    for _ in range(1500):
        attitude.predict(rates, DT)
        attitude.correct(gravity(0.7, 0.08), DT)
    assert (attitude.roll, attitude.pitch) == pytest.approx((0.7, 0.08), abs=2e-3)


def test_a_gyroscopes_bias_is_learnt():
    attitude = AttitudeFilter()
    for _ in range(20_000):
        attitude.predict((0.01, -0.01, 0.0), DT)
        attitude.correct(gravity(0.0, 0.0), DT)
    assert (attitude.bias_p, attitude.bias_q) == pytest.approx((0.01, -0.01), rel=0.1)
    assert (attitude.roll, attitude.pitch) == pytest.approx((0.0, 0.0), abs=2e-3)


def test_the_angles_are_carried_on_over_the_age_of_the_sample():
    roll, pitch = AttitudeFilter(roll=0.1, pitch=0.0).ahead((1.0, 0.2, 0.0), 0.01)
    assert roll == pytest.approx(0.11)
    assert pitch == pytest.approx(0.002 * math.cos(0.1))


def test_the_covariance_stays_positive():
    attitude = AttitudeFilter(roll=0.6)
    rates = turn_rates(0.6, 0.0, 0.3)
    for _ in range(5000):
        attitude.predict(rates, DT)
        attitude.correct(gravity(0.6, 0.0), DT)
        assert attitude.p00 > 0
        assert attitude.p00 * attitude.p11 > attitude.p01**2
