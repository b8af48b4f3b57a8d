"""Legs, arcs and circles as the guidance sees them."""

import math

import pytest

from services.autopilot.air.corners import plan
from services.autopilot.air.route import Arc, Circle, Leg, Place
from tests.services.autopilot.air.states import PARAMS, Kinematic, cruising

A, B, C = Place(0.0, 0.0, 60.0), Place(500.0, 0.0, 80.0), Place(500.0, 500.0, 80.0)


def cornered():
    corner = plan(B.point, (0.0, math.pi / 2), 70.0, 250.0)
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


def test_a_leg_with_a_corner_ends_where_the_arc_begins():
    corner, leg, _ = cornered()
    assert not leg.is_flown((499.0 - corner.before, 0.0))
    assert leg.is_flown((501.0 - corner.before, 0.0))


def test_the_bank_for_the_arc_is_asked_for_ahead_of_it():
    corner, leg, _ = cornered()
    lead = 25.0 * PARAMS.lead_time
    assert leg.aim(cruising(north=501.0 - corner.before - lead), PARAMS).curvature == pytest.approx(1 / corner.radius)


def test_the_bank_of_the_arc_is_taken_back_ahead_of_its_end():
    corner, _, onto = cornered()
    end = cruising(north=500.0 + corner.shift, east=corner.before - 5.0, course=math.pi / 2)
    assert Arc(corner, onto).aim(end, PARAMS).curvature < 0.5 / corner.radius
    middle = cruising(north=corner.centre[0] + 70 * math.cos(-math.pi / 4), east=corner.centre[1] + 70 * math.sin(-math.pi / 4))
    assert Arc(corner, onto).aim(middle, PARAMS).curvature == pytest.approx(1 / corner.radius)


def test_a_leg_without_length_still_has_a_direction():
    assert math.hypot(*Leg(A, A).along) == 1.0


def test_a_circle_begins_under_the_aircraft_and_in_its_direction():
    now = cruising(north=10.0, east=20.0, course=1.0)
    aim = Circle.ahead(now, 60.0, 90.0).aim(now, PARAMS)
    assert aim.error == pytest.approx(0.0, abs=1e-9)
    assert math.remainder(aim.course - 1.0, math.tau) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("wind", [(0.0, 0.0), (3.0, -2.0)])
def test_a_corner_is_flown_along_its_route(wind):
    corner, leg, onto = cornered()
    flyer = Kinematic(wind=wind)
    pieces = [leg, Arc(corner, onto), onto]

    def aim(now):
        if len(pieces) > 1 and pieces[0].is_flown((now.north, now.east)):
            pieces.pop(0)
        return pieces[0].aim(now, PARAMS)

    seen = flyer.follow(aim, 34.0)
    to_legs = [min(abs(n.east) if n.north < 500 else 1e9, abs(n.north - 500) if n.east > 0 else 1e9) for n in seen]
    assert max(to_legs) < corner.shift + 3.0
    assert abs(seen[-1].north - 500.0) < 1.0
