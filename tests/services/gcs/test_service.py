"""The service: what it declares, its buttons, its manners."""

import pytest

from schemas import topics
from schemas.messages import Mode
from services.gcs.actions import Arm, Select, SetMode, StopAll
from services.gcs.service import GroundStation
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, UGV, demo_site, with_leader


@pytest.fixture
def station():
    station = Station()
    station.run(0.5)
    return station


def buttons(station):
    return {b.label: b for b in station.page.now.buttons}


def test_it_runs_by_the_wall_clock_for_the_whole_world_and_writes_only_stop_drive_and_gimbal():
    assert (GroundStation.scope, GroundStation.clock) == ("world", "wall")
    written = {"stop": topics.STOP, "drive": topics.DRIVE, "gimbal": topics.GIMBAL}
    assert GroundStation.outputs == {name: topic.by("gcs") for name, topic in written.items()}
    assert all(not declared.required for declared in GroundStation.declared_inputs().values())


def test_every_step_shows_a_picture(station):
    assert len(station.page.pictures) == 10
    assert all(p.html.keys() == station.page.pictures[-1].html.keys() for p in station.page.pictures)
    assert all(p.panels[ME].html.keys() == station.page.pictures[-1].panels[ME].html.keys() for p in station.page.pictures)


def test_each_kind_has_its_own_buttons(station):
    assert list(buttons(station)) == ["STOP ALL", "Release STOP", "Hold", "Mission", "Manual", "Disarm burger"]
    station.press(Select(ME, UAV))
    assert list(buttons(station)) == ["STOP ALL", "Release STOP", "Hold", "Mission", "Return", "Manual", "Disarm milvus"]


def test_only_an_aircraft_with_a_leader_can_be_told_to_follow_it(station):
    led = Station(site=with_leader(demo_site()))
    led.run(0.5)
    assert "Follow leader" not in buttons(led)
    led.press(Select(ME, UAV))
    assert list(buttons(led)) == ["STOP ALL", "Release STOP", "Hold", "Follow leader", "Mission", "Return", "Manual", "Disarm milvus"]
    assert buttons(led)["Follow leader"].action == SetMode(UAV, "Follow leader")
    station.press(Select(ME, UAV), SetMode(UAV, "Follow leader"))
    assert station.script.asked == []


def test_follow_leader_asks_for_the_mode_which_is_lit_then():
    led = Station(site=with_leader(demo_site()))
    led.run(0.5)
    led.press(Select(ME, UAV), SetMode(UAV, "Follow leader"), seconds=0.5)
    ((name, request),) = led.script.asked
    assert (name, request.mode) == (UAV, Mode.MODE_FOLLOW)
    assert [label for label, b in buttons(led).items() if b.lit] == ["Follow leader"]


def test_the_present_mode_is_lit(station):
    assert [label for label, b in buttons(station).items() if b.lit] == ["Mission"]


def test_buttons_ask_for_what_they_say(station):
    asked = {label: b.action for label, b in buttons(station).items()}
    assert asked["STOP ALL"] == StopAll(True)
    assert asked["Hold"] == SetMode(UGV, "Hold")
    assert asked["Disarm burger"] == Arm(ME, UGV, False)


def test_the_arm_button_asks_to_be_confirmed(station):
    station.press(Arm(ME, UGV, False))
    assert "Confirm: disarm burger" in buttons(station)


def test_release_is_there_only_while_stopped(station):
    assert not buttons(station)["Release STOP"].enabled
    station.press(StopAll(True))
    assert buttons(station)["Release STOP"].enabled


def test_it_starts_with_nobody_there():
    station = Station()
    station.run(1.0, silent=True)
    assert "WAITING" in station.page.now.html["bar"]
    assert "No process" in station.page.now.html["processes"]


def test_it_closes_its_page(station):
    station.service.close()
    assert station.page.closed
