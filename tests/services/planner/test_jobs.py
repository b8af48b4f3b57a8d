"""Which job comes first, and where the mission leads."""

import pytest

from schemas.messages import Mission, MissionItem, MissionProgress, Mode, RallyPoints, Vector3, VehicleStatus
from services.planner.jobs import EXPLORE, IDLE, Errand, Goal, Orders, ReturnPoints, choose, mission_target, not_now

HOME = (1.0, 2.0)
READY = VehicleStatus(mode=Mode.MODE_MISSION, armed=True)
MISSION = Mission(id=5, items=[MissionItem(position=Vector3(x=7.0, y=8.0)), MissionItem(kind=MissionItem.RETURN)])


def progress(**fields):
    return MissionProgress(**{"state": MissionProgress.ACTIVE, "mission_id": 5, **fields})


def test_the_order_is_return_goal_mission_explore_idle():
    goal, target = Errand("goal", (Goal((3.0, 3.0), 0.5),)), (7.0, 8.0)
    returning = VehicleStatus(mode=Mode.MODE_RETURN)
    assert choose(returning, goal, target, Orders(HOME, explores=True)).target == HOME
    assert choose(READY, goal, target, Orders(HOME, explores=True)).name == "goal"
    assert choose(READY, None, target, Orders(HOME, explores=True)).name == "mission"
    assert choose(READY, None, None, Orders(HOME, explores=True)) == EXPLORE
    assert choose(READY, None, None, Orders(HOME, explores=False)) == IDLE


def test_the_mission_leads_to_its_current_item():
    assert mission_target(MISSION, progress(current=0), HOME) == (7.0, 8.0)
    assert mission_target(MISSION, progress(current=1), HOME) == HOME


@pytest.mark.parametrize(
    "wrong", [{"mission_id": 4}, {"current": 2}, {"state": MissionProgress.COMPLETE}, {"state": MissionProgress.PAUSED}]
)
def test_without_an_active_item_of_this_mission_there_is_no_target(wrong):
    assert mission_target(MISSION, progress(**wrong), HOME) is None


def test_a_goal_waits_for_a_vehicle_that_may_drive():
    assert not_now(READY) == ""
    assert "silent" in not_now(None)
    assert "STOP ALL" in not_now(VehicleStatus(mode=Mode.MODE_MISSION, armed=True, stopped=True))
    assert "arm" in not_now(VehicleStatus(mode=Mode.MODE_MISSION))
    assert "HOLD" in not_now(VehicleStatus(mode=Mode.MODE_HOLD, armed=True))


def test_the_way_back_leads_to_what_is_nearest_when_it_begins_and_does_not_change_on_the_way():
    returning, return_points = VehicleStatus(mode=Mode.MODE_RETURN), ReturnPoints()
    rally = RallyPoints(points=[Vector3(x=10.0), Vector3(y=10.0)])
    assert return_points.step(READY, (9.0, 0.0), HOME, rally) == (10.0, 0.0)
    assert return_points.step(returning, (9.0, 0.0), HOME, rally) == (10.0, 0.0)
    assert return_points.step(returning, (0.0, 9.0), HOME, rally) == (10.0, 0.0)
    assert return_points.step(READY, (0.0, 9.0), HOME, rally) == (0.0, 10.0)
    assert return_points.step(returning, (0.0, 9.0), HOME, None) == HOME  # taken away on the way


A, B, C = Goal((1.0, 0.0)), Goal((2.0, 0.0)), Goal((3.0, 0.0))


def driven(errand, *outcomes):
    """Where an errand leads, place by place, with what becomes of each."""
    seen = []
    for reached in outcomes:
        if errand is None:
            break
        seen.append(errand.goal)
        errand = errand.after(reached)
    return seen, errand


def test_waypoints_end_at_the_last_and_a_patrol_begins_again():
    assert driven(Errand("waypoints", (A, B, C)), True, True, True) == ([A, B, C], None)
    seen, left = driven(Errand("patrol", (A, B, C), repeats=True), *[True] * 5)
    assert seen == [A, B, C, A, B]
    assert left.goal == C


def test_a_place_that_cannot_be_reached_is_left_out_and_none_at_all_ends_it():
    seen, left = driven(Errand("patrol", (A, B, C), repeats=True), True, False, True, True, False, False, False)
    assert seen == [A, B, C, A, B, C, A]
    assert left is None
    assert driven(Errand("goal", (A,)), False) == ([A], None)
