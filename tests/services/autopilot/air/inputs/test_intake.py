"""Messages into the autopilot's frames, and mission items kept as they came."""

import math

import pytest

from schemas.messages import AirData, Gnss, Imu, MissionItem, Vector3
from services.autopilot.air.inputs import intake
from uvf.guidance.flight_plan import ItemKind
from uvf.maths.geodesy import LocalTangent
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.plans.plan_items import plan_items

TANGENT = LocalTangent.from_degrees(40.77, 14.79, 300.0)


def test_body_vectors_turn_from_flu_into_frd():
    imu = Imu(timestamp=stamp(1.0), angular_velocity=Vector3(x=1, y=2, z=3), specific_force=Vector3(z=9.8))
    sample = intake.inertial(imu, 1.01)
    assert sample.rates == (1, -2, -3)
    assert sample.force == (0, 0, -9.8)
    assert sample.age == pytest.approx(0.01)


def test_a_fix_becomes_a_place_in_the_world():
    latitude, longitude, altitude = TANGENT.geodetic([120.0, -40.0, 60.0])
    message = Gnss(timestamp=stamp(2.0), fix=Gnss.FIX_3D, latitude=latitude, longitude=longitude, altitude=altitude)
    message.velocity_enu.CopyFrom(Vector3(x=3, y=4, z=1))
    fix = intake.fix(message, TANGENT, 2.1)
    assert (fix.north, fix.east, fix.height) == pytest.approx((-40.0, 120.0, 60.0), abs=1e-2)
    assert (fix.v_north, fix.v_east, fix.v_up) == (4, 3, 1)
    assert fix.age == pytest.approx(0.1)


@pytest.mark.parametrize("stamped", [0.0, 8.9, 90.0])
def test_a_sample_of_no_time_near_is_none(stamped):
    """One that is stamped ahead made the filter take all after it as late."""
    assert intake.inertial(Imu(timestamp=stamp(stamped)), 8.7 if stamped > 8 else 8.0) is None
    assert intake.inertial(Imu(timestamp=stamp(8.0)), 8.01) is not None


@pytest.mark.parametrize("stamped", [0.0, 90.0])
def test_a_fix_of_no_time_near_is_none(stamped):
    assert intake.fix(Gnss(timestamp=stamp(stamped), fix=Gnss.FIX_3D, latitude=0.71, longitude=0.25), TANGENT, 8.0) is None


@pytest.mark.parametrize("reading", [(0.0, 0.0, 288.0), (101_325.0, 1e6, 288.0), (101_325.0, 0.0, 0.0), (2e6, 0.0, 288.0)])
def test_air_that_there_is_not_is_no_reading(reading):
    """0 Pa is infinitely high."""
    static, differential, temperature = reading
    message = AirData(timestamp=stamp(1.0), static_pressure=static, differential_pressure=differential, temperature=temperature)
    assert intake.pressures(message, 1.0) is None


def test_items_keep_their_meaning():
    orbit = MissionItem(kind=MissionItem.ORBIT, position=Vector3(x=1, y=2, z=3), radius=-80, turns=2)
    (item,) = plan_items([orbit])
    assert (item.kind, item.place.north, item.place.east, item.place.height) == (ItemKind.ORBIT, 2, 1, 3)
    assert (item.radius, item.turns) == (-80, 2)


def test_a_course_is_turned_from_the_mathematical_to_the_compass_sense_and_may_be_absent():
    south_east, some = plan_items([MissionItem(course=-math.pi / 4, acceptance_radius=5.0), MissionItem()])
    assert (south_east.course, south_east.acceptance) == pytest.approx((3 * math.pi / 4, 5.0))
    assert (some.course, some.acceptance) == (None, math.inf)


@pytest.mark.parametrize("kind", [98, 99])
def test_an_item_that_cannot_be_flown_yet_is_named(kind):
    with pytest.raises(ValueError, match=r"item 0: .* is not flown"):
        plan_items([MissionItem(kind=kind)])


def test_the_wire_form_of_an_item_is_kept():
    mission = intake.with_id([MissionItem(origin=b"\x01\x00\xff")])
    assert mission.items[0].origin == b"\x01\x00\xff"
