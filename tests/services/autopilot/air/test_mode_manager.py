"""Modes: what each flies, which changes are refused, and what a stop does."""

import pytest

from services.autopilot.air.mode_manager import ModeManager
from services.autopilot.air.mode_table import FlightMode
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.route import Place

FAR = [PlanItem(ItemKind.WAYPOINT, Place(900.0, 0.0, 70.0)), PlanItem(ItemKind.WAYPOINT, Place(900.0, 900.0, 70.0))]


def flying(items=FAR, **now):
    mode_manager = ModeManager(items)
    mode_manager.step(cruising(**now), PARAMS, 0.02)
    return mode_manager


def test_with_a_mission_it_starts_to_fly_it():
    assert flying().mode is FlightMode.MISSION


def test_without_a_mission_it_holds_where_it_is():
    mode_manager = flying([], north=100.0)
    assert mode_manager.mode is FlightMode.HOLD
    assert mode_manager.circle.centre.north == pytest.approx(100.0)
    assert mode_manager.circle.centre.east == pytest.approx(PARAMS.hold_radius)


def test_return_circles_home_at_a_safe_height():
    mode_manager = flying(north=40.0, height=35.0)
    mode_manager.change_mode(FlightMode.RETURN, "test")
    mode_manager.step(cruising(north=500.0, height=35.0), PARAMS, 0.02)
    assert mode_manager.circle.centre == Place(40.0, 0.0, PARAMS.return_altitude)


def test_the_height_of_return_counts_from_home():
    mode_manager = ModeManager(FAR, 120.0)
    mode_manager.step(cruising(height=150.0), PARAMS, 0.02)
    mode_manager.change_mode(FlightMode.RETURN, "test")
    mode_manager.step(cruising(north=500.0, height=150.0), PARAMS, 0.02)
    assert mode_manager.circle.centre.height == 120.0 + PARAMS.return_altitude


def test_return_does_not_descend():
    mode_manager = flying(height=150.0)
    mode_manager.change_mode(FlightMode.HOLD, "test")
    mode_manager.step(cruising(height=150.0), PARAMS, 0.02)
    mode_manager.change_mode(FlightMode.RETURN, "test")
    mode_manager.step(cruising(north=500.0, height=150.0), PARAMS, 0.02)
    assert mode_manager.circle.centre.height > 100.0


def test_mission_without_items_is_refused():
    mode_manager = flying([])
    assert "no mission" in mode_manager.change_mode(FlightMode.MISSION, "test")
    assert mode_manager.mode is FlightMode.HOLD


def test_a_goal_is_circled():
    mode_manager = flying()
    assert mode_manager.go_to(Place(300.0, 200.0, 90.0), "gcs", PARAMS) == ""
    mode_manager.step(cruising(), PARAMS, 0.02)
    assert mode_manager.circle.centre == Place(300.0, 200.0, 90.0)


def test_a_goal_on_the_ground_is_circled_at_the_present_height():
    mode_manager = flying()
    mode_manager.go_to(Place(300.0, 200.0, 0.0), "gcs", PARAMS)
    assert mode_manager.circle.centre.height == pytest.approx(60.0, abs=10.0)


def test_a_stop_holds_and_keeps_everything_else_out():
    mode_manager = flying()
    mode_manager.stop("gcs")
    assert mode_manager.mode is FlightMode.HOLD
    assert "stopped by gcs" in mode_manager.change_mode(FlightMode.MISSION, "test")
    assert "stopped by gcs" in mode_manager.go_to(Place(0.0, 0.0, 60.0), "test", PARAMS)


def test_after_its_release_it_holds_on_until_told():
    mode_manager = flying()
    mode_manager.stop("gcs")
    mode_manager.stop("")
    assert mode_manager.mode is FlightMode.HOLD
    assert mode_manager.reason == "stop released"
    assert mode_manager.change_mode(FlightMode.MISSION, "test") == ""


def test_the_mission_goes_on_with_the_item_it_was_left_at():
    mode_manager = flying()
    mode_manager.set_current(1)
    mode_manager.change_mode(FlightMode.HOLD, "test")
    mode_manager.step(cruising(), PARAMS, 0.02)
    mode_manager.change_mode(FlightMode.MISSION, "test")
    assert mode_manager.navigator.index == 1


def finished():
    mode_manager = flying()
    mode_manager.set_current(1)
    mode_manager.step(cruising(north=900.0, east=0.0), PARAMS, 0.02)
    mode_manager.step(cruising(north=900.0, east=901.0), PARAMS, 0.02)
    mode_manager.step(cruising(north=900.0, east=902.0), PARAMS, 0.02)
    return mode_manager


def test_a_completed_mission_holds():
    mode_manager = finished()
    assert (mode_manager.mode, mode_manager.reason) == (FlightMode.HOLD, "mission complete")


def test_a_completed_mission_begins_anew_when_asked_for():
    mode_manager = finished()
    assert mode_manager.change_mode(FlightMode.MISSION, "test") == ""
    assert mode_manager.navigator.index == 0


def test_a_return_item_ends_in_return():
    mode_manager = flying([PlanItem(ItemKind.RETURN, Place(0.0, 0.0, 0.0))])
    assert mode_manager.mode is FlightMode.RETURN


def test_a_new_mission_is_flown_at_once_and_no_mission_holds():
    mode_manager = flying()
    assert mode_manager.load([FAR[1]], PARAMS) == ""
    assert mode_manager.navigator.index == 0
    assert mode_manager.load([], PARAMS) == ""
    assert mode_manager.mode is FlightMode.HOLD


def test_a_mission_that_cannot_be_flown_is_refused_and_the_old_one_kept():
    mode_manager = flying()
    assert "jumps to 9" in mode_manager.load([PlanItem(ItemKind.JUMP, Place(0, 0, 0), jump_to=9)], PARAMS)
    assert len(mode_manager.navigator.items) == 2


def test_an_item_that_is_not_there_is_refused():
    assert "no item 5" in flying().set_current(5)
