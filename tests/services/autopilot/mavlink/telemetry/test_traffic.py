"""The other vehicles of the mission, as traffic."""

import math
from dataclasses import replace

import pytest

from schemas.messages import Vector3
from services.autopilot.mavlink.telemetry.traffic import address, callsign
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, PLANE_FACTS, ROVER, ROVER_FACTS, Rig, acks, long, of
from uvf.mavlink import dialect as mav


def alone(system):
    """A station at a port of one vehicle, which hears no other."""
    return Rig(reserved={GCS: system})


def test_who_hears_one_vehicle_alone_sees_the_others_once_a_second():
    for own, other in ((PLANE, ROVER_FACTS), (ROVER, PLANE_FACTS)):
        heard = alone(own).run(10.0)
        assert {m.ICAO_address for m in of(heard, "ADSB_VEHICLE", own)} == {address(other)}
        assert len(of(heard, "ADSB_VEHICLE", own)) == pytest.approx(10, abs=1)


def test_who_hears_them_all_sees_none_twice():
    rig = alone(PLANE)
    rig.run(2.5)
    assert not of(rig.heard(OTHER), "ADSB_VEHICLE")


def test_place_course_and_speeds_are_those_of_the_estimate():
    rig = alone(ROVER)
    m = of(rig.run(2.0), "ADSB_VEHICLE", ROVER)[-1]
    own = of(rig.heard(OTHER), "GLOBAL_POSITION_INT", PLANE)[-1]
    assert (m.lat, m.lon, m.altitude) == (own.lat, own.lon, own.alt)
    assert (m.hor_velocity, m.ver_velocity) == (500, 100), "cm/s, up"
    assert m.heading == pytest.approx(math.degrees(math.atan2(3.0, 4.0)) * 100, abs=1), "course over ground"
    assert (m.callsign, m.emitter_type, m.tslc) == ("PLANE", mav.ADSB_EMITTER_TYPE_UAV, 0)
    assert m.altitude_type == mav.ADSB_ALTITUDE_TYPE_GEOMETRIC
    assert m.flags & mav.ADSB_FLAGS_SIMULATED and not m.flags & mav.ADSB_FLAGS_VALID_SQUAWK


def test_who_stands_goes_where_it_looks():
    rig = alone(PLANE)
    rig.rover.nav.velocity.CopyFrom(Vector3(x=-0.05))
    m = of(rig.run(2.0), "ADSB_VEHICLE", PLANE)[-1]
    assert m.heading == pytest.approx(of(rig.heard(OTHER), "GLOBAL_POSITION_INT", ROVER)[-1].hdg, abs=1)
    assert m.emitter_type == mav.ADSB_EMITTER_TYPE_SERVICE_SURFACE


def test_who_has_fallen_silent_or_is_nowhere_is_not_seen():
    rig = alone(ROVER)
    rig.reported = {"rover"}
    assert not of(rig.run(3.0), "ADSB_VEHICLE", ROVER)
    rig = alone(ROVER)
    rig.plane.nav.position.x = math.nan
    assert not of(rig.run(3.0), "ADSB_VEHICLE", ROVER)


def test_callsigns_fit_and_differ():
    def named(name, system_id):
        return callsign(replace(PLANE_FACTS, name=name, system_id=system_id))

    assert named("milvus_1", 1) == "MILVUS1"
    assert [named("very_long_name", n) for n in (1, 12, 123)] == ["VERYLON1", "VERYLO12", "VERYL123"]


def test_addresses_fit_into_24_bits_and_differ():
    seen = {address(replace(PLANE_FACTS, name="plane", system_id=n)) for n in range(1, 245)}
    assert len(seen) == 244 and all(0 < a < 2**24 for a in seen)


def test_it_can_be_asked_for_and_switched_off():
    rig = alone(PLANE)
    rig.run()
    rig.say(long(mav.MAV_CMD_SET_MESSAGE_INTERVAL, float(mav.MAVLINK_MSG_ID_ADSB_VEHICLE), -1.0))
    rig.run()
    assert not of(rig.run(3.0), "ADSB_VEHICLE", PLANE)
    rig.say(long(512, float(mav.MAVLINK_MSG_ID_ADSB_VEHICLE)))
    heard = rig.run()
    assert acks(heard) == [(512, 0)] and len(of(heard, "ADSB_VEHICLE", PLANE)) == 1
