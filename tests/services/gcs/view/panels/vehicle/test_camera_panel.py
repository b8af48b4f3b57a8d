"""Pictures go to the page while somebody looks; sliders of the page steer the gimbal of the vehicle that they belong to."""

from base64 import b64encode

import numpy as np
import pytest

from schemas import topics
from schemas.messages import GimbalCommand, JointState, JointStates
from services.gcs.actions.page import AimGimbal, GimbalMode, Looking, OpenTab, Select, ShowCamera
from services.gcs.page.words import action_in
from services.gcs.state.session import SHED_AFTER
from services.gcs.view.panels.vehicle.camera_panel import SEEN_FOR
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, UGV, demo_site, with_eyes
from uvf.runtime.messages.convert import stamp

PAGE = Looking(ME)
TOPICS = {"camera": topics.IMAGE, "chase": topics.VIEW.by("chase"), "gimbal": topics.VIEW.by("gimbal")}


@pytest.fixture
def station():
    """Both vehicles have sent a picture of each camera."""
    station = Station(site=with_eyes(demo_site()))
    station.run(0.5)
    for name, topic in TOPICS.items():
        station.script.put(UAV, topic, topic.message(data=f"air {name}".encode(), format="jpeg"), 0.5)
    station.script.put(UGV, topics.IMAGE, topics.IMAGE.message(data=b"ground", format="jpeg"), 0.5)
    joints = [JointState(name="pan", position=0.5), JointState(name="tilt", position=-0.1)]
    station.script.put(UAV, topics.GIMBAL_JOINTS, JointStates(timestamp=stamp(0.5), joints=joints), 0.5)
    station.press(Select(ME, UAV), OpenTab(ME, "fly"), seconds=0.5)
    return station


def shown(station):
    return station.page.now.html["picture"]


def shows(station, picture):
    return b64encode(picture).decode() in shown(station)


def test_nothing_is_sent_while_nobody_looks(station):
    assert shown(station) == ""
    station.press(PAGE, seconds=0.2)
    assert "<img" in shown(station)
    station.run(SEEN_FOR + 0.3)
    assert shown(station) == ""


def test_the_picture_is_that_of_the_camera_and_the_vehicle_chosen(station):
    station.press(PAGE, seconds=0.2)
    assert shows(station, b"air gimbal")
    for name, picture in {"chase": b"air chase", "image": b"air camera", "../secret": b"air gimbal"}.items():
        station.press(ShowCamera(ME, name), seconds=0.2)
        assert shows(station, picture)
    station.press(Select(ME, UGV))
    assert shows(station, b"ground") and "type='range'" not in station.page.now.html["cameras"]


def test_the_age_of_the_picture_is_told_and_warned_of(station):
    station.run(0.5)
    assert "g-idle" in station.page.now.html["cameras"] and "joints: pan 29°, tilt -6°" in station.page.now.html["cameras"]
    station.run(2.0)
    assert "⚠" in station.page.now.html["cameras"]


def test_a_vehicle_without_cameras_has_no_panel():
    station = Station(site=with_eyes(demo_site(), of="nas10"))
    station.press(PAGE, Select(ME, UAV), OpenTab(ME, "fly"), seconds=0.8)
    assert (station.page.now.html["cameras"], shown(station)) == ("", "")


def test_sliders_are_there_while_the_gimbals_picture_is(station):
    panel = station.page.now.html["cameras"]
    assert panel.count("type='range'") == 2 and "min='-29' max='120'" in panel and "aria-pressed='true' >Follow" in panel
    station.press(ShowCamera(ME, "chase"), seconds=0.6)
    assert "type='range'" not in station.page.now.html["cameras"]


def test_a_slider_is_a_command_and_is_remembered(station):
    station.press(AimGimbal(ME, UAV, "pan", 23.0), AimGimbal(ME, UAV, "tilt", 300.0), GimbalMode(ME, UAV, "Lock"), seconds=0.6)
    told = station.script.gimbals[-1]
    assert (told.pan, told.tilt, told.mode) == (pytest.approx(np.radians(23.0)), pytest.approx(2.1), GimbalCommand.LOCK)
    assert "value='23'" in station.page.now.html["cameras"] and "aria-pressed='true' >Lock" in station.page.now.html["cameras"]


@pytest.mark.parametrize("name", [UGV, "nobody"])
def test_what_cannot_be_aimed_is_not(station, name):
    station.press(AimGimbal(ME, name, "pan", 0.1), GimbalMode(ME, name, "Body"))
    assert station.script.gimbals == []


def test_the_pages_own_words():
    assert action_in('[1, "looks"]', ME) == PAGE
    assert action_in('[1, "camera", "chase"]', ME) == ShowCamera(ME, "chase")
    assert action_in('[1, "gimbal", "milvus", "pan", 0.25]', ME) == AimGimbal(ME, UAV, "pan", 0.25)
    assert action_in('[1, "gimbal", "milvus", "roll", 0.25]', ME) is None
    assert action_in('[1, "looks", "another"]', ME) is None


def test_no_picture_of_another_vehicle_stands_under_the_name_of_this_one_on_a_slow_page(station):
    station.press(PAGE, seconds=0.2)
    station.page.asleep = True
    station.run(SHED_AFTER + 0.5)
    assert shows(station, b"air gimbal")
    assert "no pictures: this page is 1 s behind" in station.page.now.html["cameras"]
    station.press(ShowCamera(ME, "chase"), seconds=0.4)
    assert "picture" not in station.page.now.html
    station.press(Select(ME, UGV), seconds=0.4)
    assert "picture" not in station.page.now.html
