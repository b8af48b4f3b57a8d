"""What cannot be flown is refused with the item, the reason and what would mend it; the rest is flown."""

import math
import re

import pytest
from msgspec.structs import replace

from tests.services.autopilot.air.states import PARAMS
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.flyable import advice, fault
from uvf.guidance.route import Place

HERE = Place(0.0, 0.0, 60.0)


def waypoint(north=0.0, east=0.0, **more):
    return PlanItem(ItemKind.WAYPOINT, Place(north, east, 60.0), **more)


def speed(value):
    return PlanItem(ItemKind.SPEED, HERE, speed=value)


@pytest.mark.parametrize("kind", [ItemKind.TAKEOFF, ItemKind.LAND])
def test_an_airship_neither_takes_off_nor_lands(kind):
    items = [waypoint(), PlanItem(kind, HERE)]
    assert fault(items, replace(PARAMS, law="airship")).startswith(f"item 1 is a {kind.name.lower()}: an airship does neither by itself")
    assert fault(items[:1], replace(PARAMS, law="airship")) == ""


@pytest.mark.parametrize(
    ("items", "why"),
    [
        ([waypoint(), PlanItem(ItemKind.JUMP, HERE, jump_to=7)], "item 1 jumps to 7, but there are 2 items"),
        ([speed(5.0)], "item 0 sets a speed of 5 m/s; this aircraft flies 19 to 32 m/s"),
        ([waypoint(), speed(40.0)], "item 1 sets a speed of 40 m/s"),
        ([waypoint(hold=10.0, course=1.0)], "item 0 has a hold time and a course"),
        (
            [PlanItem(ItemKind.ORBIT, HERE, radius=-30.0)],
            "item 0 is a circle of 30 m, too tight at 25 m/s: give at least 37 m or at most 22.6 m/s",
        ),
        ([PlanItem(ItemKind.ORBIT, HERE, radius=5.0)], r"item 0 is a circle of 5 m, .* at least 37 m \(0 = the aircraft's own\)"),
        ([speed(30.0), PlanItem(ItemKind.ORBIT, HERE, radius=45.0)], "item 1 is a circle of 45 m, too tight at 30 m/s"),
        ([waypoint(hold=5.0, radius=20.0)], "item 0 is a circle of 20 m"),
    ],
)
def test_a_fault_is_named_with_its_item_and_what_mends_it(items, why):
    assert re.match(why, fault(items, PARAMS)), fault(items, PARAMS)


@pytest.mark.parametrize(
    "items",
    [
        [waypoint(), PlanItem(ItemKind.JUMP, HERE, jump_to=0, repeat=-1)],
        [waypoint(0.0), waypoint(40.0), waypoint(40.0, 40.0), waypoint(0.0, 40.0)],
        [waypoint(0.0), waypoint(400.0), waypoint(10.0)],
        [waypoint(course=0.0), waypoint(20.0, course=math.pi)],
        [speed(21.0), PlanItem(ItemKind.ORBIT, HERE, radius=30.0)],
        [PlanItem(ItemKind.ORBIT, HERE)],
    ],
)
def test_what_can_be_flown_with_a_longer_way_round_is_not_refused(items):
    assert fault(items, PARAMS) == ""


def test_a_leg_too_short_for_its_corners_is_pointed_out_with_what_they_take():
    ((what, why),) = advice([waypoint(0.0), waypoint(400.0), waypoint(400.0, 40.0), waypoint(400.0, 500.0)], PARAMS)
    assert what == "item 1: a curve is flown past it"
    assert re.fullmatch(r"a corner of 90 degrees takes \d+ and \d+ m of its legs at 25 m/s; they are 400 and 40 m", why)


def test_an_acceptance_radius_that_rounding_does_not_keep_is_pointed_out():
    ((_, why),) = advice([waypoint(0.0), waypoint(400.0, acceptance=2.0), waypoint(400.0, 400.0)], PARAMS)
    assert why.startswith("a corner of 90 degrees passes it at ")
    assert why.endswith("2 m are accepted")


def test_a_leg_long_enough_is_not_pointed_out():
    assert list(advice([waypoint(0.0), waypoint(400.0), waypoint(400.0, 400.0), waypoint(0.0, 400.0)], PARAMS)) == []


def test_too_sharp_a_corner_is_pointed_out():
    assert list(advice([waypoint(0.0), waypoint(400.0), waypoint(0.0, 5.0)], PARAMS)) == [
        ("item 1: a curve is flown past it", "a corner of 179 degrees is too sharp to be rounded")
    ]


@pytest.mark.parametrize(("height", "name"), [(160.0, "climb_max"), (20.0, "sink_max")])
def test_a_slope_steeper_than_the_aircraft_climbs_or_sinks_is_pointed_out(height, name):
    most = getattr(PARAMS, name)
    way = abs(height - HERE.height) * 25.0 / most
    end = [PlanItem(ItemKind.WAYPOINT, Place(0.0, length, height)) for length in (0.8 * way, 1.1 * way)]
    ((what, why),) = advice([PlanItem(ItemKind.WAYPOINT, Place(0.0, 0.0, HERE.height)), end[0]], PARAMS)
    assert what == "item 1: its height is not reached on the way there"
    assert re.fullmatch(rf"the slope is \d\.\d m/s at 25 m/s, {name} is {most:g} m/s: make the leg {math.ceil(way)} m long, or slower", why)
    assert list(advice([PlanItem(ItemKind.WAYPOINT, Place(0.0, 0.0, HERE.height)), end[1]], PARAMS)) == []
