"""Who a vehicle says it is: PX4-compatible and not PX4, or generic with the same modes and parameters."""

from dataclasses import replace

import pytest

from services.autopilot.mavlink.parameters.parameters import HASH
from services.autopilot.mavlink.service import MavlinkService
from services.autopilot.mavlink.telemetry.identity import VERSION
from tests.services.autopilot.mavlink.rig import PLANE, PLANE_FACTS, ROVER, ROVER_FACTS, Rig, acks, long, of, shelves, texts
from uvf.mavlink import dialect as mav

BEAT = mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3)


def rig_as(generic):
    rig = Rig()
    rig.service = MavlinkService([replace(facts, generic=generic) for facts in (PLANE_FACTS, ROVER_FACTS)], rig.link, shelves())
    rig.run()
    return rig


def told(rig, system=PLANE):
    """Everything that a ground station asks at the beginning: modes and parameters, byte by byte."""
    rig.say(long(512, float(mav.MAVLINK_MSG_ID_AVAILABLE_MODES), 0.0, system=system))
    modes = [m.to_dict() for m in of(rig.run(), "AVAILABLE_MODES")]
    rig.say(mav.MAVLink_param_request_list_message(system, 0))
    parameters = {m.param_id: bytes(m.get_payload()) for m in of(rig.run(5.0), "PARAM_VALUE")}
    assert len(modes) > 5 and len(parameters) > 20
    return modes, parameters


def version(rig, system=PLANE):
    rig.say(long(512, 148.0, system=system))
    return of(rig.run(), "AUTOPILOT_VERSION")[0]


@pytest.mark.parametrize(("generic", "autopilot"), [(False, mav.MAV_AUTOPILOT_PX4), (True, mav.MAV_AUTOPILOT_GENERIC)])
def test_the_heartbeat_names_the_autopilot(generic, autopilot):
    beats = of(rig_as(generic).run(2.0), "HEARTBEAT")
    assert {m.autopilot for m in beats} == {autopilot}
    assert all(m.base_mode & mav.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED and m.custom_mode for m in beats)


@pytest.mark.parametrize("system", [PLANE, ROVER])
def test_a_generic_vehicle_has_the_same_modes_and_parameters(system):
    modes, parameters = told(rig_as(True), system)
    same, likewise = told(rig_as(False), system)
    assert modes == same
    assert {k: v for k, v in parameters.items() if k != HASH} == {k: v for k, v in likewise.items() if k != HASH}


def test_it_answers_for_its_capabilities_so_that_nothing_is_left_out():
    assert version(rig_as(True)).capabilities == version(rig_as(False)).capabilities


def test_a_generic_vehicle_obeys_the_same_mode_words():
    rig = rig_as(True)
    rig.say(long(176, 1.0, 4.0, 5.0))
    heard = rig.run()
    assert acks(heard) == [(176, 0)]
    assert of(heard, "HEARTBEAT", PLANE)[-1].custom_mode == 84148224


def test_versions_are_the_emulated_interface_or_the_own_one():
    px4, generic = version(rig_as(False)), version(rig_as(True))
    assert px4.flight_sw_version >> 8 == 0x011000 and px4.flight_sw_version & 0xFF == 0, "1.16.0, type DEV"
    assert tuple(generic.flight_sw_version.to_bytes(4, "big")) == (*VERSION, 0)
    for m in (px4, generic):
        assert tuple(m.flight_custom_version[:3]) == VERSION[::-1]
        assert (m.vendor_id, m.product_id) != (0, 0) and m.vendor_id != 0x26AC, "not PX4's"


def test_no_two_vehicles_have_the_same_uid():
    rig = rig_as(False)
    seen = [version(rig, system) for system in (PLANE, ROVER)]
    assert len({m.uid for m in seen}) == len({bytes(m.uid2) for m in seen}) == 2 and all(m.uid for m in seen)


@pytest.mark.parametrize(("generic", "words"), [(False, "PX4-compatible MAVLink, not PX4"), (True, "generic MAVLink")])
def test_the_greeting_says_what_this_is(generic, words):
    rig = rig_as(generic)
    rig.say(BEAT)
    greetings = [t for t in texts(rig.run(2.0)) if "simulated autopilot" in t]
    assert greetings == [f"UVF {'.'.join(map(str, VERSION))} simulated autopilot ({words})"] * 2


@pytest.mark.parametrize(("generic", "altitude", "height"), [(False, 380.0, 80.0), (True, 60.0, 80.0)])
def test_the_altitude_of_a_take_off_is_that_of_the_convention(generic, altitude, height):
    """Home is 320 m above the sea, and the world's origin 300 m."""
    rig = rig_as(generic)
    rig.plane.nav.position.z = 20.0
    rig.say(long(mav.MAV_CMD_NAV_TAKEOFF, *[float("nan")] * 6, altitude))
    assert acks(rig.run()) == [(mav.MAV_CMD_NAV_TAKEOFF, mav.MAV_RESULT_ACCEPTED)]
    assert [order.takeoff.altitude for name, order in rig.plane.asked if name == "order"] == [pytest.approx(height)]
