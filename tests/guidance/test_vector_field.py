"""Vector fields: the sides of a path, and that an aircraft converges onto it, wind or not."""

import math

import pytest

from tests.services.autopilot.air.states import PARAMS, Kinematic, cruising
from uvf.guidance.vector_field import LateralGuidance, line_reference, orbit_reference

NORTH = (1.0, 0.0)


def line(now):
    return line_reference(NORTH, (0.0, 0.0), (now.north, now.east), PARAMS)


def test_right_of_a_line_is_positive():
    assert line(cruising(east=7.0)).error == pytest.approx(7.0)


def test_inside_of_a_clockwise_orbit_is_right_and_positive():
    assert orbit_reference((0.0, 0.0), 100.0, (90.0, 0.0), PARAMS).error == pytest.approx(10.0)
    assert orbit_reference((0.0, 0.0), -100.0, (90.0, 0.0), PARAMS).error == pytest.approx(-10.0)


def test_a_clockwise_orbit_heads_east_at_its_north():
    aim = orbit_reference((0.0, 0.0), 100.0, (100.0, 0.0), PARAMS)
    assert aim.course == pytest.approx(math.pi / 2)
    assert aim.curvature == pytest.approx(0.01)


def test_right_of_the_line_it_banks_left():
    assert LateralGuidance().bank(line(cruising(east=10.0)), cruising(east=10.0), PARAMS, 0.02) < -0.05


def test_on_an_orbit_it_banks_for_the_turn():
    now = cruising(north=0.0, east=-100.0)
    bank = LateralGuidance().bank(orbit_reference((0.0, 0.0), 100.0, (0.0, -100.0), PARAMS), now, PARAMS, 0.02)
    assert bank == pytest.approx(math.atan(25.0**2 / (9.80665 * 100.0)), abs=1e-3)


def test_the_bank_has_a_limit():
    now = cruising(east=500.0, course=math.pi / 2)
    assert abs(LateralGuidance().bank(line(now), now, PARAMS, 0.02)) <= PARAMS.bank_limit


@pytest.mark.parametrize("wind", [(0.0, 0.0), (0.0, 8.0), (-8.0, 0.0)])
def test_a_line_is_joined_without_overshoot_whatever_the_wind(wind):
    seen = Kinematic(east=60.0, wind=wind).follow(line, 40.0)
    assert min(now.east for now in seen) > -1.0
    assert abs(seen[-1].east) < 0.2


@pytest.mark.parametrize("radius", [90.0, -90.0])
@pytest.mark.parametrize("wind", [(0.0, 0.0), (4.0, 4.0)])
def test_an_orbit_is_joined_and_held_whatever_the_wind(radius, wind):
    seen = Kinematic(north=-300.0, wind=wind).follow(lambda now: orbit_reference((0.0, 0.0), radius, (now.north, now.east), PARAMS), 90.0)
    held = [math.hypot(now.north, now.east) for now in seen[2500:]]
    assert max(abs(r - 90.0) for r in held) < 2.0
