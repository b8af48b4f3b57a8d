"""A mission is drawn on the page, flown ahead, compared with the one in force, and put into force."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import MissionItem, MissionRequest, SetCurrentRequest
from services.gcs.actions.page import OpenTab, Select
from services.gcs.actions.plans import PlanAdd, PlanChoose, PlanClear, PlanMove, PlanRemove, PlanSet, PlanShift
from services.gcs.state.plans.plan_draft import MOST_ITEMS
from tests.services.gcs.fakes import ME, OTHER, Station, click
from tests.services.gcs.scripted import LEGS, UAV, UGV


@pytest.fixture
def station():
    """The aircraft's plan is open."""
    station = Station()
    station.run(0.5)
    station.press(Select(ME, UAV), OpenTab(ME, "plan"), seconds=0.3)
    return station


def draft(station, name=UAV):
    return station.model.vehicles[name].draft


def panel(station):
    return station.page.now.html["plan"]


def sent(station, kind=MissionRequest):
    return [message for _, message in station.script.asked if isinstance(message, kind)]


def test_it_begins_with_what_is_on_the_vehicle(station):
    assert "✓ as it is on milvus" in panel(station)
    assert [(i.position.x, i.position.y) for i in draft(station).items[:4]] == list(LEGS)
    assert "Upload to milvus" not in station.page.now.words


def test_a_waypoint_is_added_from_the_menu_of_a_clicked_place(station):
    station.press(click(50.0, 20.0), seconds=0.3)
    station.push("Add waypoint", seconds=0.3)
    added = draft(station).items[4]
    assert (added.kind, added.position.x, added.position.y, added.position.z) == (MissionItem.WAYPOINT, 50.0, 20.0, 60.0)
    assert draft(station).items[5].kind == MissionItem.JUMP, "the jump that closes the circuit stays the last"
    assert "2 changes not on milvus" in panel(station)
    assert station.page.now.html["menu"] == ""
    assert sent(station) == []


def test_an_upload_over_a_mission_that_is_flown_wants_a_second_click(station):
    station.press(PlanMove(ME, UAV, 0, 210.0, -150.0), seconds=0.3)
    station.push("Upload to milvus", seconds=0.3)
    assert sent(station) == []
    station.push("Confirm: replace the mission that milvus flies", seconds=0.4)
    (request,) = sent(station)
    assert (request.mission.items[0].position.x, len(request.mission.items)) == (210.0, 5)
    assert "✓ as it is on milvus" in panel(station)


def test_a_refused_mission_stays_a_draft():
    station = Station(accept=False)
    station.run(0.5)
    station.script.mode[UAV] = 2
    station.press(Select(ME, UAV), OpenTab(ME, "plan"), PlanMove(ME, UAV, 0, 210.0, -150.0), seconds=0.3)
    station.push("Upload to milvus", seconds=0.4)
    assert "1 change not on milvus" in panel(station)
    assert "lies inside a wall" in station.page.now.html["commands"]


def test_somebody_elses_upload_does_not_take_a_draft_away(station):
    station.press(PlanMove(ME, UAV, 0, 210.0, -150.0))
    mission = station.script._mission()
    del mission.items[1]
    station.script.put(UAV, topics.MISSION, mission, station.t)
    station.run(0.3)
    assert draft(station).items[0].position.x == 210.0 and len(draft(station).items) == 5
    station.push("Take from the vehicle", seconds=0.3)
    assert len(draft(station).items) == 4 and "✓ as it is on milvus" in panel(station)


def test_the_mission_is_flown_ahead_and_drawn(station):
    station.run(8.0)
    outlook = station.model.vehicles[UAV].outlook
    assert outlook.is_flown and outlook.length == pytest.approx(1400.0, rel=0.1)
    flown = station.page.now.own["/own/flown"].points
    assert np.abs(flown[:, 0]).max() < 220.0 and flown[:, 2].mean() == pytest.approx(60.0, abs=2.0)
    assert "km" in panel(station) and "a round" in panel(station)
    assert "g-profile'" in panel(station)
    assert [item for item, _, _ in outlook.passed] == [0, 1, 2, 3, 0]


def test_nothing_is_flown_ahead_while_nobody_looks_at_the_plan(station):
    station.press(OpenTab(ME, "fly"), PlanMove(ME, UAV, 0, 210.0, -150.0), seconds=2.0)
    assert station.page.now.own == {} and station.page.now.html["handles"] == ""
    edits = draft(station).edits
    assert station.model.vehicles[UAV].outlook.edits < edits


def test_what_cannot_be_flown_says_why_and_is_not_sent(station):
    station.press(PlanAdd(ME, UAV, "orbit", 0.0, 0.0), PlanSet(ME, UAV, 4, "radius", 5.0), seconds=0.5)
    assert "too tight at 25 m/s" in panel(station)
    station.push("Upload to milvus", seconds=0.3)
    assert sent(station) == []
    assert "too tight" in station.model.vehicles[UAV].order.reason


def test_items_are_edited_moved_about_and_taken_out(station):
    station.press(PlanShift(ME, UAV, 0, 1), PlanSet(ME, UAV, 1, "z", 85.0), PlanChoose(ME, UAV, 1), PlanChoose(ME, UAV, 1))
    items = draft(station).items
    assert [(i.position.x, i.position.y) for i in items[:2]] == [LEGS[1], LEGS[0]] and items[1].position.z == 85.0
    station.press(PlanRemove(ME, UAV, 0))
    assert len(items) == 4 and items[-1].jump_to == 0
    station.press(PlanClear(ME, UAV), seconds=0.3)
    assert "Add waypoint" in panel(station)


@pytest.mark.parametrize(
    "action",
    [
        PlanSet(ME, UAV, 99, "x", 1.0),
        PlanSet(ME, UAV, 0, "kind", 1.0),
        PlanSet(ME, UAV, 0, "origin", 1.0),
        PlanMove(ME, UAV, 4, 1.0, 1.0),
        PlanShift(ME, UAV, 4, 1),
        PlanAdd(ME, UAV, "rocket", 1.0, 1.0),
        PlanRemove(ME, "nobody", 0),
    ],
)
def test_what_makes_no_sense_changes_nothing(station, action):
    before = [item.SerializeToString() for item in draft(station).items]
    station.press(action)
    assert [item.SerializeToString() for item in draft(station).items] == before


def test_a_draft_is_bounded(station):
    for i in range(MOST_ITEMS + 100):
        station.page.clicks.append(PlanAdd(ME, UAV, "waypoint", float(i), 0.0))
    station.run(0.2)
    assert len(draft(station).items) == MOST_ITEMS


def test_only_who_controls_the_vehicle_edits(station):
    station.push("Hold")
    station.join_other()
    station.press(Select(OTHER, UAV), PlanMove(OTHER, UAV, 0, 1.0, 1.0))
    assert not draft(station).touched
    assert "ask for control first" in station.model.vehicles[UAV].order.reason


def test_it_goes_on_with_the_item_that_is_chosen(station):
    station.press(PlanChoose(ME, UAV, 2), seconds=0.3)
    station.push("Go on from here")
    (request,) = sent(station, SetCurrentRequest)
    assert request.index == 2


def test_a_rover_is_given_a_mission_without_heights(station):
    station.press(Select(ME, UGV), PlanAdd(ME, UGV, "waypoint", 3.0, 2.0), PlanAdd(ME, UGV, "waypoint", 6.0, 6.0), seconds=0.4)
    assert "aria-label='z of item" not in panel(station) and "5 m" in panel(station)
    station.push("Upload to burger", seconds=0.2)
    station.push("Confirm: replace the mission that burger flies", seconds=0.2)
    assert [name for name, m in station.script.asked if isinstance(m, MissionRequest)] == [UGV]
    assert {"Take-off", "Landing"}.isdisjoint(label.removeprefix("+ ") for label in station.page.now.words)


def test_handles_hang_over_the_places_of_the_items(station):
    handles = station.page.now.html["handles"]
    assert handles.count("g-handle") == 4
    assert "data-move='[&quot;plan-move&quot;, &quot;milvus&quot;, 1]' data-x='200.00' data-y='150.00' data-z='60.00'" in handles
