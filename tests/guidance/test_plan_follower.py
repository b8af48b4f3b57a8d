"""A plan flown item by item on a kinematic aircraft."""

import itertools
import math

import pytest

from tests.services.autopilot.air.states import PARAMS, Kinematic
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.plan_follower import PlanFollower
from uvf.guidance.route import Place

SQUARE = [(500.0, 0.0), (500.0, 500.0), (0.0, 500.0), (0.0, 0.0)]


def waypoint(north, east, **more):
    return PlanItem(ItemKind.WAYPOINT, Place(north, east, 60.0), **more)


CIRCUIT = [*(waypoint(*p) for p in SQUARE), PlanItem(ItemKind.JUMP, Place(0, 0, 0), jump_to=0, repeat=-1)]


def fly(items, seconds, **kwargs):
    navigator = PlanFollower(items)
    navigator.resume()
    flyer = Kinematic(**kwargs)
    log = []

    def aim(now):
        log.append((navigator.index, now))
        return navigator.step(now, PARAMS, 0.02)[0]

    flyer.follow(aim, seconds)
    return navigator, log


def order(log):
    seen = []
    for index, _ in log:
        if not seen or seen[-1] != index:
            seen.append(index)
    return seen


def distance_to_square(now):
    inside = min(abs(now.north), abs(now.north - 500), abs(now.east), abs(now.east - 500))
    dn, de = max(-now.north, now.north - 500, 0.0), max(-now.east, now.east - 500, 0.0)
    return math.hypot(dn, de) if dn or de else inside


def test_a_circuit_is_flown_in_order_and_its_laps_are_counted():
    navigator, log = fly(CIRCUIT, 170.0)
    assert order(log)[:9] == [0, 1, 2, 3, 0, 1, 2, 3, 0]
    assert navigator.laps == 2


@pytest.mark.parametrize(("wind", "most"), [((0.0, 0.0), 12.0), ((3.0, 2.0), 15.0)])
def test_it_stays_near_the_legs_corners_included(wind, most):
    _, log = fly(CIRCUIT, 100.0, wind=wind)
    assert max(distance_to_square(now) for _, now in log) < most


def test_the_last_waypoint_finishes_the_mission():
    navigator, _ = fly([waypoint(200.0, 0.0), waypoint(400.0, 0.0)], 20.0)
    assert navigator.finished
    assert navigator.reached == 1


@pytest.mark.parametrize("radius", [100.0, -100.0])
def test_an_orbit_turns_as_often_and_the_way_it_is_told(radius):
    navigator, log = fly([PlanItem(ItemKind.ORBIT, Place(300.0, 0.0, 60.0), radius=radius, turns=2.0), waypoint(0.0, 0.0)], 90.0)
    on_orbit = [now for index, now in log if index == 0]
    bearings = [math.atan2(n.east, n.north - 300.0) for n in on_orbit]
    turned = sum(math.remainder(b - a, math.tau) for a, b in itertools.pairwise(bearings))
    assert turned * math.copysign(1.0, radius) == pytest.approx(2 * math.tau, abs=1.5)
    assert navigator.reached >= 0


@pytest.mark.parametrize("wind", [(0.0, 0.0), (-6.0, 4.0)])
@pytest.mark.parametrize("radius", [100.0, -100.0])
def test_a_circle_after_a_leg_is_touched_and_then_kept(wind, radius):
    _, log = fly([waypoint(400.0, 0.0), PlanItem(ItemKind.ORBIT, Place(300.0, 500.0, 60.0), radius=radius)], 60.0, wind=wind)
    outside = [math.hypot(now.north - 300.0, now.east - 500.0) - abs(radius) for index, now in log if index == 1]
    first = next(k for k, away in enumerate(outside) if away < 2.0)
    assert max(abs(away) for away in outside[first:]) < 3.0
    assert max(abs(now.roll) for _, now in log) < 1.15 * PARAMS.turn_bank


def test_from_one_circle_to_the_next_the_bank_changes_once():
    circles = [PlanItem(ItemKind.ORBIT, Place(300.0, e, 60.0), radius=100.0, turns=1.0) for e in (0.0, 500.0)]
    _, log = fly(circles, 70.0)
    left = next(k for k, (index, _) in enumerate(log) if index == 1)
    turning = [now.roll for _, now in log[left : left + 100]]
    assert min(turning) > 0.9 * turning[0], "it does not roll level first, and then turn"


def test_an_orbit_without_turns_never_ends():
    navigator, _ = fly([PlanItem(ItemKind.ORBIT, Place(300.0, 0.0, 60.0), radius=90.0), waypoint(0.0, 0.0)], 200.0)
    assert navigator.index == 0


def test_a_hold_time_is_circled_away():
    _, log = fly([waypoint(300.0, 0.0, hold=10.0), waypoint(900.0, 0.0)], 60.0)
    assert order(log) == [0, 1]
    left = next(k for k, (index, _) in enumerate(log) if index == 1) * 0.02
    assert left > 10.0 + 150.0 / 25.0


def test_a_tiny_orbit_is_widened_to_what_can_be_flown():
    _, log = fly([PlanItem(ItemKind.ORBIT, Place(300.0, 0.0, 60.0), radius=5.0)], 60.0)
    radius = math.hypot(log[-1][1].north - 300.0, log[-1][1].east)
    assert 30.0 < radius < 60.0


def test_a_chosen_item_is_flown_to_from_where_the_aircraft_is():
    navigator = PlanFollower(CIRCUIT)
    navigator.jump_to(2)
    assert navigator.index == 2
    aim, _ = navigator.step(Kinematic(north=250.0, east=250.0).estimate(), PARAMS, 0.02)
    assert aim.course == pytest.approx(math.atan2(250.0, -250.0), abs=0.01)


def test_a_speed_item_is_kept_for_the_legs_after_it():
    navigator, _ = fly([PlanItem(ItemKind.SPEED, Place(0, 0, 0), speed=21.0), waypoint(500.0, 0.0)], 1.0)
    assert navigator.speed == 21.0
