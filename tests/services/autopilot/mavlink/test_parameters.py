"""The parameter protocol: a complete list, exact values, honest refusals."""

import struct
import zlib

import pytest

from services.autopilot.mavlink import dialect as mav
from services.autopilot.mavlink.parameter_table import param_value, parameters_of
from tests.services.autopilot.mavlink.rig import PLANE, PLANE_FACTS, ROVER, ROVER_FACTS, Rig, of, texts

MANDATORY = ("SYS_AUTOSTART", "CAL_GYRO0_ID", "CAL_ACC0_ID", "CAL_MAG0_ID", "SYS_HAS_NUM_ASPD", "COM_RC_IN_MODE")
SUMMARY_PAGES = (
    "MAV_SYS_ID",
    "COM_FLTMODE1",
    "COM_FLTMODE6",
    "RC_MAP_ROLL",
    "RC_MAP_PITCH",
    "RC_MAP_YAW",
    "RC_MAP_THROTTLE",
    "RC_MAP_FLAPS",
    "RC_MAP_AUX1",
    "RC_MAP_AUX2",
    "RTL_RETURN_ALT",
    "RTL_DESCEND_ALT",
    "RTL_LAND_DELAY",
    "COM_RC_LOSS_T",
    "COM_LOW_BAT_ACT",
    "NAV_RCL_ACT",
    "NAV_DLL_ACT",
    "COM_DL_LOSS_T",
    "BAT_LOW_THR",
    "BAT_CRIT_THR",
    "BAT_EMERGEN_THR",
    "GF_ACTION",
    "GF_MAX_HOR_DIST",
    "GF_MAX_VER_DIST",
    "SYS_AUTOCONFIG",
    "CAL_MAG1_ID",
    "CAL_MAG2_ID",
)


def value(message):
    """The number in a PARAM_VALUE, its bytes read as its type says."""
    raw = struct.pack("<f", message.param_value)
    return struct.unpack("<i" if message.param_type == mav.MAV_PARAM_TYPE_INT32 else "<f", raw)[0]


def ask_list(rig, system=PLANE, seconds=2.0):
    rig.say(mav.MAVLink_param_request_list_message(system, 0))
    return of(rig.run(seconds), "PARAM_VALUE", system)


def test_the_list_is_complete_contiguous_and_paced():
    rig = Rig()
    first = ask_list(rig, seconds=0.02)
    assert first[0].param_id == "_HASH_CHECK" and len(first) <= 5
    values = first[1:] + of(rig.run(2.0), "PARAM_VALUE", PLANE)
    assert [m.param_index for m in values] == list(range(values[0].param_count))


@pytest.mark.parametrize("system", [PLANE, ROVER])
def test_what_qgroundcontrol_reads_without_complaint_is_there(system):
    values = {m.param_id: value(m) for m in ask_list(Rig(), system)}
    assert {*MANDATORY, *SUMMARY_PAGES} <= values.keys()
    assert values["SYS_AUTOSTART"] != 0 and values["COM_RC_IN_MODE"] == 1 and values["MAV_SYS_ID"] == system
    assert "SYS_HITL" not in values


def test_values_follow_the_vehicle():
    plane = {p.name: p.raw for p in parameters_of(PLANE_FACTS)}
    assert struct.unpack("<f", plane["FW_AIRSPD_TRIM"]) == (25.0,)
    assert struct.unpack("<f", plane["RTL_RETURN_ALT"]) == (40.0,)
    assert "FW_AIRSPD_TRIM" not in {p.name for p in parameters_of(ROVER_FACTS)}


def test_the_hash_is_the_one_a_ground_station_computes_from_the_list():
    hashed, *values = ask_list(Rig())
    data = b"".join(m.param_id.encode() + struct.pack("<f", m.param_value) for m in sorted(values, key=lambda m: m.param_id))
    crc = 0
    for byte in data:  # CRC-32, reflected polynomial, start 0, not inverted
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xEDB88320 if crc & 1 else 0)
    assert struct.pack("<f", hashed.param_value) == struct.pack("<I", crc)
    assert crc == zlib.crc32(data, 0xFFFFFFFF) ^ 0xFFFFFFFF


def test_a_hash_sent_back_ends_the_list():
    rig = Rig()
    ask_list(rig, seconds=0.02)
    rig.say(mav.MAVLink_param_set_message(PLANE, 1, b"_HASH_CHECK", 0.0, mav.MAV_PARAM_TYPE_UINT32))
    assert of(rig.run(1.0), "PARAM_VALUE") == []


@pytest.mark.parametrize("bits", [0xFFFFFFFF, 0, 0x7FFFFFFF, 0x7FC00001, 0x7F800001, 0xFFBFFFFF])
def test_integers_travel_bit_for_bit(bits):
    raw = struct.pack("<I", bits)
    packet = param_value("X", raw, mav.MAV_PARAM_TYPE_INT32, (1, 0)).pack(mav.MAVLink(None))
    assert packet[10:14] == raw


def test_single_values_by_name_and_by_index():
    rig = Rig()
    rig.say(mav.MAVLink_param_request_read_message(PLANE, 1, b"BAT_LOW_THR", -1))
    (by_name,) = of(rig.run(), "PARAM_VALUE")
    rig.say(mav.MAVLink_param_request_read_message(PLANE, 1, b"", by_name.param_index))
    (by_index,) = of(rig.run(), "PARAM_VALUE")
    assert by_name.param_id == by_index.param_id == "BAT_LOW_THR"
    assert value(by_name) == pytest.approx(0.15)


@pytest.mark.parametrize(
    "message",
    [
        mav.MAVLink_param_request_read_message(PLANE, 1, b"NOPE", -1),
        mav.MAVLink_param_request_read_message(PLANE, 1, b"", 3000),
        mav.MAVLink_param_request_read_message(PLANE, 1, b"", -7),
        mav.MAVLink_param_set_message(PLANE, 1, b"NOPE", 1.0, mav.MAV_PARAM_TYPE_REAL32),
    ],
)
def test_what_does_not_exist_is_said_so(message):
    rig = Rig()
    rig.say(message)
    heard = rig.run()
    assert [m.error for m in of(heard, "PARAM_ERROR")] == [mav.MAV_PARAM_ERROR_DOES_NOT_EXIST]
    assert of(heard, "PARAM_VALUE") == []


def test_setting_is_refused_first_by_error_then_by_the_value_that_stays():
    rig = Rig()
    rig.say(mav.MAVLink_param_set_message(PLANE, 1, b"BAT_LOW_THR", 0.5, mav.MAV_PARAM_TYPE_REAL32))
    heard = rig.run()
    order = [m.get_type() for m in heard if m.get_type().startswith("PARAM")]
    assert order == ["PARAM_ERROR", "PARAM_VALUE"]
    assert of(heard, "PARAM_ERROR")[0].error == mav.MAV_PARAM_ERROR_READ_ONLY
    assert value(of(heard, "PARAM_VALUE")[0]) == pytest.approx(0.15)
    assert "BAT_LOW_THR is fixed in this simulator" in texts(heard)
