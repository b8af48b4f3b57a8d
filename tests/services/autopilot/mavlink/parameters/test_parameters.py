"""The parameter protocol: a complete list, exact values, honest refusals."""

import struct
import zlib

import numpy as np
import pytest

from schemas.messages import Battery, Fence
from services.autopilot.mavlink.parameters import parameter_page
from services.autopilot.mavlink.parameters.parameter_table import FILE, Table, parameters_of
from services.autopilot.mavlink.parameters.parameter_values import param_value
from tests.services.autopilot.mavlink.rig import OTHER, PLANE, PLANE_FACTS, ROVER, ROVER_FACTS, Rig, of, texts
from uvf.mavlink import dialect as mav
from uvf.models.yaml_data import load_yaml

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
    plane = {m.param_id: value(m) for m in ask_list(Rig())}
    rover = {m.param_id: value(m) for m in ask_list(Rig(), ROVER)}
    assert [plane[name] for name in ("COM_LOW_BAT_ACT", "GF_ACTION", "NAV_RCL_ACT")] == [1, -1, 1]
    assert [rover[name] for name in ("GF_ACTION", "NAV_RCL_ACT")] == [1, 0]
    assert (plane["FW_AIRSPD_TRIM"], plane["RTL_RETURN_ALT"], plane["NAV_DLL_ACT"], plane["COM_DL_LOSS_T"]) == (25.0, 40.0, 2, 5)
    assert (rover["NAV_DLL_ACT"], rover["BAT_LOW_THR"], rover["COM_LOW_BAT_ACT"]) == (1, pytest.approx(0.2), 4)
    assert "FW_AIRSPD_TRIM" not in rover and rover["RTL_RETURN_ALT"] == 0.0


@pytest.mark.parametrize("facts", [PLANE_FACTS, ROVER_FACTS])
def test_every_parameter_of_the_autopilot_can_be_reached(facts):
    table = parameters_of(facts)
    reached = {p.own for p in table} | {name for p in table for case in p.cases.values() for name in case.sets}
    assert reached >= set(facts.params.__struct_fields__)


def test_each_name_is_one_for_mavlink():
    for facts in (PLANE_FACTS, ROVER_FACTS):
        names = [p.name for p in parameters_of(facts)]
        assert names == sorted(set(names))
        assert all(len(name) <= 16 and name == name.upper() and name.isascii() for name in names)


def test_each_row_of_the_file_is_somebodys_parameter():
    own = {*PLANE_FACTS.params.__struct_fields__, *ROVER_FACTS.params.__struct_fields__}
    for row in load_yaml(FILE, Table).parameters.values():
        assert {row.own, *(key for case in row.cases.values() for key in case.sets)} - {""} <= own
        assert row.own or row.cases or row.fixed


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
    by_index, again = of(rig.run(), "PARAM_VALUE")
    assert by_name.param_id == by_index.param_id == again.param_id == "BAT_LOW_THR"
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


def setting(name, number, kind=mav.MAV_PARAM_TYPE_REAL32, system=PLANE):
    """PARAM_SET with the bytes of a number of this type."""
    raw = struct.pack("<i" if kind == mav.MAV_PARAM_TYPE_INT32 else "<f", number)
    message = mav.MAVLink_param_set_message(system, 1, name.encode(), 0.0, kind)
    message.unpacker, message.param_value = struct.Struct("<4sBB16sB"), raw
    return message


INT = mav.MAV_PARAM_TYPE_INT32


@pytest.mark.parametrize(
    ("name", "number", "kind", "own"),
    [
        ("FW_AIRSPD_TRIM", 27.5, mav.MAV_PARAM_TYPE_REAL32, {"trim_airspeed": 27.5}),
        ("TRIM_AIRSPEED", 27.5, mav.MAV_PARAM_TYPE_REAL32, {"trim_airspeed": 27.5}),
        ("NAV_LOITER_RAD", 150.0, mav.MAV_PARAM_TYPE_REAL32, {"hold_radius": 150.0}),
        ("RTL_RETURN_ALT", 75.0, mav.MAV_PARAM_TYPE_REAL32, {"return_altitude": 75.0}),
        ("MIS_TAKEOFF_ALT", 33.0, mav.MAV_PARAM_TYPE_REAL32, {"takeoff_alt": 33.0}),
        ("COM_DL_LOSS_T", 12, INT, {"link_timeout": 12.0}),
        ("NAV_DLL_ACT", 3, INT, {"link_action": "land"}),
        ("COM_LOW_BAT_ACT", 2, INT, {"low_action": "warn", "critical_action": "land"}),
        ("COM_LOW_BAT_ACT", 3, INT, {"low_action": "warn", "critical_action": "return", "emergency_action": "land"}),
        ("BAT_EMERGEN_THR", 0.125, mav.MAV_PARAM_TYPE_REAL32, {"emergency_charge": 0.125}),
        ("COM_RC_LOSS_T", 2.0, mav.MAV_PARAM_TYPE_REAL32, {"stick_timeout": 2.0}),
        ("NAV_RCL_ACT", 2, INT, {"stick_action": "return"}),
        ("GF_ACTION", 5, INT, {"fence_action": "land"}),
        ("GF_MAX_HOR_DIST", 800.0, mav.MAV_PARAM_TYPE_REAL32, {"max_distance": 800.0}),
        ("GF_MAX_VER_DIST", 100.0, mav.MAV_PARAM_TYPE_REAL32, {"max_height": 100.0}),
        ("RTL_DESCEND_ALT", 40.0, mav.MAV_PARAM_TYPE_REAL32, {"descend_alt": 40.0}),
        ("RTL_LAND_DELAY", 0.0, mav.MAV_PARAM_TYPE_REAL32, {"land_delay": 0.0}),
        ("LAW", 1, INT, {"law": "thesis"}),
    ],
)
def test_a_parameter_that_is_set_is_the_autopilots(name, number, kind, own):
    rig = Rig()
    rig.run()
    rig.say(setting(name, number, kind))
    heard = rig.run(0.2)
    assert {key: getattr(rig.plane.autopilot.params, key) for key in own} == own
    for listener in (heard, rig.heard(OTHER)):
        assert {m.param_id: value(m) for m in of(listener, "PARAM_VALUE")}[name] == number
    assert of(heard, "PARAM_ERROR") == [] and not [text for text in texts(heard) if name in text]


def test_what_a_number_means_is_told_under_all_its_names():
    rig = Rig()
    rig.run()
    rig.say(setting("COM_LOW_BAT_ACT", 0, INT))
    told = {m.param_id: value(m) for m in of(rig.run(0.3), "PARAM_VALUE")}
    assert told == {"COM_LOW_BAT_ACT": 0, "LOW_ACTION": 0, "CRITICAL_ACTION": 0, "EMERGENCY_ACTION": 0}
    rig.say(setting("LOW_ACTION", 1, INT))
    assert {m.param_id: value(m) for m in of(rig.run(0.3), "PARAM_VALUE")} == {"COM_LOW_BAT_ACT": -1, "LOW_ACTION": 1}


def test_every_parameter_can_be_set_or_says_why_not():
    """Each that can is set to another value, which the autopilot then has; no other one is touched."""
    for system, facts in ((PLANE, PLANE_FACTS), (ROVER, ROVER_FACTS)):
        rig = Rig()
        rig.run()
        vehicle = rig.plane if system == PLANE else rig.rover
        for p in parameters_of(facts):
            before = vehicle.autopilot.params
            numbers = [n for n, case in p.cases.items() if case.sets] or ([p.low, (p.low + p.high) / 2] if p.own else [1.0])
            now = p.number({name: getattr(before, name) for name in before.__struct_fields__})
            other = next((n for n in numbers if np.float32(n) != np.float32(now)), now)
            rig.say(setting(p.name, int(other) if p.is_int else other, p.type, system))
            heard = rig.run(0.16)
            errors = [m.error for m in of(heard, "PARAM_ERROR")]
            if p.fixed:
                assert errors == [mav.MAV_PARAM_ERROR_READ_ONLY] and vehicle.autopilot.params is before, p.name
                assert any(text.startswith(f"{p.name} cannot be set: ") for text in texts(heard))
            else:
                changed = {n for n in before.__struct_fields__ if getattr(before, n) != getattr(vehicle.autopilot.params, n)}
                named = {p.own} if p.own else {name for case in p.cases.values() for name in case.sets}
                assert changed and changed <= named and errors == [], p.name


REFUSED = [
    ("SYS_AUTOSTART", 1, INT, mav.MAV_PARAM_ERROR_READ_ONLY, "SYS_AUTOSTART cannot be set: the airframe is that of the vehicle's file"),
    ("ESTIMATOR", 1, INT, mav.MAV_PARAM_ERROR_READ_ONLY, "ESTIMATOR cannot be set: it is read only when the autopilot starts"),
    ("BAT_LOW_THR", 0.95, mav.MAV_PARAM_TYPE_REAL32, mav.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE, "BAT_LOW_THR is 0 to 0.9"),
    ("BAT_LOW_THR", float("nan"), mav.MAV_PARAM_TYPE_REAL32, mav.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE, "BAT_LOW_THR is 0 to 0.9"),
    ("BAT_LOW_THR", float("-inf"), mav.MAV_PARAM_TYPE_REAL32, mav.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE, "BAT_LOW_THR is 0 to 0.9"),
    ("NAV_DLL_ACT", 6, INT, mav.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE, "NAV_DLL_ACT is 0 (warn), 1 (hold), 2 (return), 3 (land)"),
    ("NAV_DLL_ACT", 0x7FC00001, INT, mav.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE, "NAV_DLL_ACT is 0 (warn)"),
    ("COM_LOW_BAT_ACT", -1, INT, mav.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE, "COM_LOW_BAT_ACT is 0 (warn)"),
    ("NAV_DLL_ACT", 1.0, mav.MAV_PARAM_TYPE_REAL32, mav.MAV_PARAM_ERROR_TYPE_MISMATCH, "NAV_DLL_ACT is a whole number (INT32)"),
    ("BAT_LOW_THR", 0, INT, mav.MAV_PARAM_ERROR_TYPE_MISMATCH, "BAT_LOW_THR is REAL32"),
]


@pytest.mark.parametrize(("name", "number", "kind", "error", "why"), REFUSED)
def test_setting_is_refused_first_by_error_then_by_the_value_that_stays(name, number, kind, error, why):
    rig = Rig()
    rig.run()
    before = {m.param_id: value(m) for m in ask_list(rig)}[name]
    rig.say(setting(name, number, kind))
    heard = rig.run()
    order = [m.get_type() for m in heard if m.get_type().startswith("PARAM")]
    assert order == ["PARAM_ERROR", "PARAM_VALUE"]
    assert of(heard, "PARAM_ERROR")[0].error == error
    assert value(of(heard, "PARAM_VALUE")[0]) == before
    assert any(text.startswith(why) for text in texts(heard)), texts(heard)
    assert of(rig.heard(OTHER), "PARAM_VALUE") == []


def test_a_limit_can_be_set_as_single_precision_has_it_and_small_numbers_stay_exact():
    rig = Rig()
    rig.run()
    for name, number in (("ALPHA_ZERO_LIFT", 0.3), ("FOLLOW_I", 1e-41), ("CHI_INF", 1.57)):
        raw = struct.pack("<f", number)
        rig.say(setting(name, number))
        (told,) = of(rig.run(0.2), "PARAM_VALUE")
        assert struct.pack("<f", told.param_value) == raw


def test_what_the_page_sets_is_told_to_all_and_counts_in_the_hash():
    rig = Rig()
    rig.run()
    before = of(rig.run(), "PARAM_VALUE"), ask_hash(rig)
    assert rig.plane.set("hold_radius", 120.0).accepted
    heard = rig.run()
    for listener in (heard, rig.heard(OTHER)):
        told = {m.param_id: value(m) for m in of(listener, "PARAM_VALUE", PLANE)}
        assert told == {"HOLD_RADIUS": 120.0, "NAV_LOITER_RAD": 120.0}
    assert before[0] == [] and ask_hash(rig) != before[1]


def ask_hash(rig):
    rig.say(mav.MAVLink_param_request_read_message(PLANE, 1, b"_HASH_CHECK", -1))
    (told,) = of(rig.run(), "PARAM_VALUE")
    return struct.pack("<f", told.param_value)


def test_two_stations_that_set_the_same_parameter_both_see_the_last_word():
    rig = Rig()
    rig.run()
    rig.say(setting("NAV_LOITER_RAD", 100.0))
    rig.say(setting("NAV_LOITER_RAD", 130.0), system=254, peer=OTHER)
    for listener in (rig.run(0.3), rig.heard(OTHER)):
        assert [value(m) for m in of(listener, "PARAM_VALUE") if m.param_id == "NAV_LOITER_RAD"][-1] == 130.0


def test_nothing_is_set_in_a_pause_or_by_a_silent_autopilot():
    rig = Rig()
    rig.run()
    rig.clock.state = rig.clock.PAUSED
    rig.say(setting("NAV_LOITER_RAD", 100.0))
    heard = rig.run()
    assert [m.error for m in of(heard, "PARAM_ERROR")] == [mav.MAV_PARAM_ERROR_PERMISSION_DENIED]
    assert "NAV_LOITER_RAD not set: the simulation is paused" in texts(heard)
    silent = Rig(answers=False)
    silent.say(setting("NAV_LOITER_RAD", 100.0))
    assert [m.error for m in of(silent.run(3.0), "PARAM_ERROR")] == [mav.MAV_PARAM_ERROR_PERMISSION_DENIED]


def test_the_documented_page_is_that_of_the_code():
    assert parameter_page.PAGE.read_text() == parameter_page.render(), parameter_page.COMMAND


def test_a_fence_about_home_is_a_fence_until_it_is_switched_off():
    rig = Rig()
    rig.run()
    assert of(rig.run(1.1), "FENCE_STATUS", PLANE) == []
    rig.say(setting("GF_MAX_VER_DIST", 100.0))
    rig.run(0.2)
    heard = rig.run(1.1)
    assert (
        of(heard, "FENCE_STATUS", PLANE)
        and of(heard, "SYS_STATUS", PLANE)[-1].onboard_control_sensors_present & mav.MAV_SYS_STATUS_GEOFENCE
    )
    rig.plane.fence = Fence(disabled=True)
    rig.run(0.1)
    assert of(rig.run(1.1), "FENCE_STATUS", PLANE) == []


def test_thresholds_of_the_battery_are_those_of_its_warnings():
    rig = Rig()
    rig.plane.battery = Battery(voltage=11.0, remaining=0.3)
    assert {m.charge_state for m in of(rig.run(1.1), "BATTERY_STATUS", PLANE)} == {mav.MAV_BATTERY_CHARGE_STATE_OK}
    for name, state in (
        ("BAT_LOW_THR", mav.MAV_BATTERY_CHARGE_STATE_LOW),
        ("BAT_CRIT_THR", mav.MAV_BATTERY_CHARGE_STATE_CRITICAL),
        ("BAT_EMERGEN_THR", mav.MAV_BATTERY_CHARGE_STATE_EMERGENCY),
    ):
        rig.say(setting(name, 0.4))
        rig.run(0.2)
        assert {m.charge_state for m in of(rig.run(1.1), "BATTERY_STATUS", PLANE)} == {state}
