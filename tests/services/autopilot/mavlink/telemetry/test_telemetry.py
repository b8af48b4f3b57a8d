"""What vehicles say unasked: values, signs, units and rates, and that it goes on whatever the simulation does."""

import itertools
import math

import pytest

from schemas.messages import Battery, Clock, Event, Mission, MissionItem, MissionProgress, Mode, Vector3
from services.autopilot.mavlink.telemetry.telemetry import charge_state
from tests.services.autopilot.mavlink.rig import OTHER, PLANE, ROVER, Rig, long, of, texts
from uvf.maths.rotations import from_euler
from uvf.mavlink import dialect as mav
from uvf.runtime.messages.convert import quaternion

LIMITS = {"battery_low": 0.15, "battery_critical": 0.07, "emergency_charge": 0.05}


def newest(rig, name, system=PLANE, seconds=2.1):
    return of(rig.run(seconds), name, system)[-1]


def test_heartbeats_go_to_every_peer_once_a_second_before_anything_is_known():
    rig = Rig()
    rig.reported.clear()
    rig.run(4.0)
    for heard in (rig.heard(), rig.heard(OTHER)):
        for system, kind in ((PLANE, mav.MAV_TYPE_FIXED_WING), (ROVER, mav.MAV_TYPE_GROUND_ROVER)):
            beats = of(heard, "HEARTBEAT", system)
            assert len(beats) == 4
            assert {(m.type, m.autopilot, m.system_status) for m in beats} == {(kind, mav.MAV_AUTOPILOT_PX4, mav.MAV_STATE_BOOT)}


def test_the_first_heartbeat_already_says_that_this_is_a_simulation():
    assert of(Rig().run(0.02), "HEARTBEAT")[0].base_mode & mav.MAV_MODE_FLAG_HIL_ENABLED


@pytest.mark.parametrize("state", [Clock.PAUSED, Clock.RUNNING])
def test_rates_are_those_of_the_wall_clock(state):
    rig = Rig()
    rig.run(1.0)
    rig.clock.state = state
    heard = rig.run(10.0)
    wanted = {"HEARTBEAT": 10, "ATTITUDE": 200, "GLOBAL_POSITION_INT": 100, "VFR_HUD": 100, "ALTITUDE": 50, "GPS_RAW_INT": 50}
    for name, n in {**wanted, "SYS_STATUS": 10, "HOME_POSITION": 5, "EXTENDED_SYS_STATE": 10, "MISSION_CURRENT": 10}.items():
        assert len(of(heard, name, PLANE)) == pytest.approx(n, rel=0.1), name


def test_sequence_numbers_have_no_gaps_for_each_system():
    heard = Rig().run(4.0)
    for system in (PLANE, ROVER):
        seqs = [m.get_seq() for m in heard if m.get_srcSystem() == system]
        assert len(seqs) > 256  # so that they have come round once
        assert {(b - a) % 256 for a, b in itertools.pairwise(seqs)} == {1}


def test_attitude_is_nose_up_right_bank_and_compass_heading():
    rig = Rig()
    rig.plane.nav.orientation.CopyFrom(quaternion(from_euler(0.1, -0.2, math.pi / 2)))  # FLU: nose up is negative
    rig.plane.nav.angular_velocity.CopyFrom(Vector3(x=0.1, y=0.2, z=0.3))
    heard = rig.run(0.1)
    m, q = (of(heard, name, PLANE)[-1] for name in ("ATTITUDE", "ATTITUDE_QUATERNION"))
    assert (m.roll, m.pitch, m.yaw) == pytest.approx((0.1, 0.2, 0.0), abs=1e-6)  # yaw 90 deg from east is north
    assert (m.rollspeed, m.pitchspeed, m.yawspeed) == pytest.approx((0.1, -0.2, -0.3))
    assert (q.q1, q.q2, q.q3, q.q4) == pytest.approx(from_euler(0.1, 0.2, 0.0), abs=1e-6)


def test_altitudes_agree_among_all_messages_at_an_elevated_field():
    rig = Rig()
    heard = rig.run(2.1)
    last = {name: of(heard, name, PLANE)[-1] for name in ("GLOBAL_POSITION_INT", "ALTITUDE", "VFR_HUD", "HOME_POSITION")}
    assert last["GLOBAL_POSITION_INT"].alt == 380_000 and last["GLOBAL_POSITION_INT"].relative_alt == 60_000
    assert last["ALTITUDE"].altitude_amsl == 380.0 and last["ALTITUDE"].altitude_relative == 60.0
    assert last["VFR_HUD"].alt == 380.0
    assert last["HOME_POSITION"].altitude == 320_000


def test_velocities_are_north_east_down():
    rig = Rig()
    heard = rig.run(0.5)
    place, local = (of(heard, name, PLANE)[-1] for name in ("GLOBAL_POSITION_INT", "LOCAL_POSITION_NED"))
    assert (place.vx, place.vy, place.vz) == (400, 300, -100)
    assert (local.x, local.y, local.z, local.vx, local.vz) == (200.0, 100.0, -80.0, 4.0, -1.0)
    hud = of(heard, "VFR_HUD", PLANE)[-1]
    assert (hud.groundspeed, hud.airspeed, hud.climb) == (5.0, 25.0, 1.0)
    assert hud.heading == round(90 - math.degrees(0.3)) == round(place.hdg / 100)


def test_the_position_is_the_one_of_the_world_frame():
    rig = Rig()
    m = newest(rig, "GLOBAL_POSITION_INT", seconds=0.2)
    metres_per_degree = 111_050.0  # of latitude at 40.8 deg
    assert (m.lat * 1e-7 - 40.77) * metres_per_degree == pytest.approx(200.0, abs=0.5)
    assert (m.lon * 1e-7 - 14.79) * metres_per_degree == pytest.approx(100.0 / math.cos(math.radians(40.77)), abs=1.0)


def test_wind_is_told_as_the_velocity_of_the_air():
    rig = Rig()
    rig.plane.nav.wind.CopyFrom(Vector3(x=1.5, y=1.3))
    m = newest(rig, "WIND_COV", seconds=1.1)
    assert (m.wind_x, m.wind_y) == pytest.approx((1.3, 1.5))


@pytest.mark.parametrize(
    ("mode", "landed", "state"),
    [(Mode.MODE_HOLD, True, 1), (Mode.MODE_HOLD, False, 2), (Mode.MODE_TAKEOFF, False, 3), (Mode.MODE_LAND, False, 4)],
)
def test_landed_state_of_a_plane(mode, landed, state):
    rig = Rig()
    rig.run(0.5)
    rig.plane.status.mode, rig.plane.status.landed = mode, landed
    rig.plane.status.stopped = True  # any change is told at once
    assert newest(rig, "EXTENDED_SYS_STATE", seconds=0.02).landed_state == state


def test_an_armed_rover_counts_as_in_the_air():
    rig = Rig()
    assert newest(rig, "EXTENDED_SYS_STATE", ROVER).landed_state == mav.MAV_LANDED_STATE_ON_GROUND
    rig.rover.status.armed = True
    assert newest(rig, "EXTENDED_SYS_STATE", ROVER).landed_state == mav.MAV_LANDED_STATE_IN_AIR


def test_a_rover_without_receiver_wind_or_wings_does_not_report_them():
    heard = Rig().run(3.0)
    assert not {"GPS_RAW_INT", "WIND_COV", "BATTERY_STATUS"} & {m.get_type() for m in heard if m.get_srcSystem() == ROVER}


def test_a_rover_without_receiver_knows_where_on_earth_it_is_once_it_has_an_estimate():
    rig = Rig()
    everybody, rig.reported = rig.reported, {"plane"}
    bits = [newest(rig, "SYS_STATUS", ROVER)]
    rig.reported = everybody
    bits.append(newest(rig, "SYS_STATUS", ROVER))
    assert [bool(m.onboard_control_sensors_health & mav.MAV_SYS_STATUS_SENSOR_GPS) for m in bits] == [False, True]


def test_battery():
    rig = Rig()
    rig.plane.battery = Battery(voltage=11.1, current=5.25, remaining=0.06)
    heard = rig.run(1.1)
    m, s = of(heard, "BATTERY_STATUS", PLANE)[-1], of(heard, "SYS_STATUS", PLANE)[-1]
    assert (m.voltages[0], m.voltages[1], m.current_battery, m.battery_remaining) == (11100, 65535, 525, 6)
    assert m.charge_state == mav.MAV_BATTERY_CHARGE_STATE_CRITICAL
    assert (s.voltage_battery, s.current_battery, s.battery_remaining) == (11100, 525, 6)


def test_charge_states_fall_with_the_charge():
    assert [charge_state(r, LIMITS) for r in (0.9, 0.15, 0.14, 0.06, 0.01)] == [1, 1, 2, 3, 4]
    assert charge_state(-1.0, LIMITS) == charge_state(math.nan, LIMITS) == 0


def test_distance_and_bearing_to_the_item_flown():
    rig = Rig()
    rig.plane.mission = Mission(id=1, items=[MissionItem(position=Vector3(x=100.0, y=900.0, z=80.0))])
    rig.plane.progress = MissionProgress(state=MissionProgress.ACTIVE, total=1)
    assert not of(rig.run(1.0), "NAV_CONTROLLER_OUTPUT")
    rig.plane.status.mode, rig.plane.status.distance_to_waypoint = Mode.MODE_MISSION, 700.0
    m = newest(rig, "NAV_CONTROLLER_OUTPUT")
    assert (m.target_bearing, m.wp_dist) == (0, 700)


def test_a_vehicle_that_falls_silent_is_critical_and_not_ready():
    rig = Rig()
    rig.run(1.0)
    rig.reported = {"rover"}
    heard = rig.run(4.0)
    assert of(heard, "HEARTBEAT", PLANE)[-1].system_status == mav.MAV_STATE_CRITICAL
    assert of(heard, "SYS_STATUS", PLANE)[-1].onboard_control_sensors_health == mav.MAV_SYS_STATUS_GEOFENCE
    assert "PreArm: estimator or autopilot has gone silent" in texts(heard)
    assert of(heard, "HEARTBEAT", ROVER)[-1].system_status == mav.MAV_STATE_STANDBY


def test_numbers_that_are_none_break_nothing():
    rig = Rig()
    rig.plane.battery = Battery(voltage=math.nan, current=math.inf, remaining=-math.inf)
    rig.plane.gnss.latitude = math.nan
    for vector in (rig.plane.nav.position, rig.plane.nav.velocity, rig.plane.status.home):
        vector.x = vector.y = vector.z = math.nan
    rig.plane.nav.orientation.w = math.nan
    rig.plane.nav.airspeed = 1e300
    heard = rig.run(3.0)
    assert len(of(heard, "HEARTBEAT", PLANE)) == 3
    assert not of(heard, "GLOBAL_POSITION_INT", PLANE) and not of(heard, "HOME_POSITION", PLANE)
    assert rig.service.codec.counts.unsendable > 0


def test_events_are_passed_on_once_with_their_severity():
    rig = Rig()
    rig.run()
    rig.events = {"plane": [Event(severity=Event.WARNING, text="wind is strong", cause="gust " * 20)]}
    heard = rig.run()
    assert next(t for t in texts(heard) if t.startswith("wind is strong: gust")).count("gust") == 20
    assert {m.severity for m in of(heard, "STATUSTEXT", PLANE)} == {mav.MAV_SEVERITY_WARNING}
    rig.events = {"plane": [Event(severity=Event.WARNING, text="wind is strong", cause="gust " * 20)]}
    assert texts(rig.run()) == []


def test_every_peer_is_greeted_once_with_what_this_is():
    rig = Rig()
    rig.run()
    beat = mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3)
    rig.say(beat)
    greetings = [t for t in texts(rig.run(1.6)) if "not PX4" in t]
    assert len(greetings) == 2
    assert not of(rig.heard(OTHER), "STATUSTEXT")
    rig.say(beat)
    assert texts(rig.run(15.0)) == []


def test_version_says_simulated_level_and_own_number():
    rig = Rig()
    for system in (PLANE, ROVER):
        rig.say(long(512, 148.0, system=system))
    plane, rover = of(rig.run(), "AUTOPILOT_VERSION")
    assert plane.middleware_sw_version > 0
    assert plane.flight_sw_version == 1 << 24 | 16 << 16
    assert plane.uid != rover.uid and bytes(plane.uid2) != bytes(rover.uid2)
    for capability in (mav.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE, mav.MAV_PROTOCOL_CAPABILITY_MISSION_RALLY):
        assert plane.capabilities & rover.capabilities & capability


def test_a_vehicle_says_about_a_hundred_messages_a_second():
    rig = Rig()
    rig.run(1.0)
    assert 60 < len([m for m in rig.run(1.0) if m.get_srcSystem() == PLANE]) < 150
