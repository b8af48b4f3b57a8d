"""Dubins words with clothoids: from one configuration to another, level at both, never too tight, never too sudden."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvf.guidance.clothoid_dubins import smooth_dubins_path, turned_onto, turned_onto_circle
from uvf.maths.curves.dubins import dubins_path

RADIUS, RAMP = 60.0, 30.0
START = (10.0, -20.0, 0.3)
ends = st.tuples(st.floats(-400.0, 400.0), st.floats(-400.0, 400.0), st.floats(-math.pi, math.pi))


@settings(max_examples=100, deadline=None)
@given(end=ends)
def test_it_leads_from_start_to_end_with_bounded_curvature_and_change_of_it(end):
    way = smooth_dubins_path(START, end, RADIUS, RAMP)
    assert way.points[0] == pytest.approx(START[:2])
    assert way.points[-1] == pytest.approx(end[:2], abs=1e-5)
    assert math.remainder(way.course[-1] - end[2], math.tau) == pytest.approx(0.0, abs=1e-6)
    assert way.curvature[[0, -1]] == pytest.approx(0.0, abs=1e-9)
    assert np.abs(way.curvature).max() <= 1 / RADIUS + 1e-9
    # From one side to the other it takes one ramp, which is twice as steep.
    assert (np.abs(np.diff(way.curvature)) <= 2.02 / RADIUS / RAMP * np.diff(way.s)).all()


@settings(max_examples=60, deadline=None)
@given(end=ends)
def test_course_and_curvature_are_those_of_the_points(end):
    way = smooth_dubins_path(START, end, RADIUS, RAMP)
    chords = np.arctan2(*np.diff(way.points, axis=0).T[::-1])
    middle = (way.course[1:] + way.course[:-1]) / 2
    assert np.abs(np.remainder(chords - middle + math.pi, math.tau) - math.pi).max() < 2e-3
    assert np.diff(way.course) == pytest.approx((way.curvature[1:] + way.curvature[:-1]) / 2 * np.diff(way.s), abs=3e-4)


def test_with_a_short_ramp_it_is_the_plain_path():
    end = (200.0, 150.0, -1.0)
    assert smooth_dubins_path(START, end, RADIUS, 0.5).length == pytest.approx(dubins_path(START, end, RADIUS).length, abs=1.0)


def test_straight_ahead_is_straight():
    way = smooth_dubins_path((0.0, 0.0, 0.0), (300.0, 0.0, 0.0), RADIUS, RAMP)
    assert way.length == pytest.approx(300.0)
    assert np.abs(way.points[:, 1]).max() < 1e-6


def test_where_a_way_crosses_itself_the_branch_is_that_of_the_length_told():
    way = smooth_dubins_path((0.0, 0.0, 0.0), (1.0, 1.0, math.pi / 2), RADIUS, RAMP)
    early, late = way.nearest((0.0, 0.0), (0.0, 50.0))[0], way.nearest((0.0, 0.0), (way.length - 50.0, way.length))[0]
    assert early == pytest.approx(0.0, abs=1.0)
    assert late > way.length - 5.0


@settings(max_examples=60, deadline=None)
@given(point=st.tuples(st.floats(-400.0, 400.0), st.floats(-400.0, 400.0)))
def test_a_turn_onto_a_point_ends_looking_at_it(point):
    way = turned_onto((0.0, 0.0, 0.3), point, RADIUS, RAMP)
    if way is None:
        assert math.hypot(*point) < 3 * RADIUS
        return
    (n, e), c = np.array(point) - way.points[-1], way.course[-1]
    assert e * math.cos(c) - n * math.sin(c) == pytest.approx(0.0, abs=1e-3)
    assert n * math.cos(c) + e * math.sin(c) > -1e-3


@settings(max_examples=100, deadline=None)
@given(
    bearing=st.floats(-math.pi, math.pi),
    away=st.floats(250.0, 600.0),
    course=st.floats(-math.pi, math.pi),
    radius=st.sampled_from((-90.0, 90.0)),
)
def test_a_turn_and_a_straight_piece_touch_a_circle_in_its_sense(bearing, away, course, radius):
    start = away * math.cos(bearing), away * math.sin(bearing), course
    way = turned_onto_circle(start, (0.0, 0.0, radius), RADIUS, RAMP)
    (x, y), c = way.points[-1], way.course[-1]
    assert way.points[0] == pytest.approx(start[:2])
    assert x * math.sin(c) - y * math.cos(c) == pytest.approx(radius, abs=0.01), "the centre is as far to the side"
    assert x * math.cos(c) + y * math.sin(c) == pytest.approx(0.0, abs=0.01), "and abeam"
    assert np.abs(way.curvature).max() <= 1 / RADIUS + 1e-9
    assert np.hypot(*np.diff(way.points, axis=0).T).max() < 1.5


@pytest.mark.parametrize("radius", [-90.0, 90.0])
def test_the_way_begins_with_the_bend_that_is_flown_and_ends_with_that_of_the_circle(radius):
    bend = -1 / radius
    way = turned_onto_circle((-300.0, 100.0, 0.5), (0.0, 0.0, radius), RADIUS, RAMP, bend)
    assert way.curvature[0] == pytest.approx(bend)
    assert way.curvature[-1] == pytest.approx(1 / radius)
    steepest = (1 / RADIUS + abs(bend)) / RAMP
    assert np.abs(np.diff(way.curvature)).max() < 1.1 * steepest * np.diff(way.s).max(), "no step between them"
    assert way.course[-1] - way.course[0] == pytest.approx(np.trapezoid(way.curvature, way.s), abs=0.01)


def test_from_near_a_circle_it_is_joined_at_once():
    way = turned_onto_circle((-15.0, -95.0, 0.4), (0.0, 0.0, 90.0), RADIUS, RAMP)
    (x, y), c = way.points[-1], way.course[-1]
    assert x * math.sin(c) - y * math.cos(c) == pytest.approx(90.0, abs=0.01)
    assert way.curvature[-1] == 0.0


@settings(max_examples=60, deadline=None)
@given(point=st.tuples(st.floats(-400.0, 400.0), st.floats(-400.0, 400.0)), bend=st.sampled_from((-1 / 60, 1 / 90)))
def test_a_turn_from_a_circle_begins_with_its_bend(point, bend):
    way = turned_onto((0.0, 0.0, 0.3), point, RADIUS, RAMP, bend)
    if way is None:
        assert math.hypot(*point) < 4 * RADIUS
        return
    (n, e), c = np.array(point) - way.points[-1], way.course[-1]
    assert way.curvature[0] == pytest.approx(bend)
    assert e * math.cos(c) - n * math.sin(c) == pytest.approx(0.0, abs=1e-3)


def test_a_dubins_path_from_a_turn_ends_where_it_is_to():
    end = (250.0, -120.0, 2.0)
    way = smooth_dubins_path(START, end, RADIUS, RAMP, 1 / 80)
    assert way.curvature[0] == pytest.approx(1 / 80)
    assert way.points[-1] == pytest.approx(end[:2], abs=1e-3)
    assert math.remainder(way.course[-1] - end[2], math.tau) == pytest.approx(0.0, abs=1e-5)


def test_from_within_a_circle_it_cannot_be_touched():
    assert turned_onto_circle((10.0, 20.0, 0.0), (0.0, 0.0, 90.0), RADIUS, RAMP) is None
