"""Legs, arcs and circles as the guidance sees them."""

import math

import pytest

from tests.services.autopilot.air.states import PARAMS, Kinematic, cruising
from uvf.guidance.corners import CornerLimits, plan
from uvf.guidance.route import Circle, Leg, Place, Turn

A, B, C = Place(0.0, 0.0, 60.0), Place(500.0, 0.0, 80.0), Place(500.0, 500.0, 80.0)


def cornered(wind=(0.0, 0.0)):
    corner = plan(B.point, (0.0, math.pi / 2), CornerLimits(25.0, wind, 0.75), (250.0, 250.0))
    return corner, Leg(A, B, None, corner), Leg(B, C, corner, None)


def test_the_height_rises_in_a_straight_line_between_the_ends():
    level = Leg(A, B).level(cruising(north=250.0))
    assert level.height == pytest.approx(70.0)
    assert level.climb == pytest.approx(25.0 * 20.0 / 500.0)


def test_beyond_its_ends_a_leg_is_level():
    assert Leg(A, B).level(cruising(north=-50.0)).climb == 0.0
    assert Leg(A, B).level(cruising(north=600.0)).height == 80.0


def test_a_leg_without_a_corner_ends_at_its_waypoint():
    assert not Leg(A, B).is_flown((499.0, 40.0))
    assert Leg(A, B).is_flown((501.0, -40.0))


def test_a_leg_with_a_corner_ends_where_the_turn_begins():
    corner, leg, _ = cornered()
    assert not leg.is_flown((499.0 - corner.before, 0.0))
    assert leg.is_flown((501.0 - corner.before, 0.0))


def test_the_bank_for_the_turn_is_asked_for_ahead_of_it():
    corner, leg, _ = cornered()
    lead = 25.0 * PARAMS.lead_time
    asked = leg.aim(cruising(north=510.0 - corner.before - lead), PARAMS).curvature
    assert asked == pytest.approx(corner.bend(10.0))
    assert asked > 0


def test_the_bank_of_the_turn_is_taken_back_ahead_of_its_end():
    corner, leg, onto = cornered()
    turn, k = Turn(corner, leg, onto), len(corner.s) // 4
    here = cruising(north=corner.points[k, 0], east=corner.points[k, 1])
    ahead = corner.bend(corner.s[k] + 25.0 * PARAMS.lead_time)
    assert turn.aim(here, PARAMS).curvature == pytest.approx(ahead, abs=1e-5)
    assert turn.aim(here, PARAMS).error == pytest.approx(0.0, abs=1e-6)


def test_a_turn_goes_from_the_height_where_it_begins_to_that_where_it_ends():
    corner, leg, onto = cornered()
    turn = Turn(corner, leg, onto)
    begin, end = (turn.level(cruising(north=n, east=e)) for n, e in corner.points[[0, -1]])
    assert begin.height == pytest.approx(80.0 - 20.0 * corner.before / 500.0)
    assert end.height == pytest.approx(80.0)
    assert begin.climb == pytest.approx(25.0 * (80.0 - begin.height) / corner.length)


def test_a_leg_without_length_still_has_a_direction():
    assert math.hypot(*Leg(A, A).along) == 1.0


def test_a_circle_begins_under_the_aircraft_and_in_its_direction():
    now = cruising(north=10.0, east=20.0, course=1.0)
    aim = Circle.ahead(now, 60.0, 90.0).aim(now, PARAMS)
    assert aim.error == pytest.approx(0.0, abs=1e-9)
    assert math.remainder(aim.course - 1.0, math.tau) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("wind", [(0.0, 0.0), (3.0, -2.0), (-8.0, 6.0)])
def test_a_corner_is_flown_along_its_route(wind):
    corner, leg, onto = cornered(wind)
    flyer = Kinematic(wind=wind)
    pieces, errors = [leg, Turn(corner, leg, onto), onto], []

    def aim(now):
        if len(pieces) > 1 and pieces[0].is_flown((now.north, now.east)):
            pieces.pop(0)
        found = pieces[0].aim(now, PARAMS)
        errors.append(found.error if isinstance(pieces[0], Turn) else 0.0)
        return found

    seen = flyer.follow(aim, 45.0)
    assert len(pieces) == 1
    assert max(map(abs, errors)) < 3.0
    assert abs(seen[-1].north - 500.0) < 1.0
