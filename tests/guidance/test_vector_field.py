"""Vector fields: the sides of a path, and that an aircraft converges onto it, wind or not."""

import math

import msgspec
import pytest

from tests.services.autopilot.air.states import PARAMS, Kinematic, cruising
from uvf.guidance.vector_field import LateralGuidance, line_reference, orbit_reference

NORTH = (1.0, 0.0)
PARAMS0 = msgspec.structs.replace(PARAMS, lead_time=0.0, bank_time=0.0)


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


def test_on_a_circle_in_wind_it_banks_for_the_speed_over_ground_that_it_will_have():
    """Tail wind is to come: the bank is ahead of that of now by the time in which the aircraft follows it."""
    slow = msgspec.structs.replace(PARAMS, lead_time=0.6, bank_time=0.4)
    north_of_it = cruising(north=100.0, course=math.pi / 2, yaw=math.pi / 2 + math.asin(-8.0 / 25.0), wind_north=8.0)
    # Clockwise at the north of the circle the course turns south, against a wind that blows north.
    aim = orbit_reference((0.0, 0.0), 100.0, (100.0, 0.0), slow)
    late, early = (LateralGuidance().bank(aim, north_of_it, params, 0.02) for params in (PARAMS0, slow))
    assert early < late - 0.03


@pytest.mark.parametrize("radius", [90.0, -90.0])
def test_an_orbit_in_strong_wind_is_held_by_an_aircraft_that_rolls_slowly(radius):
    known = msgspec.structs.replace(PARAMS, lead_time=0.0, bank_time=PARAMS.roll_time)
    flyer = Kinematic(north=-300.0, wind=(10.0, 0.0), params=known)
    seen = flyer.follow(lambda now: orbit_reference((0.0, 0.0), radius, (now.north, now.east), known), 120.0)
    held = [math.hypot(now.north, now.east) for now in seen[3000:]]
    assert max(abs(r - 90.0) for r in held) < 0.5


def test_joining_a_line_from_far_teaches_the_integrator_nothing():
    flyer = Kinematic(east=60.0)
    flyer.follow(line, 40.0)
    assert abs(flyer.steering._trim.value) < 0.002
