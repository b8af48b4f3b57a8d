"""Ports that hear all vehicles, and ports of one vehicle alone."""

import pytest

from services.autopilot.mavlink.connection.targets import MavlinkTarget, reserved, targets_from, where_mavlink_goes
from services.autopilot.mavlink.service import MavlinkService
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, PLANE_FACTS, ROVER, ROVER_FACTS, Rig, long, of, shelves, texts
from uvf.mavlink import dialect as mav
from uvf.models.yaml_data import BadInput

VERSION = float(mav.MAVLINK_MSG_ID_AUTOPILOT_VERSION)
NAME = "UVF_MAVLINK_TARGETS"


@pytest.fixture
def rig():
    """The second port is the rover's."""
    rig = Rig()
    rig.service = MavlinkService([PLANE_FACTS, ROVER_FACTS], rig.link, shelves(), reserved={OTHER: ROVER})
    return rig


def test_a_port_is_for_all_vehicles_or_for_one():
    read = targets_from("10.0.0.2:14550, 127.0.0.1:14541/2,", NAME, (1, 2))
    assert read == [MavlinkTarget(("10.0.0.2", 14550)), MavlinkTarget(("127.0.0.1", 14541), 2)]
    assert reserved([MavlinkTarget(("10.0.0.2", 14550)), MavlinkTarget(("localhost", 14541), 2)]) == {("127.0.0.1", 14541): 2}


@pytest.mark.parametrize("text", ["127.0.0.1:14541/3", "127.0.0.1:14541/", "127.0.0.1:14541/milvus"])
def test_a_vehicle_that_there_is_not_is_named_with_those_that_there_are(text):
    with pytest.raises(BadInput, match=r"UVF_MAVLINK_TARGETS.*the mission has 1, 2"):
        targets_from(text, NAME, (2, 1))


def test_a_reserved_port_hears_its_vehicle_alone(rig):
    rig.run(3.0)
    assert {m.get_srcSystem() for m in rig.heard(OTHER)} == {ROVER}
    assert {m.get_srcSystem() for m in rig.heard(GCS)} == {PLANE, ROVER}


def test_it_is_greeted_by_its_vehicle_and_cannot_command_another(rig):
    rig.run(0.5)
    rig.say(long(mav.MAV_CMD_REQUEST_MESSAGE, VERSION, system=0), peer=OTHER)
    rig.say(long(mav.MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0, system=PLANE), peer=OTHER)
    rig.run(1.6)
    heard = rig.heard(OTHER)
    assert len([text for text in texts(heard) if "simulated autopilot" in text]) == 1
    assert [m.get_srcSystem() for m in of(heard, "AUTOPILOT_VERSION")] == [ROVER]
    assert not rig.plane.asked


@pytest.mark.parametrize(
    ("environment", "line"),
    [
        ({}, "MAVLink: to UDP 127.0.0.1:14550, 127.0.0.1:14540 (QGroundControl: just start it), listens on UDP 127.0.0.1:14580"),
        ({"UVF_MAVLINK_TARGETS": "10.0.0.2:14550"}, "MAVLink: to UDP 10.0.0.2:14550, listens on UDP 127.0.0.1:14580"),
        ({"UVF_MAVLINK_TARGETS": ""}, "MAVLink: listens on UDP 127.0.0.1:14580"),
        ({"UVF_MAVLINK_TARGETS": "", "UVF_MAVLINK_LISTEN": ""}, "MAVLink: off"),
    ],
)
def test_whoever_starts_a_mission_is_told_where_mavlink_goes(environment, line):
    assert where_mavlink_goes(environment) == line
