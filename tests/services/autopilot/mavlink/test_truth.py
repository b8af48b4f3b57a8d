"""Every message of the table at its rate, and one truth in all of them: a plane 80 m over a field that lies 300 m high."""

import math
from dataclasses import replace

import pytest

from schemas.messages import AirData, Battery, EstimateQuality, Imu, Mode, SurfaceCommand, Targets, Vector3
from services.autopilot.mavlink.service import MavlinkService
from tests.services.autopilot.mavlink.rig import GCS, ORIGIN, PLANE, PLANE_FACTS, Rig, of, shelves
from uvf.maths import atmosphere
from uvf.maths.rotations import from_euler
from uvf.mavlink import dialect as mav
from uvf.runtime.messages.convert import quaternion

SECONDS = 20.0
RATES = {
    **{"HEARTBEAT": 1.0, "SYS_STATUS": 1.0, "SYSTEM_TIME": 1.0, "GPS_RAW_INT": 5.0, "ATTITUDE": 20.0, "ATTITUDE_QUATERNION": 20.0},
    **{"LOCAL_POSITION_NED": 5.0, "GLOBAL_POSITION_INT": 10.0, "SERVO_OUTPUT_RAW": 4.0, "MISSION_CURRENT": 1.0, "VFR_HUD": 10.0},
    **{"NAV_CONTROLLER_OUTPUT": 3.0, "ATTITUDE_TARGET": 5.0, "POSITION_TARGET_GLOBAL_INT": 2.0, "HIGHRES_IMU": 5.0, "ALTITUDE": 5.0},
    **{"BATTERY_STATUS": 1.0, "ESTIMATOR_STATUS": 1.0, "WIND_COV": 1.0, "VIBRATION": 1.0, "HOME_POSITION": 0.5, "ADSB_VEHICLE": 1.0},
    **{"EXTENDED_SYS_STATE": 1.0, "SCALED_PRESSURE": 1.0, "CURRENT_MODE": 0.5},
}


def truthful():
    """Climbing at 2 m/s in a bank to the right, nose up, to the north-east; home 20 m over the world's origin."""
    rig = Rig(reserved={GCS: PLANE})
    plane = rig.plane
    latitude, longitude, altitude = ORIGIN.geodetic([100.0, 200.0, 80.0])
    plane.gnss.latitude, plane.gnss.longitude, plane.gnss.altitude = latitude, longitude, altitude
    plane.gnss.velocity_enu.CopyFrom(Vector3(x=15.0, y=15.0, z=2.0))
    plane.nav.velocity.CopyFrom(Vector3(x=15.0, y=15.0, z=2.0))
    plane.nav.orientation.CopyFrom(quaternion(from_euler(0.3, -0.1, math.radians(45.0))))
    plane.status.mode, plane.status.armed, plane.status.landed = Mode.MODE_HOLD, True, False
    plane.battery = Battery(voltage=11.1, current=5.0, remaining=0.8)
    static = atmosphere.pressure(380.0)
    plane.sensed = {
        "imu": Imu(specific_force=Vector3(z=9.81)),
        "air_data": AirData(static_pressure=static, differential_pressure=300.0, temperature=285.0),
        "surface_command": SurfaceCommand(throttle=0.5),
        "quality": EstimateQuality(position_known=True, height_known=True, wind_sigma=0.3),
        "targets": Targets(place=Vector3(x=100.0, y=200.0, z=80.0), altitude=80.0, airspeed=25.0, bank=0.3, pitch=0.1),
    }
    return rig


@pytest.fixture(scope="module")
def heard():
    rig = truthful()
    rig.run(1.0)
    return [m for m in rig.run(SECONDS) if m.get_srcSystem() == PLANE]


@pytest.mark.parametrize(("name", "hz"), RATES.items())
def test_rates_are_those_of_the_table(heard, name, hz):
    assert len(of(heard, name)) == pytest.approx(hz * SECONDS, rel=0.1)


def test_one_height_above_the_sea_everywhere(heard):
    last = {name: of(heard, name)[-1] for name in RATES}
    above_sea = {
        "GLOBAL_POSITION_INT": last["GLOBAL_POSITION_INT"].alt * 1e-3,
        "ALTITUDE": last["ALTITUDE"].altitude_amsl,
        "VFR_HUD": last["VFR_HUD"].alt,
        "GPS_RAW_INT": last["GPS_RAW_INT"].alt * 1e-3,
        "POSITION_TARGET_GLOBAL_INT": last["POSITION_TARGET_GLOBAL_INT"].alt,
        "WIND_COV": last["WIND_COV"].wind_alt,
        "HIGHRES_IMU": last["HIGHRES_IMU"].pressure_alt,
        "HOME_POSITION and above it": last["HOME_POSITION"].altitude * 1e-3 + last["GLOBAL_POSITION_INT"].relative_alt * 1e-3,
        "HOME_POSITION and ALTITUDE": last["HOME_POSITION"].altitude * 1e-3 + last["ALTITUDE"].altitude_relative,
    }
    assert above_sea == {name: pytest.approx(380.0, abs=0.5) for name in above_sea}


def test_one_place_everywhere(heard):
    places = [(m.lat, m.lon) for name in ("GLOBAL_POSITION_INT", "GPS_RAW_INT") for m in of(heard, name)[-1:]]
    target = of(heard, "POSITION_TARGET_GLOBAL_INT")[-1]
    places.append((target.lat_int, target.lon_int))
    assert all(abs(a - b) <= 20 for place in places for a, b in zip(place, places[0], strict=True)), "0.2 m"


def test_one_velocity_and_one_heading_everywhere(heard):
    place, local, hud, gps = (of(heard, name)[-1] for name in ("GLOBAL_POSITION_INT", "LOCAL_POSITION_NED", "VFR_HUD", "GPS_RAW_INT"))
    assert (place.vx, place.vy, place.vz) == (1500, 1500, -200), "climbing is negative"
    assert (local.vx, local.vy, local.vz) == (15.0, 15.0, -2.0) and hud.climb == 2.0
    assert hud.groundspeed == pytest.approx(gps.vel * 1e-2, abs=0.01)
    assert hud.heading == 45 and place.hdg == 4500 and gps.cog == 4500


def test_a_bank_to_the_right_with_the_nose_up_is_positive_everywhere(heard):
    m, hold, out = (of(heard, name)[-1] for name in ("ATTITUDE", "ATTITUDE_TARGET", "NAV_CONTROLLER_OUTPUT"))
    assert (m.roll, m.pitch) == pytest.approx((0.3, 0.1), abs=1e-6)
    assert hold.q[1] > 0 and out.nav_roll > 0 and out.nav_pitch > 0


def test_what_is_left_of_the_battery_never_rises_and_its_state_falls_with_it():
    rig, seen = truthful(), []
    for remaining in (0.8, 0.16, 0.14, 0.08, 0.06, 0.05, 0.04, 0.0):
        rig.plane.battery = Battery(voltage=11.1, current=5.0, remaining=remaining)
        m = of(rig.run(1.1), "BATTERY_STATUS", PLANE)[-1]
        seen.append((m.battery_remaining, m.charge_state))
    assert [left for left, _ in seen] == sorted((left for left, _ in seen), reverse=True)
    ok, low, critical, emergency = (
        mav.MAV_BATTERY_CHARGE_STATE_OK,
        mav.MAV_BATTERY_CHARGE_STATE_LOW,
        mav.MAV_BATTERY_CHARGE_STATE_CRITICAL,
        mav.MAV_BATTERY_CHARGE_STATE_EMERGENCY,
    )
    assert [state for _, state in seen] == [ok, ok, low, low, critical, critical, emergency, emergency]


def test_the_time_of_day_goes_by_on_the_wall():
    rig = Rig()
    rig.service = MavlinkService([replace(PLANE_FACTS, started=1.8e9)], rig.link, shelves())
    rig.vehicles = {"plane": rig.plane}
    m = of(rig.run(2.5), "SYSTEM_TIME", PLANE)[-1]
    assert m.time_unix_usec == pytest.approx(1.8e15 + m.time_boot_ms * 1e3, abs=1000) and m.time_boot_ms > 1000
