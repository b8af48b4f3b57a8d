"""A mission flown ahead: the path that the plan follower means to fly, and when each item is passed."""

import math

import numpy as np
import pytest

from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.mission_preview import PreviewFlight, places_passed, preview
from uvf.guidance.route import Place
from uvf.models.vehicle.flight_params import AirParams

PARAMS = AirParams()
CORNERS = ((-150.0, 200.0), (150.0, 200.0), (150.0, -200.0), (-150.0, -200.0))
FOR_EVER = PlanItem(ItemKind.JUMP, Place(0.0, 0.0, 0.0), jump_to=0, repeat=-1)


def waypoint(north, east, height=60.0, **more):
    return PlanItem(ItemKind.WAYPOINT, Place(north, east, height), **more)


CIRCUIT = [*(waypoint(n, e) for n, e in CORNERS), FOR_EVER]


@pytest.mark.parametrize("wind", [(0.0, 0.0), (4.0, -3.0)])
def test_a_circuit_is_flown_once_round_near_its_legs(wind):
    flown = preview(CIRCUIT, PARAMS, wind)
    assert [item for item, _ in flown.passed] == [0, 1, 2, 3, 0] and flown.goes_on
    north, east = np.abs(flown.points[:, 0]), np.abs(flown.points[:, 1])
    outside = np.maximum(north - 150.0, east - 200.0)
    assert outside.max() < 15.0
    assert flown.s[-1] == pytest.approx(1400.0, rel=0.08)
    assert flown.t[-1] == pytest.approx(1400.0 / 25.0, rel=0.15)


def test_corners_are_rounded_no_tighter_than_the_bank_allows():
    flown = preview(CIRCUIT, PARAMS)
    course = np.unwrap(np.arctan2(*np.diff(flown.points[:, :2], axis=0).T[::-1]))
    rate = np.abs(np.diff(course)) / np.diff(flown.t)[:-1]
    assert rate.max() <= 9.81 * math.tan(PARAMS.bank_limit) / PARAMS.trim_airspeed * 1.01


def test_heights_are_climbed_to_no_faster_than_the_aircraft_can():
    flown = preview([waypoint(0.0, 0.0, 60.0), waypoint(100.0, 0.0, 260.0), waypoint(2000.0, 0.0, 260.0)], PARAMS)
    climb = np.diff(flown.points[:, 2]) / np.diff(flown.t)
    assert climb.max() == pytest.approx(PARAMS.climb_max, rel=0.01)
    heights = [height for _, _, height in places_passed(flown)]
    assert heights[0] < 100.0 and heights[-1] == pytest.approx(260.0, abs=2.0)


def test_a_circle_without_end_is_drawn_once_round():
    flown = preview([waypoint(0.0, 0.0), PlanItem(ItemKind.ORBIT, Place(300.0, 300.0, 80.0), radius=100.0)], PARAMS)
    assert flown.goes_on
    away = np.hypot(flown.points[:, 0] - 300.0, flown.points[:, 1] - 300.0)
    assert (np.abs(away[-60:] - 100.0) < 6.0).all()
    assert flown.t[-1] < 60.0


def test_it_can_be_made_some_steps_at_a_time():
    whole, flight, calls = preview(CIRCUIT, PARAMS), PreviewFlight(CIRCUIT, PARAMS), 0
    while not flight.advance(7):
        calls += 1
    assert calls > 20
    assert np.array_equal(flight.so_far.points, whole.points) and flight.so_far.passed == whole.passed


@pytest.mark.parametrize("items", [[], [PlanItem(ItemKind.LAND, Place(0.0, 0.0, 0.0))], [FOR_EVER]])
def test_without_a_place_there_is_nothing_to_show(items):
    flown = preview(items, PARAMS)
    assert flown.points.shape == (0, 3) and len(flown.s) == 0
