"""Modes of PX4, ArduPilot and of autopilots that tell their own list, both ways."""

import pytest

from schemas.messages import Mode
from services.mavlink_bridge.modes import Modes
from uvf.mavlink import dialect as mav

PX4, ARDUPILOT = mav.MAV_AUTOPILOT_PX4, mav.MAV_AUTOPILOT_ARDUPILOTMEGA
PLANE, ROVER, COPTER = mav.MAV_TYPE_FIXED_WING, mav.MAV_TYPE_GROUND_ROVER, mav.MAV_TYPE_QUADROTOR


@pytest.mark.parametrize(
    ("autopilot", "type_", "custom", "mode"),
    [
        (PX4, PLANE, 67371008, Mode.MODE_MISSION),
        (PX4, ROVER, 84148224, Mode.MODE_RETURN),
        (ARDUPILOT, PLANE, 10, Mode.MODE_MISSION),
        (ARDUPILOT, PLANE, 12, Mode.MODE_HOLD),
        (ARDUPILOT, PLANE, 15, Mode.MODE_HOLD),
        (ARDUPILOT, ROVER, 4, Mode.MODE_HOLD),
        (ARDUPILOT, ROVER, 10, Mode.MODE_MISSION),
        (ARDUPILOT, COPTER, 3, Mode.MODE_UNSPECIFIED),
        (PX4, PLANE, 12345, Mode.MODE_UNSPECIFIED),
    ],
)
def test_a_word_means_a_mode_or_nothing(autopilot, type_, custom, mode):
    assert Modes(autopilot, type_).mode_of(custom) == mode


@pytest.mark.parametrize(
    ("autopilot", "type_", "mode", "parameters"),
    [
        (PX4, PLANE, Mode.MODE_HOLD, (1.0, 4.0, 3.0)),
        (PX4, PLANE, Mode.MODE_MANUAL, (1.0, 1.0, 0.0)),
        (ARDUPILOT, PLANE, Mode.MODE_HOLD, (1.0, 12.0, 0.0)),
        (ARDUPILOT, PLANE, Mode.MODE_RETURN, (1.0, 11.0, 0.0)),
        (ARDUPILOT, ROVER, Mode.MODE_HOLD, (1.0, 4.0, 0.0)),
        (ARDUPILOT, ROVER, Mode.MODE_MISSION, (1.0, 10.0, 0.0)),
    ],
)
def test_a_mode_is_asked_for_as_the_autopilot_has_it(autopilot, type_, mode, parameters):
    modes = Modes(autopilot, type_)
    assert modes.command_parameters(modes.custom_of(mode)) == parameters


def test_what_an_autopilot_has_not_is_not_asked_for():
    assert Modes(ARDUPILOT, ROVER).custom_of(Mode.MODE_TAKEOFF) is None
    assert Modes(PX4, PLANE).custom_of(Mode.MODE_UNSPECIFIED) is None


def test_its_own_list_is_better_than_what_is_known_of_it():
    modes = Modes(ARDUPILOT, COPTER)
    own = ((mav.MAV_STANDARD_MODE_MISSION, 3, b"AUTO"), (0, 5, b"LOITER"), (0, 33, b"ZIGZAG"), (mav.MAV_STANDARD_MODE_LAND, 9, b"LAND"))
    for index, (standard, custom, name) in enumerate(own, 1):
        modes.hear(mav.MAVLink_available_modes_message(len(own), index, standard, custom, 0, name))
    assert [modes.mode_of(c) for c in (3, 5, 33, 9)] == [Mode.MODE_MISSION, Mode.MODE_HOLD, Mode.MODE_UNSPECIFIED, Mode.MODE_LAND]
    assert modes.name_of(33) == "ZIGZAG" and modes.custom_of(Mode.MODE_LAND) == 9
