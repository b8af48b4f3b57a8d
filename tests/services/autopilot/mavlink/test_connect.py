"""A ground station connects: QGroundControl shows its user no complaint, and would show one if an answer were wrong."""

import random
from collections import defaultdict

import pytest

from schemas.messages import Mission, MissionItem, Vector3
from tests.services.autopilot.mavlink import qgroundcontrol as qgc
from tests.services.autopilot.mavlink.qgc_parameters import NO_PARAMETERS, SOME_PARAMETERS
from tests.services.autopilot.mavlink.qgroundcontrol import QGroundControl
from tests.services.autopilot.mavlink.rig import PLANE, ROVER, Rig
from uvf.mavlink import dialect as mav


def connect(system=PLANE, spoil=lambda message: message):
    rig = Rig()
    rig.plane.mission = Mission(id=3, items=[MissionItem(position=Vector3(x=x, y=0.0, z=60.0)) for x in (0.0, 100.0, 200.0)])
    station = QGroundControl(rig, system, spoil)
    return station, station.connect()


@pytest.mark.parametrize("system", [PLANE, ROVER])
def test_it_connects_within_five_seconds_and_without_a_complaint(system):
    station, seconds = connect(system)
    assert station.complaints == station.notes == []
    assert seconds < 5.0
    assert len(station.plans[0]) == (3 if system == PLANE else 0)


def test_plane_and_rover_leave_the_same_modes_behind():
    assert connect(PLANE)[0].modes == connect(ROVER)[0].modes


def without(kind):
    return lambda m: None if m.get_type() == kind else m


def without_parameter(name):
    return lambda m: None if m.get_type() == "PARAM_VALUE" and m.param_id == name else m


def changed(kind, **fields):
    def spoil(message):
        if message.get_type() == kind:
            for name, value in fields.items():
                setattr(message, name, value)
        return message

    return spoil


def without_mode(message):
    """The list leaves out Return."""
    if message.get_type() == "AVAILABLE_MODES" and message.custom_mode == 84148224:
        message.custom_mode = 1
    return message


@pytest.mark.parametrize(
    ("spoil", "complaint"),
    [
        (without("HEARTBEAT"), "no vehicle"),
        (without("PARAM_VALUE"), NO_PARAMETERS),
        (without_parameter("BAT_LOW_THR"), SOME_PARAMETERS),
        (without("MISSION_COUNT"), qgc.PLANS[0]),
        (without("MISSION_ITEM_INT"), qgc.PLANS[0]),
        (without("HOME_POSITION"), qgc.NO_HOME),
        (without_mode, "button Return sets an empty mode"),
        (changed("AUTOPILOT_VERSION", flight_sw_version=1 << 24 | 2 << 16), qgc.OLD_FIRMWARE),
        (changed("AUTOPILOT_VERSION", flight_sw_version=1 << 24 | 16 << 16 | 255), qgc.NOT_STABLE),
    ],
)
def test_each_missing_answer_would_be_noticed(spoil, complaint):
    assert complaint in connect(spoil=spoil)[0].complaints


def test_a_missing_parameter_would_be_noticed():
    def spoil(message):
        if message.get_type() == "PARAM_VALUE" and message.param_id in ("SYS_AUTOSTART", "RTL_RETURN_ALT"):
            message.param_id = f"X_{message.param_index}"
        return message

    complaints = connect(spoil=spoil)[0].complaints
    assert qgc.SETUP in complaints
    assert any(text.startswith(qgc.MISSING) for text in complaints)


def test_without_the_simulation_flag_the_calibration_still_counts_as_done():
    flagless = changed("HEARTBEAT", base_mode=mav.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED)
    assert connect(spoil=flagless)[0].complaints == []


@pytest.mark.parametrize("seed", range(1, 6))
def test_a_fifth_of_all_packets_lost_either_way_costs_time_but_no_complaint(seed):
    """Each kind of message is lost by a chance of its own: how much telemetry goes out besides changes nothing.

    QGroundControl asks five times for a parameter; where all are lost, in one of six connections, it complains whoever answers.
    """
    dice = defaultdict(lambda: random.Random(seed + 1000 * len(dice)))

    def lost(way, message):
        return dice[way, message.get_type()].random() < 0.2

    rig = Rig()
    say = rig.say
    rig.say = lambda message, **where: lost("up", message) or say(message, **where)
    rig.plane.mission = Mission(id=3, items=[MissionItem(position=Vector3(x=x, y=0.0, z=60.0)) for x in (0.0, 100.0, 200.0)])
    station = QGroundControl(rig, PLANE, lambda message: None if lost("down", message) else message)
    assert station.connect() < 40.0  # some 20 s as a rule: QGroundControl's own limits of 1 to 5 s, once for each answer that is lost
    assert station.complaints == []
    assert len(station.plans[0]) == 3


def test_a_lost_packet_now_and_then_costs_time_but_no_complaint():
    seen = {"n": 0}

    def spoil(message):
        seen["n"] += message.get_type() in ("COMMAND_ACK", "AUTOPILOT_VERSION")
        return None if seen["n"] == 1 and message.get_type() == "COMMAND_ACK" else message

    station, seconds = connect(spoil=spoil)
    assert station.complaints == [] and seconds > qgc.ACK_WAIT
