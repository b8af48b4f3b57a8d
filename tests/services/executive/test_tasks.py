"""Tasks are done in their order, end as they say, and tell why where they fail."""

import re

import numpy as np
import pytest

from schemas.messages import Circle, Grid, MissionProgress, Mode, NavStatus, TaskStatus, Vector3
from services.executive.actions.joystick import DriveTrack
from services.executive.asking import PATIENCE
from tests.services.executive.team import Team
from uvf.maths.se2 import IDENTITY
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import planar_frame, planar_pose

GOAL = "  - {name: go, goal: {vehicle: anne, x: 4.0, y: 1.7}}\n"


def test_a_vehicle_is_armed_brought_into_its_mode_and_told_where_to_go(tmp_path):
    team = Team(GOAL, tmp_path)
    team.step(10)
    assert team.requests() == ["arm anne", "mode anne", "goal anne"]
    assert (team.asked[1][2].mode, team.asked[2][2].position.x) == (Mode.MODE_MISSION, 4.0)
    assert team.states() == ["RUNNING"]
    team.arrive("anne")
    team.step(2)
    assert (team.states(), team.tasks.state, team.tasks.tasks[0].reason) == (["DONE"], TaskStatus.DONE, "")
    assert team.events == ["task go begins", "task go is done"]


def test_a_goal_that_is_given_up_fails_with_the_planners_reason(tmp_path):
    team = Team(GOAL, tmp_path)
    team.step(10)
    team.give_up("anne", "walls all about")
    team.step(2)
    assert team.tasks.state == TaskStatus.FAILED
    assert team.tasks.tasks[0].reason == "anne: walls all about"


def test_another_goal_than_its_own_is_not_taken_for_it(tmp_path):
    team = Team(GOAL, tmp_path)
    team.step(10)
    team.nav["anne"] = NavStatus(job="goal", state=NavStatus.REACHED)
    team.nav["anne"].goal.x = 1.0
    team.step(2)
    assert team.tasks.tasks[0].reason == "anne: somebody else has sent it to (1, 0)"


def test_a_refusal_is_asked_again_and_then_is_the_reason(tmp_path):
    team = Team(GOAL, tmp_path)
    team.refusals["goal", "anne"] = "the vehicle is outside its map"
    team.step(60)
    assert team.states() == ["RUNNING"]
    del team.refusals["goal", "anne"]
    team.step(20)
    team.arrive("anne")
    team.step(2)
    assert team.states() == ["DONE"]

    team = Team(GOAL, tmp_path)
    team.refusals["arm", "anne"] = "it lies on its side"
    team.step(round(PATIENCE * 10) + 30)
    assert (team.states(), team.tasks.tasks[0].reason) == (["FAILED"], "anne: it lies on its side")


def test_a_task_waits_for_its_condition_and_says_for_what(tmp_path):
    team = Team("  - {name: late, when: {vehicle: team, reaches: {x: 5.0, y: 5.0, within: 0.5}}, disarm: bert}\n", tmp_path)
    team.step(12)
    assert (team.states(), team.tasks.tasks[0].reason) == (["WAITING"], "waits until anne or bert is within 0.5 m of (5, 5)")
    assert team.asked == []
    team.places["bert"] = (5.2, 4.9)
    team.step(3)
    assert team.states() == ["DONE"]


@pytest.mark.parametrize(
    ("condition", "change"),
    [
        ("{at: 3.0}", lambda team: None),
        ("{after: 2.0}", lambda team: None),
        ("{vehicle: anne, near: {vehicle: bert, within: 1.0}}", lambda team: team.places.update(anne=(7.5, 4.4))),
        ("{vehicle: carl, item: 2}", lambda team: team.progress.update(carl=MissionProgress(reached=2))),
        ("{vehicle: anne, mode: offboard}", lambda team: setattr(team.status["anne"], "mode", Mode.MODE_OFFBOARD)),
        ("{vehicle: carl, landed: true}", lambda team: setattr(team.status["carl"], "landed", True)),
        ("{vehicle: anne, fails: true}", lambda team: team.status["anne"].failsafes.append("stuck")),
        ("{vehicle: bert, merged: true}", lambda team: team.map_place.update(anne=planar_frame(0.0, "bert/map", "anne/map", IDENTITY))),
        ("{vehicle: anne, merged: true}", lambda team: team.map_place.update(anne=planar_frame(0.0, "bert/map", "anne/map", IDENTITY))),
        ("{vehicle: anne, charge_below: 0.2}", lambda team: setattr(team.status["anne"], "battery_remaining", 0.1)),
        ("{vehicle: anne, explored: 0.9}", lambda team: team.nav.update(anne=NavStatus(explored=0.95))),
    ],
)
def test_each_condition_holds_once_it_is_so_and_not_before(tmp_path, condition, change):
    team = Team(f"  - {{name: a, when: {condition}}}\n", tmp_path)
    team.step(10)
    assert team.states() == ["WAITING"]
    change(team)
    team.step(30)
    assert team.states() == ["DONE"]


def test_a_sequence_fails_with_its_part_and_a_fallback_goes_on_to_the_next(tmp_path):
    tree = """  - fallback:
      - {name: first, goal: {vehicle: anne, x: 4.0, y: 1.7}}
      - {name: second, goal: {vehicle: anne, x: 5.0, y: 1.7}}
  - {name: after, goal: {vehicle: bert, x: 6.0, y: 1.7}}
"""
    team = Team(tree, tmp_path)
    team.step(10)
    team.give_up("anne", "walls")
    team.step(10)
    assert team.states() == ["RUNNING", "FAILED", "RUNNING", "WAITING"]
    team.arrive("anne")
    team.step(10)
    assert team.states() == ["DONE", "FAILED", "DONE", "RUNNING"]
    team.give_up("bert", "walls")
    team.step(2)
    assert team.tasks.state == TaskStatus.FAILED


def test_parallel_tasks_run_at_once_and_the_failure_of_one_stops_the_others(tmp_path):
    tree = """  - parallel:
      - {name: one, goal: {vehicle: anne, x: 4.0, y: 1.7}}
      - {name: other, goal: {vehicle: bert, x: 5.0, y: 1.7}}
"""
    team = Team(tree, tmp_path)
    team.step(10)
    assert team.states() == ["RUNNING"] * 3
    team.arrive("anne")
    team.step(10)
    assert team.states() == ["RUNNING", "DONE", "RUNNING"]

    team = Team(tree, tmp_path)
    team.step(10)
    team.give_up("bert", "walls")
    team.step(2)
    assert team.states() == ["FAILED", "STOPPED", "FAILED"]


def test_a_task_ends_by_until_and_fails_after_within(tmp_path):
    team = Team("  - {name: behind, follow: {vehicle: bert, leader: anne}, until: {vehicle: anne, reaches: {x: 4.0, y: 1.7}}}\n", tmp_path)
    team.step(20)
    assert team.states() == ["RUNNING"]
    team.places["anne"] = (4.0, 1.7)
    team.step(2)
    assert team.states() == ["DONE"]

    team = Team("  - {name: slow, within: 3.0, goal: {vehicle: anne, x: 4.0, y: 1.7}}\n", tmp_path)
    team.step(40)
    assert (team.states(), team.tasks.tasks[0].reason.split(":")[0]) == (["FAILED"], "not done within 3 s")


@pytest.mark.parametrize("request_", ["arm", "mode", "follow"])
def test_what_was_refused_until_its_end_has_failed(tmp_path, request_):
    team = Team("  - {name: behind, follow: {vehicle: bert, leader: anne}, until: {at: 1.5}}\n", tmp_path)
    team.refusals[request_, "bert"] = "no"
    team.step(20)
    assert (team.states(), team.tasks.tasks[0].reason) == (["FAILED"], "bert: no")


def test_what_is_ended_is_cancelled_before_the_vehicle_is_asked_for_the_next(tmp_path):
    follow = "  - {name: behind, follow: {vehicle: bert, leader: anne}, until: {vehicle: anne, reaches: {x: 4.0, y: 1.7}}}\n"
    team = Team(follow + "  - {name: home, goal: {vehicle: bert, x: 8.0, y: 4.4}}\n", tmp_path)
    team.step(20)
    team.places["anne"] = (4.0, 1.7)
    team.step(10)
    asked = [name for name, vehicle, _ in team.asked if vehicle == "bert" and name in ("follow", "cancel", "goal")]
    assert asked == ["follow", "cancel", "goal"]
    assert team.states() == ["DONE", "RUNNING"]


def test_what_somebody_else_has_told_the_vehicle_is_not_cancelled(tmp_path):
    team = Team("  - {name: behind, follow: {vehicle: bert, leader: anne}, until: {vehicle: anne, reaches: {x: 4.0, y: 1.7}}}\n", tmp_path)
    team.step(20)
    team.nav["bert"] = NavStatus(job="goal", state=NavStatus.DRIVING)
    team.places["anne"] = (4.0, 1.7)
    team.step(5)
    assert "cancel bert" not in team.requests()


def test_a_repeated_task_is_done_so_often(tmp_path):
    team = Team("  - {name: twice, repeat: 2, goal: {vehicle: anne, x: 4.0, y: 1.7}}\n", tmp_path)
    team.step(10)
    team.arrive("anne")
    team.step(10)
    assert team.requests().count("goal anne") == 2
    assert team.states() == ["RUNNING"]
    team.arrive("anne")
    team.step(2)
    assert team.states() == ["DONE"]


def test_several_that_follow_are_a_column(tmp_path):
    team = Team("  - {follow: {vehicle: team, leader: carl, distance: 2.0}, until: {at: 90}}\n", tmp_path)
    team.step(10)
    assert [(v, m.vehicle, m.distance) for name, v, m in team.asked if name == "follow"] == [("anne", "carl", 2.0), ("bert", "anne", 2.0)]


def test_one_joystick_drives_several_alike_and_they_stand_when_it_ends_or_is_stopped(tmp_path):
    track = DriveTrack(np.array([0.0, 0.5, 1.0]), np.array([0.1, 0.2, 0.0]), np.array([0.0, -0.3, 0.0]))
    (tmp_path / "a.csv").write_text("t,linear,angular\n")
    drive = "  - {name: d, drive: {vehicle: team, track: a.csv}%s}\n"
    team = Team(drive % "", tmp_path, {"a.csv": track})
    team.step(30)
    sent = [d["anne"] for d in team.drives if d]
    assert all(d["anne"] == d["bert"] for d in team.drives if d)
    assert list(dict.fromkeys(sent)) == [(0.0, 0.0), (0.1, 0.0), (0.2, -0.3)]
    assert (sent[-1], team.states()) == ((0.0, 0.0), ["DONE"])

    team = Team(drive % ", until: {at: 1.0}", tmp_path, {"a.csv": track})
    team.step(12)
    assert [d for d in team.drives if d][-1] == {"anne": (0.0, 0.0), "bert": (0.0, 0.0)}


def test_a_mission_and_an_exploration_are_done_when_they_say_so(tmp_path):
    team = Team("  - {name: fly, mission: carl}\n  - {name: look, explore: anne}\n", tmp_path)
    team.progress["carl"] = MissionProgress(state=MissionProgress.ACTIVE, current=1, total=3)
    team.step(12)
    assert (team.tasks.tasks[0].reason, team.states()) == ("item 1 of 3", ["RUNNING", "WAITING"])
    team.progress["carl"].state = MissionProgress.COMPLETE
    team.nav["anne"] = NavStatus(job="explore", explored=0.5)
    team.step(20)
    assert (team.tasks.tasks[1].reason, team.states()) == ("50 % explored", ["DONE", "RUNNING"])
    team.nav["anne"].explored = 1.0
    team.step(40)
    assert team.states() == ["DONE", "DONE"]


def test_a_mission_that_is_not_there_fails(tmp_path):
    team = Team("  - {mission: bert}\n", tmp_path)
    team.progress["bert"] = MissionProgress(state=MissionProgress.NO_MISSION)
    team.step(10)
    assert team.tasks.tasks[0].reason == "bert has no mission: give its job one"


def test_places_are_shared_out_and_each_drives_its_tour(tmp_path):
    team = Team("  - {name: visit, visit: {vehicle: team, places: [[1, 1], [2, 2], [7, 3]]}}\n", tmp_path)
    team.step(20)
    tours = {vehicle: [place.x for place in message.places] for name, vehicle, message in team.asked if name == "route"}
    assert sorted(x for tour in tours.values() for x in tour) == [1.0, 2.0, 7.0]
    assert set(tours) == {"anne", "bert"}
    for vehicle, tour in tours.items():
        team.nav[vehicle].route_at = len(tour) - 1
        team.arrive(vehicle)
    team.step(2)
    assert team.states() == ["DONE"]


def test_an_executive_that_is_started_again_goes_on_behind_what_was_done(tmp_path):
    tree = GOAL + "  - {name: then, goal: {vehicle: bert, x: 6.0, y: 1.7}}\n"
    team = Team(tree, tmp_path)
    team.step(10)
    team.arrive("anne")
    team.step(10)
    assert team.states() == ["DONE", "RUNNING"]
    left = team.tasks
    team.service, team.asked = team.made(), []
    team.service.recall(team.service.Recalls(tasks=left))
    team.step(10)
    assert team.requests() == ["goal bert"]
    assert team.states() == ["DONE", "RUNNING"]


SHARE = """
  - {name: share, share_map: {vehicle: carl, to: team, area: [0.0, 0.0, 10.0, 5.0]}}
"""


def test_a_map_is_asked_for_and_handed_over_to_the_whole_team(tmp_path):
    team = Team(SHARE, tmp_path)
    team.step(3)
    ((name, vehicle, request),) = team.asked
    assert (name, vehicle, request.layer, list(request.area)) == ("get_map", "carl", "heights", [0.0, 0.0, 10.0, 5.0])
    assert team.states() == ["DONE"] and sorted(team.shared) == ["anne", "bert"]


def test_a_map_of_a_vehicles_own_frame_is_handed_over_in_the_world_frame(tmp_path):
    team = Team(SHARE.replace("vehicle: carl, to: team, area: [0.0, 0.0, 10.0, 5.0]", "vehicle: anne, to: bert, layer: grid"), tmp_path)
    team.map = Grid(frame_id="anne/map", pose=planar_pose(1.0, -1.0, 0.0))
    team.step(3)
    shared = team.shared["bert"]
    assert (shared.frame_id, shared.pose.position.x, shared.pose.position.y) == ("world", pytest.approx(3.2), pytest.approx(0.3))


def test_a_map_that_nobody_has_fails_the_task_with_the_reason(tmp_path):
    team = Team(SHARE, tmp_path)
    team.refusals["get_map", "carl"] = "nothing is mapped there yet"
    team.step(170)
    assert team.states() == ["FAILED"] and "nothing is mapped there yet" in team.tasks.tasks[0].reason and not team.shared


@pytest.mark.parametrize(
    ("part", "why"),
    [("to: crl", "no vehicle or role 'crl'; did you mean 'carl'?"), ("to: team, area: [1.0, 0.0, 0.0, 5.0]", "nothing lies in it")],
)
def test_a_hand_over_that_cannot_be_is_told_at_the_start(tmp_path, part, why):
    with pytest.raises(BadInput, match=re.escape(why)):
        Team(SHARE.replace("to: team, area: [0.0, 0.0, 10.0, 5.0]", part), tmp_path)


PLACES = "  - {name: see, visit: {vehicle: team, places: [[4.0, 1.7], [5.0, 1.7]]}}\n"


def test_ways_are_asked_for_again_while_a_rover_has_no_map_yet(tmp_path):
    team = Team(PLACES, tmp_path)
    team.refusals.update({("preview", name): "there is no map yet" for name in ("anne", "bert")})
    team.step(40)
    assert team.states() == ["RUNNING"]
    asked = team.requests().count("preview anne")
    assert 12 <= asked <= 30
    team.refusals.clear()
    team.step(15)
    assert {name for name, _, _ in team.asked} >= {"route"}


def test_a_place_that_nobody_can_go_to_fails_with_what_the_planners_say(tmp_path):
    team = Team(PLACES, tmp_path)
    team.refusals.update({("preview", name): f"{name} sees a wall" for name in ("anne", "bert")})
    team.step(round(PATIENCE * 10) + 30)
    assert team.states() == ["FAILED"]
    assert team.tasks.tasks[0].reason == "nobody can go to (4, 1.7): anne: anne sees a wall; bert: bert sees a wall"


def circling(team, x, y, z, height):
    team.status["carl"].circle.CopyFrom(Circle(centre=Vector3(x=x, y=y, z=z), radius=80.0))
    team.places["carl"], team.heights["carl"] = (x + 80.0, y), height


def test_an_aircraft_is_at_its_goal_at_its_height(tmp_path):
    team = Team("  - {name: up, goal: {vehicle: carl, x: 100.0, y: 0.0, z: 200.0}}\n", tmp_path)
    team.step(10)
    circling(team, 0.0, -200.0, 60.0, 60.0)
    team.step(2)
    assert team.states() == ["RUNNING"]
    circling(team, 100.0, 0.0, 200.0, 60.0)
    team.step(12)
    assert (team.states(), team.tasks.tasks[0].reason) == (["RUNNING"], "80 m left, 140 m to climb")
    circling(team, 100.0, 0.0, 200.0, 195.0)
    team.step(2)
    assert team.states() == ["DONE"]


def test_a_goal_that_is_too_low_for_an_aircraft_fails_with_the_height_it_holds(tmp_path):
    team = Team("  - {name: low, goal: {vehicle: carl, x: 100.0, y: 0.0, z: 3.0}}\n", tmp_path)
    team.step(10)
    circling(team, 100.0, 0.0, 60.0, 60.0)
    team.step(2)
    assert (team.states(), team.tasks.tasks[0].reason) == (["FAILED"], "carl: 3 m is too low for it; it holds at 60 m")


@pytest.mark.parametrize(
    ("tasks", "why"),
    [
        ("  - {route: {vehicle: carl, places: [[1, 2]]}}", "route: vehicle: carl does not drive; name ground vehicles"),
        ("  - {explore: [anne, carl]}", "explore: carl does not drive"),
        ("  - {explore: bert}", "explore: bert has another job; give it job: {explore: true}"),
        ("  - {follow: {vehicle: carl, leader: anne}, until: {at: 9}}", "follow: vehicle: carl does not drive"),
        ("  - {save_map: {vehicle: carl, name: x}}", "save_map: vehicle: carl does not drive"),
        ("  - {goal: {vehicle: [bert, carl], x: 1, y: 2}}", "goal: z: carl flies; give the height above the world's origin"),
    ],
)
def test_who_cannot_do_a_task_is_not_asked(tmp_path, tasks, why):
    with pytest.raises(BadInput) as error:
        Team(tasks, tmp_path)
    assert why in str(error.value)
