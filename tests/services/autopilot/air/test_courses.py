"""Waypoints with courses, legs too short for their corners, and what a mission does on the way, on a kinematic aircraft."""

import math

import numpy as np
import pytest

from tests.services.autopilot.air.states import PARAMS, Kinematic
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.plan_follower import PlanFollower
from uvf.guidance.route import Curve, Place

NOWHERE = Place(0.0, 0.0, 0.0)
COURSES = [(300, 0, 0), (500, 200, 90), (500, 250, -90), (300, -100, 200), (-100, -100, 20), (100, 100, 180), (0, 300, 45)]


def waypoint(north, east, degrees=None, height=60.0, **more):
    return PlanItem(ItemKind.WAYPOINT, Place(north, east, height), course=None if degrees is None else math.radians(degrees), **more)


class Flight:
    """Flies a list of items to their end; (k, 4) north, east, course, height wanted and the pieces, distances and times of it."""

    def __init__(self, items, seconds=200.0, wind=(0.0, 0.0), start=0, **kinematic):
        self.navigator = PlanFollower(items)
        self.navigator.jump_to(start)
        self.rows, self.errors, self.pieces, self.reached = [], [], [], []
        self._last = None
        Kinematic(wind=wind, **kinematic).follow(self._aim, seconds)
        self.rows, self.errors = np.array(self.rows), np.array(self.errors)

    def _aim(self, now):
        if self.navigator.finished:
            return self._last
        self._last, level = self.navigator.step(now, PARAMS, 0.02)
        self.rows.append((now.north, now.east, now.course, level.height))
        self.errors.append(self._last.error)
        self.pieces.append(type(self.navigator._piece))
        if self.navigator.reached not in self.reached:
            self.reached.append(self.navigator.reached)
        return self._last

    def miss(self, north, east):
        return np.hypot(self.rows[:, 0] - north, self.rows[:, 1] - east).min()


@pytest.mark.parametrize("wind", [(0.0, 0.0), (-5.0, 5.0)])
def test_every_course_is_flown_at_its_place_without_overshoot(wind):
    flight = Flight([waypoint(*c) for c in COURSES], wind=wind)
    assert flight.reached == [-1, 0, 1, 2, 3, 4, 5, 6]
    assert flight.navigator.finished
    settled = flight.errors[500:]
    assert np.abs(settled).max() < 2.0
    for north, east, degrees in COURSES[1:]:
        at = np.hypot(flight.rows[:, 0] - north, flight.rows[:, 1] - east) < 2.5
        off = np.remainder(flight.rows[at, 2] - math.radians(degrees) + math.pi, math.tau) - math.pi
        assert np.abs(off).min() < 0.1


def test_what_is_left_of_a_path_can_be_drawn():
    navigator = PlanFollower([waypoint(200, 0, 0), waypoint(500, 300, 90, height=100.0)])
    navigator.resume()
    navigator.step(Kinematic().estimate(), PARAMS, 0.02)
    ahead = navigator.curve_ahead()
    assert len(ahead) == 19 or len(ahead) == 20
    assert (ahead[0].north, ahead[0].east) == pytest.approx((0.0, 0.0), abs=0.1)
    assert ahead[-1].north == pytest.approx(190.0, abs=1.0)


def test_the_aim_does_not_jump_where_one_path_ends_and_the_next_begins():
    flight = Flight([waypoint(*c) for c in COURSES])
    assert np.abs(np.diff(flight.errors)).max() < 0.1


def test_heights_change_in_a_straight_line_along_a_path():
    flight = Flight([waypoint(200, 0, 0), waypoint(500, 300, 90, height=100.0)])
    assert flight.pieces[-1] is Curve
    way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(flight.rows[:, :2], axis=0).T))))
    second = (flight.rows[:, 3] > 60.01) & (flight.rows[:, 3] < 99.9)
    slope = np.diff(flight.rows[second, 3]) / np.diff(way[second])
    assert slope == pytest.approx(np.full(len(slope), np.median(slope)), rel=0.15)
    assert flight.rows[-1, 3] == pytest.approx(100.0, abs=0.3)


def test_items_with_and_without_a_course_follow_one_another():
    items = [waypoint(300, 0), waypoint(500, 200, 90), waypoint(300, 500), waypoint(0, 400), waypoint(-100, 0, 0)]
    flight = Flight(items)
    assert flight.navigator.finished
    assert np.abs(flight.errors).max() < 2.0
    assert flight.miss(500, 200) < 2.5
    assert flight.miss(-100, 0) < 2.5


def test_the_rows_of_a_survey_are_each_flown_from_end_to_end():
    rows = [(500, 0), (500, 40), (0, 40), (0, 80), (500, 80), (500, 120), (0, 120)]
    flight = Flight([waypoint(*p) for p in rows], north=-100.0)
    assert np.abs(flight.errors).max() < 2.5
    for east in (0, 40, 80, 120):
        assert max(flight.miss(north, east) for north in (100, 250, 400)) < 3.0


@pytest.mark.parametrize(
    "items",
    [
        [waypoint(300, 0), waypoint(340, 15), waypoint(370, 45), waypoint(385, 90), waypoint(385, 500)],
        [waypoint(300, 0), waypoint(335, 20), waypoint(700, 20)],
    ],
)
def test_short_legs_are_passed_in_one_sweep(items):
    flight = Flight(items, north=-100.0)
    assert flight.navigator.finished
    turned = np.abs(np.diff(np.unwrap(flight.rows[:, 2]))).sum()
    assert turned < 2.5  # no loop
    assert max(flight.miss(*item.place.point) for item in items) < 16.0
    assert np.abs(flight.errors).max() < 2.0


def test_a_corner_too_sharp_to_round_is_flown_past_on_a_planned_curve():
    flight = Flight([waypoint(400, 0), waypoint(0, 20), waypoint(500, 40)])
    assert Curve in flight.pieces
    assert np.abs(flight.errors).max() < 2.5
    assert flight.miss(400, 0) < 15.0


def test_an_acceptance_radius_is_kept_by_flying_over_the_waypoint():
    items = [waypoint(400, 0), waypoint(400, 600), waypoint(0, 600)]
    near = [waypoint(400, 0, acceptance=4.0), waypoint(400, 600, acceptance=4.0), waypoint(0, 600)]
    assert Flight(items).miss(400, 0) > 4.0
    assert max(Flight(near).miss(*p) for p in ((400, 0), (400, 600))) < 4.0


def test_waypoints_at_one_place_are_one():
    flight = Flight([waypoint(400, 0), waypoint(400, 0), waypoint(400, 400), waypoint(400, 400.3), waypoint(0, 400)])
    assert flight.navigator.finished
    assert np.abs(np.diff(np.unwrap(flight.rows[:, 2]))).sum() < 5.0
    assert np.abs(flight.errors).max() < 2.0


def test_the_speed_of_an_item_holds_for_one_that_is_chosen_after_it():
    items = [waypoint(400, 0), PlanItem(ItemKind.SPEED, NOWHERE, speed=21.0), waypoint(800, 0), waypoint(800, 400)]
    navigator = PlanFollower(items)
    navigator.jump_to(3)
    assert navigator.speed == 21.0
    navigator.jump_to(0)
    assert navigator.speed == 0.0


def test_a_circle_to_an_altitude_is_left_there_and_not_before():
    items = [PlanItem(ItemKind.ORBIT, Place(300.0, 0.0, 62.5), radius=90.0, to_altitude=True), waypoint(900, 0)]
    low = PlanFollower(items)
    low.resume()
    Kinematic().follow(lambda now: low.step(now, PARAMS, 0.02)[0], 60.0)
    assert low.index == 0
    high = [PlanItem(ItemKind.ORBIT, Place(300.0, 0.0, 61.5), radius=90.0, to_altitude=True), waypoint(900, 0)]
    assert Flight(high, 60.0).navigator.finished


def test_pictures_are_taken_each_distance_between_the_items_that_say_so():
    items = [
        waypoint(200, 0),
        PlanItem(ItemKind.TRIGGER_DISTANCE, NOWHERE, distance=50.0),
        waypoint(700, 0),
        PlanItem(ItemKind.TRIGGER_DISTANCE, NOWHERE, distance=0.0),
        waypoint(900, 0),
        PlanItem(ItemKind.TRIGGER, NOWHERE),
        waypoint(1000, 0),
    ]
    flight = Flight(items)
    assert flight.navigator.camera.pictures == 1 + 9 + 1  # the tenth distance ends a few steps behind the waypoint
    assert flight.navigator.camera.last[0] == pytest.approx(900.0, abs=2.0)


def test_after_the_mission_no_more_pictures_are_taken():
    navigator = Flight([PlanItem(ItemKind.TRIGGER_DISTANCE, NOWHERE, distance=50.0), waypoint(200, 0)]).navigator
    before = navigator.camera.pictures
    navigator.camera.step((5000.0, 0.0))
    assert navigator.camera.pictures == before > 0
