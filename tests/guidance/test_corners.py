"""The way round a corner: flyable at one bank and airspeed, tangent to both legs, whatever the wind."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvf.guidance.corners import MOST_OUTSIDE, STEP, CornerLimits, plan
from uvf.maths.geodesy import GRAVITY

SPEED, BANK = 25.0, 0.8
RADIUS = SPEED**2 / (GRAVITY * math.tan(BANK))
WINDS = [(0.0, 0.0), (-7.0, 7.0), (10.0, 0.0)]
degrees_either_way = st.builds(lambda size, side: side * size, st.floats(5.0, 140.0), st.sampled_from((-1.0, 1.0)))


def corner(degrees, wind=(0.0, 0.0), room=(1000.0, 1000.0)):
    return plan((30.0, -20.0), (0.4, 0.4 + math.radians(degrees)), CornerLimits(SPEED, wind, BANK), room)


def air_velocity(planned, wind):
    """(k - 1, 2) m/s, from the points themselves."""
    return np.diff(planned.points, axis=0) / STEP - wind


@pytest.mark.parametrize("wind", WINDS)
@settings(max_examples=30, deadline=None)
@given(degrees=degrees_either_way)
def test_it_leaves_the_first_leg_and_meets_the_second_along_them(degrees, wind):
    planned = corner(degrees, wind)
    for end, course, along in ((0, 0.4, -planned.before), (-1, 0.4 + math.radians(degrees), planned.after)):
        assert math.remainder(planned.course[end] - course, math.tau) == pytest.approx(0.0, abs=1e-3)
        d = planned.points[end] - (30.0, -20.0)
        assert d == pytest.approx((along * math.cos(course), along * math.sin(course)), abs=0.02)


@pytest.mark.parametrize("wind", WINDS)
@pytest.mark.parametrize("degrees", [8.0, -45.0, 90.0, -130.0])
def test_through_the_air_it_is_flown_at_one_speed_and_within_the_bank(degrees, wind):
    air = air_velocity(corner(degrees, wind), wind)
    assert np.hypot(*air.T) == pytest.approx(SPEED, rel=2e-3)
    heading = np.unwrap(np.arctan2(air[:, 1], air[:, 0]))
    banks = np.arctan(np.diff(heading) / STEP * SPEED / GRAVITY)
    assert np.abs(banks).max() <= BANK * 1.01
    assert np.abs(np.diff(banks)).max() / STEP <= math.pi / 2 * BANK / CornerLimits(SPEED, (0.0, 0.0), BANK).roll_in * 1.1


@pytest.mark.parametrize("wind", WINDS)
def test_the_curvature_is_that_of_the_points(wind):
    planned = corner(100.0, wind)
    turned = np.diff(planned.course) / np.diff(planned.s)
    assert turned == pytest.approx((planned.curvature[1:] + planned.curvature[:-1]) / 2, abs=3e-4)


@pytest.mark.parametrize("degrees", [30.0, 60.0, 90.0])
def test_it_passes_as_far_inside_of_the_legs_as_outside(degrees):
    planned = corner(degrees)
    d = planned.points - (30.0, -20.0)
    first, second = (d[:, 1] * math.cos(c) - d[:, 0] * math.sin(c) for c in (0.4, 0.4 + math.radians(degrees)))
    inside, outside = np.minimum(first, second).max(), -second[len(second) // 2 :].min()
    assert inside == pytest.approx(outside, rel=0.1)
    assert outside < 1.02 * MOST_OUTSIDE * RADIUS


def test_a_sharp_corner_does_not_swing_out_far():
    planned = corner(140.0)
    d = planned.points - (30.0, -20.0)
    c = 0.4 + math.radians(140.0)
    outside = -(d[:, 1] * math.cos(c) - d[:, 0] * math.sin(c))
    assert outside[len(outside) // 2 :].max() == pytest.approx(MOST_OUTSIDE * RADIUS, rel=0.1)


@pytest.mark.parametrize("degrees", [0.0, 0.5, 175.0, -180.0])
def test_straight_on_and_straight_back_are_not_rounded(degrees):
    assert corner(degrees) is None


def test_where_there_is_little_room_it_does_not_swing_out():
    wide = corner(90.0)
    tight = corner(90.0, room=(80.0, 100.0))
    assert tight.before > wide.before
    assert tight.after < 100.0 < wide.after


def test_a_leg_that_is_much_too_short_is_not_rounded():
    assert corner(90.0, room=(40.0, 1000.0)) is None


def test_wind_faster_than_the_aircraft_leaves_the_corner_out():
    assert corner(90.0, wind=(30.0, 0.0)) is None


@pytest.mark.parametrize("aside", [-4.0, 0.0, 6.0])
def test_a_point_beside_the_way_knows_where_it_is(aside):
    planned = corner(90.0, (-7.0, 7.0))
    k = len(planned.s) // 3
    c = planned.course[k]
    s, off, course = planned.nearest(tuple(planned.points[k] + aside * np.array((-math.sin(c), math.cos(c)))))
    assert (s, off, course) == pytest.approx((planned.s[k], aside, c), abs=0.06)


def test_beyond_its_ends_it_goes_straight_on():
    planned = corner(90.0)
    s, off, course = planned.nearest((30.0 - 200 * math.cos(0.4), -20.0 - 200 * math.sin(0.4)))
    assert s == pytest.approx(planned.before - 200.0, abs=1e-6)
    assert (off, course) == pytest.approx((0.0, 0.4), abs=1e-6)
    assert planned.bend(-1.0) == planned.bend(planned.length + 1.0) == 0.0
