"""The service: what it declares, its buttons, its manners."""

import pytest

from schemas import topics
from schemas.messages import ArmRequest, Mode
from services.gcs.actions.page import Command, OpenTab, Select, StopAll
from services.gcs.service import GroundStation
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, UGV, demo_site, with_leader


@pytest.fixture
def station():
    station = Station()
    station.run(0.5)
    return station


def test_it_runs_by_the_wall_clock_for_the_whole_world_and_writes_only_stop_drive_and_gimbal():
    assert (GroundStation.scope, GroundStation.clock) == ("world", "wall")
    written = {"stop": topics.STOP, "drive": topics.DRIVE, "gimbal": topics.GIMBAL}
    assert GroundStation.outputs == {name: topic.by("gcs") for name, topic in written.items()}
    assert all(not declared.required for declared in GroundStation.declared_inputs().values())


def test_every_step_shows_a_picture(station):
    assert len(station.page.pictures) == 10
    assert all(p.panels[ME].html.keys() == station.page.pictures[-1].panels[ME].html.keys() for p in station.page.pictures)


def commands(station):
    return [label for label, (verb, *_) in station.page.now.words.items() if verb == "command"]


def test_each_kind_has_its_own_commands(station):
    assert commands(station) == ["Hold", "Mission", "Manual", "Disarm burger"]
    station.press(Select(ME, UAV))
    assert commands(station) == ["Mission", "Hold", "Return", "Land", "Disarm milvus"]


def test_only_an_aircraft_with_a_leader_can_be_told_to_follow_it(station):
    led = Station(site=with_leader(demo_site()))
    led.run(0.5)
    assert "Follow leader" not in commands(led)
    led.press(Select(ME, UAV))
    assert commands(led) == ["Mission", "Hold", "Follow leader", "Return", "Land", "Disarm milvus"]
    station.press(Select(ME, UAV), Command(ME, UAV, "follow"))
    assert station.script.asked == []


def test_follow_leader_asks_for_the_mode_which_is_lit_then():
    led = Station(site=with_leader(demo_site()))
    led.run(0.5)
    led.press(Select(ME, UAV), Command(ME, UAV, "follow"), seconds=0.5)
    ((name, request),) = led.script.asked
    assert (name, request.mode) == (UAV, Mode.MODE_FOLLOW)
    assert led.page.now.pressed() == ["Follow leader"]


def test_an_aircraft_on_the_ground_is_armed_and_takes_off_with_two_clicks_each(station):
    station.script.armed[UAV], station.script.landed = False, True
    station.press(Select(ME, UAV), seconds=0.4)
    assert commands(station) == ["Arm milvus", "Take off", "Mission", "Hold", "Return", "Land"]
    assert station.page.now.greyed("Take off") and station.page.now.greyed("Return")
    for label in ("Arm milvus", "Confirm: arm milvus"):
        station.push(label, seconds=0.2)
    assert isinstance(station.script.asked[-1][1], ArmRequest)
    station.script.armed[UAV] = True
    station.run(0.4)
    for label in ("Take off", "Confirm: take off"):
        station.push(label, seconds=0.2)
    assert station.script.asked[-1][1].mode == Mode.MODE_TAKEOFF


def test_the_present_mode_is_lit(station):
    assert station.page.now.pressed() == ["Mission"]


def test_buttons_ask_for_what_they_say(station):
    said = station.page.now.words
    assert said["■ STOP ALL"] == ["stop"]
    assert said["Hold"] == ["command", UGV, "hold"]
    assert said["Disarm burger"] == ["command", UGV, "disarm"]


def test_release_is_there_only_while_stopped(station):
    assert "Release STOP" not in station.page.now.words
    station.press(StopAll(ME), seconds=0.3)
    assert "Release STOP" in station.page.now.words


def test_only_the_open_tab_is_drawn(station):
    assert "instrument" in station.page.now.html and "log" not in station.page.now.html
    station.press(OpenTab(ME, "log"))
    assert "log" in station.page.now.html and "instrument" not in station.page.now.html


def test_a_newcomer_is_told_how_to_begin_until_something_was_asked(station):
    assert "Click the floor to send burger there" in station.page.now.html["hint"]
    station.push("Hold", seconds=1.0)
    assert station.page.now.html["hint"] == ""


def test_it_starts_with_nobody_there():
    station = Station()
    station.run(1.0, silent=True)
    assert "WAITING" in station.page.now.html["bar"]
    station.press(OpenTab(ME, "graph"))
    assert "No process" in station.page.now.html["processes"]


def test_it_closes_its_page(station):
    station.service.close()
    assert station.page.closed
