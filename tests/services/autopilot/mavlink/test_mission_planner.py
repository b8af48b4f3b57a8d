"""Mission Planner connects, changes modes and clicks on its map; emulated, because it runs on Windows alone."""

import pytest

from schemas.messages import Mode
from tests.services.autopilot.mavlink.mission_planner import MissionPlanner, integer
from tests.services.autopilot.mavlink.rig import PLANE, ROVER, Rig, of, texts

ACCEPTED, DENIED = 0, 2
DOES_NOT_EXIST = 1
RETURN, MISSION, TAKEOFF = 0x05040000, 0x04040000, 0x02040000
HERE = (40.77, 14.79, 60.0)  # deg, deg, m above home


@pytest.fixture
def rig():
    rig = Rig()
    rig.run(1.0)
    return rig


def test_it_is_refused_the_packed_parameters_at_once_and_has_the_list(rig):
    parameters = MissionPlanner(rig).connect()
    rows = rig.service._vehicles["plane"]._parameters.table
    assert set(parameters) - {"_HASH_CHECK"} == {row.name for row in rows}
    assert integer(parameters["MAV_SYS_ID"]) == PLANE and parameters["FW_AIRSPD_TRIM"] == 25.0


def test_its_rates_are_those_it_has_asked_for(rig):
    MissionPlanner(rig).connect(rate=4)
    heard = rig.run(5.0)
    for kind in ("ATTITUDE", "VFR_HUD", "GLOBAL_POSITION_INT", "SYS_STATUS"):
        assert len(of(heard, kind, PLANE)) == pytest.approx(20, abs=1), kind


def test_a_mode_is_set_by_all_three_messages_and_shown_at_once(rig):
    rig.plane.status.armed, rig.plane.status.landed = True, False
    planner = MissionPlanner(rig)
    results, shown = planner.set_mode(RETURN)
    assert results == [ACCEPTED] and shown[-1] == RETURN
    assert {request.mode for name, request in rig.plane.asked if name == "set_mode"} == {Mode.MODE_RETURN}
    assert [text for text in texts(planner.heard) if "refused" in text] == []


def test_a_mode_that_is_refused_stays_as_it_was_with_one_text(rig):
    rig.plane.refuse["set_mode"] = "there is no mission"
    planner = MissionPlanner(rig)
    results, shown = planner.set_mode(MISSION)
    assert results and results[0] != ACCEPTED and MISSION not in shown
    assert [text for text in texts(planner.heard) if "refused" in text] == ["Mode Mission refused: there is no mission"]


@pytest.mark.parametrize("whole", [True, False])
def test_a_click_on_the_map_is_flown_to(rig, whole):
    assert MissionPlanner(rig).guided_item(*HERE, whole=whole) == [ACCEPTED]
    ((name, goal),) = rig.plane.asked
    assert name == "goal" and (goal.position.x, goal.position.y) == pytest.approx((0.0, 0.0), abs=1.0)
    assert goal.position.z == pytest.approx(80.0, abs=0.1)


def test_a_click_as_a_target_is_flown_to_too(rig):
    MissionPlanner(rig).fly_to_here(*HERE)
    ((name, goal),) = rig.plane.asked
    assert name == "goal" and goal.position.z == pytest.approx(80.0, abs=0.1)


def test_a_rover_is_sent_the_same_way(rig):
    assert MissionPlanner(rig, ROVER).guided_item(*HERE) == [ACCEPTED]
    assert [name for name, _ in rig.rover.asked] == ["set_mode", "goal"]


@pytest.mark.parametrize("name", ["WP_RADIUS", "WPNAV_RADIUS", "LOITER_RADIUS"])
def test_parameters_of_another_autopilot_are_refused_and_not_waited_for(rig, name):
    assert MissionPlanner(rig).set_parameter(name, 30.0) == ([DOES_NOT_EXIST], [])
