"""The seven-state filter: its Jacobian, the wind it finds, late fixes."""

import math

import numpy as np
import pytest

from uvf.estimation.track_filter import CHI, PSI, WE, WN, E, N, TrackFilter, V

DT = 0.02
WIND = (3.0, -2.0)


def started(x):
    track = TrackFilter(0.0, 0.0, 25.0, 0.0)
    track._ekf.x = np.array(x, dtype=float)
    return track


def circle(t, airspeed=25.0, rate=0.2):
    """Exact flight on a circle through a wind: position, ground velocity, heading."""
    psi = rate * t
    north = airspeed / rate * math.sin(psi) + WIND[0] * t
    east = airspeed / rate * (1 - math.cos(psi)) + WIND[1] * t
    return north, east, airspeed * math.cos(psi) + WIND[0], airspeed * math.sin(psi) + WIND[1], psi


def flown(seconds, heading=False, latency=0.0):
    rng = np.random.default_rng(2)
    track = TrackFilter(*circle(0.0)[:4])
    roll = math.atan(25 * 0.2 / 9.80665)
    for k in range(1, round(seconds / DT) + 1):
        t = k * DT
        track.predict(25.0, 0.2, roll, DT)
        if k % 10 == 0:
            n, e, vn, ve, _ = circle(t - latency)
            noise = rng.standard_normal(4) * (0.8, 0.8, 0.1, 0.1)
            track.correct_fix(tuple(np.array((n, e, vn, ve)) + noise), latency, (0.8, 0.1))
            track.correct_triangle(25.0)
        if heading:
            track.correct_heading(math.remainder(circle(t)[4] + 0.02 * rng.standard_normal(), math.tau))
    return track


def test_its_jacobian_is_that_of_its_prediction():
    x = np.array((10.0, -5.0, 27.0, 0.6, 3.0, -2.0, 0.5))

    def moved(y):
        track = started(y)
        track.predict(25.0, 0.3, 0.5, DT)
        return track.x

    numeric = np.column_stack([(moved(x + h) - moved(x - h)) / 2e-5 for h in 1e-5 * np.eye(7)])
    track = started(x)
    track._ekf.P = np.eye(7) * 1e6
    track.predict(25.0, 0.3, 0.5, DT)
    covariance = track._ekf.P / 1e6
    assert covariance == pytest.approx(numeric @ numeric.T, abs=2e-2)


@pytest.mark.parametrize("heading", [False, True])
def test_finds_the_wind_in_a_turn_with_and_without_a_compass(heading):
    x = flown(60.0, heading).x
    assert (x[WN], x[WE]) == pytest.approx(WIND, abs=0.4)
    assert math.remainder(x[PSI] - circle(60.0)[4], math.tau) == pytest.approx(0.0, abs=0.03)


def test_smooths_position_and_course():
    x = flown(60.0, heading=True).x
    n, e, vn, ve, _ = circle(60.0)
    assert (x[N], x[E]) == pytest.approx((n, e), abs=0.8)
    assert x[V] == pytest.approx(math.hypot(vn, ve), abs=0.2)
    assert math.remainder(x[CHI] - math.atan2(ve, vn), math.tau) == pytest.approx(0.0, abs=0.02)


def test_a_late_fix_is_carried_on_to_now():
    x = flown(60.0, heading=True, latency=0.2).x
    n, e, _, _, _ = circle(60.0)
    assert (x[N], x[E]) == pytest.approx((n, e), abs=1.0)


def test_course_errors_take_the_short_way_round():
    track = started((0.0, 0.0, 25.0, math.pi - 0.01, 0.0, 0.0, math.pi - 0.01))
    track.correct_fix((0.0, 0.0, 25 * math.cos(math.pi + 0.01), 25 * math.sin(math.pi + 0.01)), 0.0, (0.8, 0.1))
    assert track.x[CHI] == pytest.approx(math.pi, abs=0.02)


def test_fixes_make_the_position_surer():
    assert flown(10.0).position_sigma < 0.8


def test_without_fixes_the_position_grows_unsure_with_time():
    track = flown(20.0, heading=True)
    sigmas = []
    for k in range(1, 3001):
        track.predict(25.0, 0.2, math.atan(25 * 0.2 / 9.80665), DT)
        track.reckon(k * DT, DT)
        track.correct_triangle(25.0)
        sigmas.append(track.position_sigma)
    assert sigmas[2999] > 1.5 * sigmas[1499] > 6.0
