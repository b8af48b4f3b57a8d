"""Markers are visited as they are found: by who is free, each by one, from a side that can be reached."""

import math

import pytest

from schemas.messages import Mode
from tests.services.executive.team import Team
from uvf.models.yaml_data import BadInput

VISIT = "  - {name: visit, visit: {vehicle: team, found: {by: [carl, anne], count: COUNT, near: 1.0}}}\n"


@pytest.fixture
def team(tmp_path):
    made = Team(VISIT.replace("COUNT", "2"), tmp_path)
    made.step(10)
    return made


def goals(team):
    return [(vehicle, round(m.position.x, 2), round(m.position.y, 2)) for name, vehicle, m in team.asked if name == "goal"]


def test_vehicles_are_armed_and_wait_for_markers(team):
    assert sorted(team.requests()) == ["arm anne", "arm bert", "mode anne", "mode bert"]
    assert team.tasks.tasks[0].reason == "0 of 2 visited, 0 found"


def test_the_nearest_goes_to_each_and_stops_before_it_on_its_own_side(team):
    team.find("carl", (4.2, 1.3), (8.0, 7.4))
    team.step(5)
    assert sorted(goals(team)) == [("anne", 3.2, 1.3), ("bert", 8.0, 6.4)]
    team.arrive("anne")
    team.arrive("bert")
    team.step(5)
    assert team.states() == ["DONE"]


def test_a_marker_found_by_two_is_visited_once(team):
    team.find("carl", (4.2, 1.3))
    team.find("anne", (4.6, 1.5))
    team.step(5)
    assert [vehicle for vehicle, *_ in goals(team)] == ["anne"]


def test_who_sees_a_marker_elsewhere_than_it_was_told_goes_where_it_sees_it(team):
    team.find("carl", (4.2, 1.3))
    team.step(5)
    team.find("anne", (4.3, 1.4))
    team.step(5)
    assert goals(team) == [("anne", 3.2, 1.3)]
    team.find("anne", (6.2, 1.3))  # the error of its own pose
    team.step(5)
    assert goals(team) == [("anne", 3.2, 1.3), ("anne", 5.2, 1.3)]
    assert team.requests().count("cancel anne") == 1
    team.places["anne"] = (4.2, 1.3)
    team.step(10)
    assert team.tasks.tasks[0].reason.startswith("0 of 2 visited, 1 found")
    team.places["anne"] = (5.3, 1.3)
    team.step(10)
    assert team.tasks.tasks[0].reason.startswith("1 of 2 visited, 1 found")


def test_of_two_that_may_be_the_same_the_nearest_is(team):
    team.find("carl", (4.2, 1.3), (6.2, 1.3))
    team.find("anne", (5.9, 1.3))
    team.step(5)
    assert sorted(goals(team)) == [("anne", 3.2, 1.3), ("bert", 6.7, 2.16)]
    assert "2 found" in team.tasks.tasks[0].reason


def test_who_has_been_somewhere_goes_to_the_next(team):
    team.find("carl", (4.2, 1.3))
    team.step(5)
    team.arrive("anne")
    team.step(5)
    assert team.states() == ["RUNNING"]
    team.find("carl", (4.2, 1.3), (2.2, 5.3))
    team.step(5)
    assert [vehicle for vehicle, *_ in goals(team)] == ["anne", "anne"]


def test_the_shortest_way_comes_first_whoever_is_named_first(team):
    team.find("carl", (6.5, 4.4))
    team.step(5)
    assert [vehicle for vehicle, *_ in goals(team)] == ["bert"]


def test_where_there_is_no_way_other_sides_and_other_markers_are_tried(team):
    team.refusals["preview", "anne"] = "the goal is in an obstacle"
    team.refusals["preview", "bert"] = "the goal is in an obstacle"
    team.find("carl", (4.2, 1.3))
    team.step(60)
    asked = [(m.position.x, m.position.y) for name, vehicle, m in team.asked if name == "preview" and vehicle == "anne"]
    assert len(asked) == 8 and all(math.dist(place, (4.2, 1.3)) == pytest.approx(1.0) for place in asked)
    assert goals(team) == [] and team.states() == ["RUNNING"]
    team.refusals.clear()
    team.step(300)
    assert [vehicle for vehicle, *_ in goals(team)] != []


def test_a_goal_that_is_given_up_is_left_for_a_while(team):
    team.find("carl", (4.2, 1.3))
    team.step(8)
    team.give_up("anne", "walls all about")
    team.step(8)
    assert team.states() == ["RUNNING"]
    assert [vehicle for vehicle, *_ in goals(team)] == ["anne", "bert"]


def test_the_marker_of_who_is_taken_over_or_has_tipped_is_for_the_others(team):
    team.find("carl", (4.2, 1.3))
    team.step(8)
    team.status["anne"].mode = Mode.MODE_MANUAL
    team.step(8)
    assert [vehicle for vehicle, *_ in goals(team)] == ["anne", "bert"]
    assert team.tasks.tasks[0].reason.endswith("anne does something else")
    team.status["bert"].armed = False
    team.step(50)
    assert team.states() == ["RUNNING"]
    team.step(80)
    assert team.states() == ["FAILED"]
    assert team.tasks.tasks[0].reason == "anne does something else; bert does something else"


def test_who_is_back_takes_part_again_and_a_gap_in_what_is_heard_says_nothing(team):
    team.find("carl", (4.2, 1.3))
    team.step(8)
    silent = team.status.pop("anne")
    team.step(3)
    team.status["anne"] = silent
    team.step(3)
    assert [vehicle for vehicle, *_ in goals(team)] == ["anne"]
    team.status["anne"].mode = Mode.MODE_HOLD
    team.status["bert"].mode = Mode.MODE_HOLD
    team.step(20)
    team.status["anne"].mode = Mode.MODE_MISSION
    team.step(8)
    assert [vehicle for vehicle, *_ in goals(team)] == ["anne", "anne"]


def test_once_enough_are_visited_nobody_is_asked_for_anything_any_more(tmp_path):
    team = Team(VISIT.replace("COUNT", "1") + "  - {name: wait, when: {after: 100}}\n", tmp_path)
    team.refusals["arm", "bert"] = "it lies on its side"
    team.find("carl", (4.2, 1.3))
    team.step(8)
    team.arrive("anne")
    team.step(5)
    assert team.states() == ["DONE", "WAITING"]
    asked = len(team.asked)
    team.refusals.clear()
    team.step(30)
    assert len(team.asked) == asked and not team.status["bert"].armed


def test_who_is_under_way_when_enough_are_visited_stops(tmp_path):
    team = Team(VISIT.replace("COUNT", "1"), tmp_path)
    team.find("carl", (4.2, 1.3), (8.0, 7.4))
    team.step(8)
    team.arrive("anne")
    team.step(5)
    assert ("cancel", "bert") in [(name, vehicle) for name, vehicle, _ in team.asked]


def test_two_that_one_vehicle_tells_apart_are_two_and_one_that_moves_is_visited_once(team):
    team.find("carl", (4.2, 1.3), (5.4, 1.3))
    team.step(8)
    assert sorted(vehicle for vehicle, *_ in goals(team)) == ["anne", "bert"]
    team.arrive("anne")
    team.step(3)
    team.find("carl", (4.2, 3.2), (5.4, 1.3))
    team.step(8)
    assert [vehicle for vehicle, *_ in goals(team)].count("anne") == 1


def test_who_cannot_be_armed_is_left_out(tmp_path):
    team = Team(VISIT.replace("COUNT", "1"), tmp_path)
    team.refusals["arm", "anne"] = "it lies on its side"
    team.find("carl", (4.2, 1.3))
    team.step(200)
    assert [vehicle for vehicle, *_ in goals(team)] == ["bert"]
    team.arrive("bert")
    team.step(3)
    assert team.states() == ["DONE"]


def test_a_condition_counts_each_marker_once(tmp_path):
    team = Team("  - {name: find, when: {vehicle: [carl, anne], found: 2}}\n", tmp_path)
    team.find("carl", (4.2, 1.3))
    team.find("anne", (4.6, 1.5))
    team.step(2)
    assert team.tasks.tasks[0].reason == "waits until 2 markers are found by carl and anne, 1 by now"
    team.find("anne", (4.6, 1.5), (9.0, 9.0))
    team.step(2)
    assert team.states() == ["DONE"]


@pytest.mark.parametrize(
    ("task", "why"),
    [
        ("visit: {vehicle: carl, places: [[1, 1]]}", "carl does not drive"),
        ("visit: {vehicle: team}", "give places, or found"),
        ("visit: {vehicle: team, places: [[1, 1]], found: {by: carl, count: 1}}", "one of the two"),
        ("visit: {vehicle: team, found: {by: bert, count: 1}}", "bert looks for no markers"),
        ("visit: {vehicle: team, found: {by: karl, count: 1}}", "did you mean 'carl'"),
        ("when: {vehicle: carl, merged: true}", "carl draws no map that could be merged"),
        ("when: {vehicle: bert, found: 2}", "bert looks for no markers"),
        ("when: {found: 2}", "whose?"),
    ],
)
def test_what_cannot_be_done_is_refused_at_load(task, why, tmp_path):
    with pytest.raises(BadInput, match=why):
        Team(f"  - {{{task}}}\n", tmp_path)


def test_who_passes_by_a_marker_has_visited_it_and_who_was_on_its_way_there_stops(team):
    team.find("carl", (4.2, 1.3), (5.4, 4.4))
    team.step(5)
    assert sorted(vehicle for vehicle, *_ in goals(team)) == ["anne", "bert"]
    team.places["bert"] = (4.2, 2.2)
    team.step(12)
    assert "1 of 2 visited" in team.tasks.tasks[0].reason and "bert goes to (5, 4)" in team.tasks.tasks[0].reason
    assert "cancel anne" in team.requests() and "cancel bert" not in team.requests()


def test_a_marker_is_left_to_who_is_sooner_there_although_it_still_goes_somewhere_else(team):
    team.find("carl", (8.0, 7.4))
    team.step(8)
    assert [vehicle for vehicle, *_ in goals(team)] == ["bert"]
    team.find("carl", (8.0, 7.4), (9.2, 5.0))
    team.step(50)
    assert [vehicle for vehicle, *_ in goals(team)] == ["bert"]
    team.arrive("bert")
    team.places["bert"] = (8.0, 6.4)
    team.step(50)
    assert [vehicle for vehicle, *_ in goals(team)] == ["bert", "bert"]


def test_each_takes_what_lies_on_its_own_side_and_the_near_ones_first(tmp_path):
    team = Team(VISIT.replace("COUNT", "4"), tmp_path)
    team.places["anne"], team.places["bert"] = (1.0, 2.0), (1.0, 5.0)
    team.step(10)
    team.find("carl", (9.0, 1.0), (9.0, 6.0), (5.0, 1.0), (5.0, 6.0))
    team.step(8)
    assert sorted((vehicle, round(x), y > 3.5) for vehicle, x, y in goals(team)) == [("anne", 4, False), ("bert", 4, True)]


@pytest.mark.parametrize("duration", [math.nan, math.inf, -1.0])
def test_a_planner_that_tells_nonsense_is_not_sent(team, duration):
    team.durations["anne"] = duration
    team.find("carl", (4.2, 1.3))
    team.step(60)
    assert [vehicle for vehicle, *_ in goals(team)] == ["bert"]
