"""Circles through points: the right one where there is one, none where the points do not tell it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvf.planning.moving.circles import NO_FIT, find_circle, fit_circle

EYE = (0.0, 0.0)


def arc(x, y, radius, half_angle, n=40, noise=0.0, seed=0):
    """Points on the side of a circle that faces the origin."""
    rng = np.random.default_rng(seed)
    angles = np.arctan2(-y, -x) + np.linspace(-half_angle, half_angle, n)
    return np.array((x, y)) + (radius + noise * rng.standard_normal(n))[:, None] * np.column_stack((np.cos(angles), np.sin(angles)))


def all_of(points):
    return np.ones(len(points), dtype=np.bool_)


def found(points, guess):
    """The circle near the guess, and which points it takes."""
    own = np.zeros(len(points), dtype=np.bool_)
    return find_circle(points, np.hypot(points[:, 0], points[:, 1]), EYE, guess, own), own


@settings(deadline=None)
@given(
    st.floats(1.0, 8.0),
    st.floats(-3.0, 3.0),
    st.floats(0.1, 0.9),
    st.floats(0.5, 1.4),
    st.tuples(*[st.floats(-0.05, 0.05)] * 2, st.floats(0.8, 1.3)),
)
def test_points_of_a_circle_give_that_circle(x, y, radius, half_angle, off):
    points = arc(x, y, radius, half_angle)
    fit = fit_circle(points, all_of(points), (x + off[0], y + off[1], radius * off[2]), True)
    assert fit[:3] == pytest.approx((x, y, radius), abs=1e-4)
    fit = fit_circle(points, all_of(points), (x + off[0], y + off[1], radius), False)
    assert fit[:2] == pytest.approx((x, y), abs=1e-4)


@pytest.mark.parametrize("free", [True, False])
@pytest.mark.parametrize("half_angle", [0.5, 1.2])
def test_the_spread_that_is_told_is_that_of_many_fits(free, half_angle):
    fits = []
    for seed in range(300):
        points = arc(3.0, 1.0, 0.5, half_angle, noise=0.01, seed=seed)
        fits.append(fit_circle(points, all_of(points), (3.0, 1.0, 0.5), free))
    error = np.array([fit[:2] for fit in fits]) - np.array((3.0, 1.0))
    assert np.mean([fit[4] for fit in fits]) == pytest.approx(np.sqrt((error**2).sum(axis=1).mean()), rel=0.15)


def test_a_known_circle_is_found_where_it_touches_a_wall_and_another_one():
    wall = np.column_stack((np.full(60, 3.45), np.linspace(-3.0, 3.0, 60)))
    own, other = arc(3.0, 0.0, 0.5, 1.2), arc(2.9, 0.8, 0.4, 1.2)
    fit, chosen = found(np.concatenate((wall, own, other)), (3.07, -0.06, 0.5))
    assert fit[:2] == pytest.approx((3.0, 0.0), abs=0.01)
    assert chosen[60:100].mean() > 0.95
    assert chosen[100:].mean() < 0.15


def test_the_far_side_of_a_circle_is_not_taken_for_its_near_side():
    beyond = 2.0 * np.array((4.0, 0.0)) - arc(4.0, 0.0, 0.5, 1.0)
    fit, chosen = found(beyond, (4.0, 0.0, 0.5))
    assert fit == NO_FIT
    assert not chosen.any()


def line():
    return np.column_stack((np.full(30, 2.0), np.linspace(-0.5, 0.5, 30)))


@pytest.mark.parametrize("points", [np.zeros((0, 2)), np.ones((3, 2)), np.full((8, 2), np.nan), np.ones((8, 2))])
@pytest.mark.parametrize("free", [True, False])
def test_points_that_tell_no_circle_give_none(points, free):
    assert fit_circle(points, all_of(points), (1.0, 1.0, 0.5), free)[5] == 0


def test_a_line_is_no_small_circle():
    points = line()
    x, y, radius, rough, spread, _ = fit_circle(points, all_of(points), (2.5, 0.0, 0.5), True)
    assert radius > 2.0 or rough > 0.03 or spread > 0.2 or not np.isfinite(x + y)
