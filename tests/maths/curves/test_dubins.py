"""Dubins paths: against OMPL's lengths, and what every path must hold."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from launch.commands.testing import data_folder
from uvf.maths.curves.dubins import DubinsPath, dubins_path, dubins_paths

angles = st.floats(-math.pi, math.pi)
places = st.floats(-300.0, 300.0)
configurations = st.tuples(places, places, angles)
DATA = data_folder()


@pytest.mark.skipif(DATA is None, reason="no data folder: OMPL's Dubins lengths left out (set UVF_DATA)")
def test_lengths_are_those_of_ompl():
    rows = np.loadtxt(DATA / "dubins" / "dubins_ompl.csv", delimiter=",", skiprows=1)
    assert len(rows) == 5000
    lengths = np.array([dubins_path(tuple(r[1:4]), tuple(r[4:7]), r[0]).length for r in rows])
    # The file has nine digits, which is all that is asked of start and end.
    assert np.abs(lengths - rows[:, 7]).max() / 50.0 < 1e-6


@settings(max_examples=150, deadline=None)
@given(start=configurations, end=configurations, radius=st.floats(1.0, 120.0))
def test_every_word_ends_where_it_should(start, end, radius):
    paths = dubins_paths(start, end, radius)
    assert len({p.word for p in paths}) == len(paths) >= 2
    for path in paths:
        x, y, course = path.joints[3]
        assert (x, y) == pytest.approx(end[:2], abs=1e-6)
        assert math.remainder(course - end[2], math.tau) == pytest.approx(0.0, abs=1e-8)
        assert min(path.lengths) >= 0


@settings(max_examples=100, deadline=None)
@given(start=configurations, end=configurations)
def test_the_shortest_is_no_shorter_than_the_straight_line_and_the_same_backwards(start, end):
    path = dubins_path(start, end, 40.0)
    assert path.length >= math.dist(start[:2], end[:2]) - 1e-6
    back = dubins_path((*end[:2], end[2] + math.pi), (*start[:2], start[2] + math.pi), 40.0)
    assert back.length == pytest.approx(path.length, abs=1e-6)


def test_all_six_words_are_the_shortest_somewhere():
    rng = np.random.default_rng(3)
    ends = np.column_stack((rng.uniform(-120, 120, (600, 2)), rng.uniform(-math.pi, math.pi, 600)))
    assert {dubins_path((0.0, 0.0, 0.0), tuple(e), 40.0).word for e in ends.tolist()} == {"LSL", "RSR", "LSR", "RSL", "LRL", "RLR"}


def test_straight_on_is_straight_and_nowhere_is_nothing():
    ahead = (300.0 * math.cos(0.7), 300.0 * math.sin(0.7), 0.7)
    assert dubins_path((0.0, 0.0, 0.7), ahead, 50.0).length == pytest.approx(300.0, abs=1e-9)
    assert dubins_path((5.0, 6.0, 0.7), (5.0, 6.0, 0.7), 50.0).length == pytest.approx(0.0, abs=1e-9)


def test_half_a_circle_to_either_side():
    left, right = dubins_path((0, 0, 0), (0, 100, math.pi), 50.0), dubins_path((0, 0, 0), (0, -100, math.pi), 50.0)
    assert left.length == right.length == pytest.approx(50 * math.pi, abs=1e-9)
    assert left.curvature(np.array([10.0]))[0] == -right.curvature(np.array([10.0]))[0] == pytest.approx(1 / 50)


def test_samples_course_and_curvature_belong_together():
    path = dubins_path((0.0, 0.0, 0.0), (30.0, 40.0, 2.0), 40.0)
    s = np.linspace(0, path.length, 20001)
    x, y, course = path.at(s).T
    ds = s[1] - s[0]
    assert np.hypot(np.diff(x), np.diff(y)) == pytest.approx(ds, rel=1e-6)
    middle = (s[1:] + s[:-1]) / 2
    inside = np.abs(middle[:, None] - np.cumsum(path.lengths)).min(axis=1) > ds
    assert (np.diff(course) / ds)[inside] == pytest.approx(path.curvature(middle)[inside], abs=1e-9)


def test_beyond_both_ends_it_goes_straight_on():
    path = dubins_path((0.0, 0.0, 0.5), (100.0, 100.0, 2.0), 30.0)
    x, y, course = path.at(np.array([-10.0, path.length + 10.0])).T
    assert (x[0], y[0], course[0]) == pytest.approx((-10 * math.cos(0.5), -10 * math.sin(0.5), 0.5))
    assert (x[1], y[1]) == pytest.approx((100 + 10 * math.cos(2), 100 + 10 * math.sin(2)))
    assert list(path.curvature(np.array([-1.0, path.length + 1]))) == [0.0, 0.0]


@settings(max_examples=60, deadline=None)
@given(end=configurations, x=places, y=places)
def test_the_nearest_point_is_that_of_a_fine_search(end, x, y):
    path = dubins_path((0.0, 0.0, 0.0), end, 40.0)
    s, distance = path.nearest(x, y)
    px, py, _ = path.at(np.array([s]))[0]
    assert math.hypot(x - px, y - py) == pytest.approx(distance, abs=1e-6)
    samples = path.at(np.linspace(0, path.length, 2000))
    assert distance <= np.hypot(samples[:, 0] - x, samples[:, 1] - y).min() + 1e-9


def test_a_radius_that_is_none_is_refused():
    with pytest.raises(ValueError, match="radius of 0 m"):
        dubins_path((0, 0, 0), (1, 1, 1), 0.0)


def test_an_arc_far_too_short_to_see_is_still_exact():
    path = DubinsPath((0.0, 0.0, 0.0), 50.0, (1, 0, -1), (1e-9, 100.0, 0.0))
    assert path.joints[3][1] == pytest.approx(100.0 * 1e-9 / 50, rel=1e-9)
