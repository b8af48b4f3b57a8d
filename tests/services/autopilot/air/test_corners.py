"""The way round a corner: tangent to the shifted legs, as far inside as outside."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from services.autopilot.air.corners import Corner, offset, plan

RADIUS = 70.0


def corner(degrees, room=1000.0):
    return plan((0.0, 0.0), (0.0, math.radians(degrees)), RADIUS, room)


@given(st.floats(5.0, 140.0), st.sampled_from((-1.0, 1.0)))
def test_the_arc_touches_both_shifted_legs(degrees, side):
    planned = corner(side * degrees)
    north, east = planned.centre
    change = math.radians(side * degrees)
    from_first = planned.turn * east
    from_second = planned.turn * (-math.sin(change) * north + math.cos(change) * east)
    assert from_first == pytest.approx(RADIUS - planned.shift)
    assert from_second == pytest.approx(RADIUS - planned.shift)
    assert north == pytest.approx(-planned.before)


@given(st.floats(5.0, 140.0))
def test_it_passes_as_far_inside_of_the_legs_as_outside(degrees):
    planned = corner(degrees)
    half = math.radians(degrees) / 2
    inside = (RADIUS - planned.shift) - RADIUS * math.cos(half)
    assert inside == pytest.approx(planned.shift)


def test_a_right_angle_is_rounded_within_fifteen_percent_of_the_radius():
    assert corner(90.0).shift == pytest.approx(0.146 * RADIUS, rel=0.01)


@pytest.mark.parametrize("degrees", [0.0, 0.5, 175.0, -180.0])
def test_straight_on_and_straight_back_are_not_rounded(degrees):
    assert corner(degrees) is None


def test_a_short_leg_takes_a_smaller_arc_that_fits():
    planned = corner(90.0, room=120.0)
    assert planned.radius < RADIUS
    assert planned.before + planned.swing == pytest.approx(120.0)


def test_a_leg_that_is_much_too_short_is_not_rounded():
    assert corner(90.0, room=40.0) is None


def test_the_swing_leads_from_the_leg_to_the_shifted_line():
    planned = corner(90.0)
    start = 500.0 - planned.before
    assert offset(start - planned.swing, 500.0, None, planned).value == pytest.approx(0.0)
    assert offset(start, 500.0, None, planned).value == pytest.approx(-planned.shift)
    assert offset(planned.before, 500.0, planned, None).value == pytest.approx(-planned.shift)


@given(st.floats(0.0, 500.0))
def test_slope_and_bend_are_derivatives_of_the_swing(s):
    planned: Corner = corner(90.0)
    h = 1e-3
    before, here, after = (offset(s + d, 500.0, planned, planned) for d in (-h, 0.0, h))
    assert here.slope == pytest.approx((after.value - before.value) / (2 * h), abs=1e-6)
    assert here.bend == pytest.approx((after.slope - before.slope) / (2 * h), abs=1e-5)
