"""Final approaches that a mission lays down: where they begin, their direction and slope, and which are refused."""

import math
from dataclasses import replace

import pytest

from uvf.guidance.approach import laid_down, with_courses
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.flyable import fault
from uvf.guidance.route import Place
from uvf.guidance.runways import LandingStrip, lane_by
from uvf.models.vehicle.flight_params import AirParams

PARAMS = AirParams()
TOUCH = Place(0.0, 0.0, 0.0)
MARK = PlanItem(ItemKind.LAND_START, TOUCH)
LAND = PlanItem(ItemKind.LAND, TOUCH)


def circle(north, east, height=40.0, radius=80.0):
    return PlanItem(ItemKind.ORBIT, Place(north, east, height), radius=radius, to_altitude=True)


def waypoint(north, east, height=40.0, **kw):
    return PlanItem(ItemKind.WAYPOINT, Place(north, east, height), **kw)


@pytest.mark.parametrize("radius", [80.0, -80.0])
@pytest.mark.parametrize("bearing", [0.3, 2.0, -2.5])
def test_a_circle_is_left_along_its_tangent_through_the_point_to_touch_at(radius, bearing):
    north, east = -400.0 * math.cos(bearing), -400.0 * math.sin(bearing)
    found = laid_down([circle(north, east, radius=radius), LAND], 1, PARAMS)
    along = math.cos(found.course), math.sin(found.course)
    begin = -found.length * along[0], -found.length * along[1]
    to_centre = north - begin[0], east - begin[1]
    assert math.hypot(*to_centre) == pytest.approx(80.0)
    right = along[0] * to_centre[1] - along[1] * to_centre[0]  # clockwise, the centre lies to the right
    assert right == pytest.approx(radius)
    assert found.slope == pytest.approx(40.0 / found.length)


def test_from_a_waypoint_of_the_pattern_it_leads_straight_on():
    found = laid_down([MARK, waypoint(-300.0, -300.0), LAND], 2, PARAMS)
    assert (found.course, found.length, found.radius) == (pytest.approx(math.pi / 4), pytest.approx(math.hypot(300, 300)), 0.0)


def test_what_lies_between_does_not_matter():
    items = [MARK, circle(0.0, -400.0), PlanItem(ItemKind.TRIGGER_DISTANCE, TOUCH), PlanItem(ItemKind.SPEED, TOUCH, speed=20.0), LAND]
    assert laid_down(items, 4, PARAMS) == laid_down([circle(0.0, -400.0), LAND], 1, PARAMS)


@pytest.mark.parametrize(
    "before",
    [
        [],
        [waypoint(0.0, -400.0)],  # no pattern
        [MARK, waypoint(0.0, -400.0), LAND, waypoint(0.0, -400.0)],  # that of another landing
        [MARK, waypoint(0.0, -400.0, hold=5.0)],
        [replace(circle(0.0, -400.0), to_altitude=False, turns=2.0)],
        [circle(0.0, -400.0), PlanItem(ItemKind.TAKEOFF, TOUCH)],
    ],
)
def test_otherwise_the_landing_is_the_aircraft_s_own(before):
    assert laid_down([*before, LAND], len(before), PARAMS) is None


def test_a_waypoint_is_passed_in_the_direction_of_the_approach_it_begins():
    items = [waypoint(0.0, -400.0), LAND, MARK, waypoint(0.0, -400.0), LAND]
    courses = [item.course for item in with_courses(items)]
    assert courses == [None, None, None, pytest.approx(math.pi / 2), None]
    own = [MARK, waypoint(0.0, -400.0, course=1.0), LAND]
    assert with_courses(own) == own


@pytest.mark.parametrize(
    ("items", "why"),
    [
        ([circle(0.0, -60.0), LAND], "item 1 lies within the circle of item 0, which leads to it: 60 m of 80 m"),
        ([MARK, waypoint(0.0, -100.0, 10.0), LAND], "item 2 has a final approach of 100 m from item 1: 152 m at least"),
        ([MARK, waypoint(0.0, -300.0, 90.0), LAND], "item 2 is approached at 16.7 degrees, 9.1 at most: put item 1 at 48 m"),
        ([MARK, waypoint(0.0, -300.0, -5.0), LAND], "item 2 lies no lower than item 1, from where it is approached"),
    ],
)
def test_what_cannot_be_flown_is_refused_with_the_item_and_the_remedy(items, why):
    assert fault(items, PARAMS).startswith(why)


def test_parameters_that_change_in_flight_never_leave_it_without_a_landing():
    """What is refused of a new mission may come true of the one that is flown."""
    short = [MARK, waypoint(0.0, -100.0, 10.0), LAND]
    assert laid_down(short, 2, PARAMS).length == pytest.approx(100.0)
    assert laid_down([circle(0.0, -60.0), LAND], 1, PARAMS) is None


def test_the_remedy_of_a_steep_approach_works():
    assert fault([MARK, waypoint(0.0, -300.0, 48.0), LAND], PARAMS) == ""


def test_the_lane_ends_where_the_strip_ends_if_it_leads_along_it():
    strip = LandingStrip(Place(0.0, 0.0, 2.0), math.pi / 2, 300.0, 12.0)
    there = Place(1.0, -100.0, 0.0)
    assert lane_by(there, math.pi / 2 + 0.05, [strip]).rest == pytest.approx(250.0)
    back = lane_by(there, -math.pi / 2, [strip])
    assert (back.rest, back.width, back.aim) == (pytest.approx(50.0), 12.0, Place(1.0, -100.0, 2.0))
    across = lane_by(there, 0.0, [strip])
    assert (across.aim, across.width) == (there, 30.0)
