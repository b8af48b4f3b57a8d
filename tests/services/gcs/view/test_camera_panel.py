"""Pictures go to the page while somebody looks; sliders of the page steer the gimbal of the vehicle that they belong to."""

import math

import pytest

from schemas import topics
from schemas.messages import GimbalCommand, JointState, JointStates
from services.gcs.actions import AimGimbal, Looking, Select, ShowCamera
from services.gcs.page.viser_script import action_in
from services.gcs.view.camera_panel import SEEN_FOR
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
    station.press(Select(ME, UAV))
    return station


def test_nothing_is_sent_while_nobody_looks(station):
    assert station.page.now.image is None
    station.press(PAGE)
    assert station.page.now.image is not None
    station.run(SEEN_FOR + 0.2)
    assert station.page.now.image is None


def test_the_picture_is_that_of_the_camera_and_the_vehicle_chosen(station):
    station.press(PAGE)
    assert station.page.now.image == b"air gimbal"
    for name, picture in {"chase": b"air chase", "image": b"air camera", "../secret": b"air gimbal"}.items():
        station.press(ShowCamera(ME, name))
        assert station.page.now.image == picture
    station.press(Select(ME, UGV))
    assert (station.page.now.image, station.page.now.gimbal) == (b"ground", None)


def test_the_age_of_the_picture_is_told_and_warned_of(station):
    station.run(0.5)
    assert "g-idle" in station.page.now.html["cameras"] and "s old – joints pan 29°, tilt -6°" in station.page.now.html["cameras"]
    station.run(2.0)
    assert "⚠" in station.page.now.html["cameras"]


def test_a_vehicle_without_cameras_has_no_panel():
    station = Station(site=with_eyes(demo_site(), of="nas10"))
    station.press(PAGE, Select(ME, UAV), seconds=0.5)
    assert (station.page.now.html["cameras"], station.page.now.image, station.page.now.gimbal) == ("", None, None)


def test_sliders_are_there_while_the_gimbals_picture_is(station):
    panel = station.page.now.gimbal
    assert (panel.vehicle, panel.pan, panel.tilt, panel.mode) == (UAV, 0.0, 0.0, "Follow")
    assert panel.tilts == (-0.5, 2.1)
    station.press(ShowCamera(ME, "chase"))
    assert station.page.now.gimbal is None


def test_a_slider_is_a_command_and_is_remembered(station):
    station.press(AimGimbal(UAV, 0.4, 0.9, GimbalCommand.LOCK))
    (told,) = station.script.gimbals
    assert (told.pan, told.tilt, told.mode) == (0.4, 0.9, GimbalCommand.LOCK)
    assert (station.page.now.gimbal.pan, station.page.now.gimbal.mode) == (0.4, "Lock")


@pytest.mark.parametrize(("name", "pan"), [(UGV, 0.1), ("nobody", 0.1), (UAV, math.nan)])
def test_what_cannot_be_aimed_is_not(station, name, pan):
    station.press(AimGimbal(name, pan, 0.1, GimbalCommand.BODY))
    assert station.script.gimbals == []


def test_the_pages_own_words():
    assert action_in('["looks:", 1]', ME, UAV) == PAGE
    assert action_in('["camera:chase", 1]', ME, UAV) == ShowCamera(ME, "chase")
    assert action_in('["looks:another", 1]', ME, UAV) is None
