"""Sensors, actuators, targets and quality of the estimate: real data in the units and axes of MAVLink, nothing without it."""

import math
from dataclasses import replace

import msgspec
import numpy as np
import pytest

from schemas.messages import AirData, EstimateQuality, Imu, NavStatus, SurfaceCommand, Targets, Vector3, WheelCommand
from services.autopilot.mavlink.connection.vibration import Vibration
from services.autopilot.mavlink.telemetry.sensor_messages import body_frd
from tests.services.autopilot.mavlink.rig import CAR_FACTS, PLANE, PLANE_FACTS, ROVER, Rig, acks, long, of
from uvf.maths import atmosphere
from uvf.maths.rotations import FLU_FROM_FRD, from_euler, inverse, rotate, to_euler
from uvf.mavlink import dialect as mav
from uvf.models.vehicle.air import Surface
from uvf.runtime.messages.convert import stamp

LEVEL = Imu(specific_force=Vector3(x=0.1, y=0.2, z=9.81), angular_velocity=Vector3(x=0.1, y=0.2, z=0.3))


def newest(rig, name, system=PLANE, seconds=2.1):
    return of(rig.run(seconds), name, system)[-1]


def rig_with(**sensed):
    rig = Rig()
    rig.plane.sensed = sensed
    return rig


def test_inertial_readings_are_forward_right_down_and_gravity_is_up():
    imu = Imu()
    imu.CopyFrom(LEVEL)
    imu.magnetic_field.CopyFrom(Vector3(x=2e-5, y=1e-5, z=-4e-5))
    m = newest(rig_with(imu=imu), "HIGHRES_IMU")
    assert (m.xacc, m.yacc, m.zacc) == pytest.approx((0.1, -0.2, -9.81))
    assert (m.xgyro, m.ygyro, m.zgyro) == pytest.approx((0.1, -0.2, -0.3))
    assert (m.xmag, m.ymag, m.zmag) == pytest.approx((0.2, -0.1, 0.4)), "gauss"
    assert m.fields_updated == 0b111111111, "no pressures: there is no air data"


def test_without_a_magnetometer_no_field_is_claimed():
    assert newest(rig_with(imu=LEVEL), "HIGHRES_IMU").fields_updated == 0b111111


def test_an_imu_that_sits_askew_reads_as_if_it_sat_straight():
    sensors = PLANE_FACTS.sensors
    rpy = (0.3, -0.2, 1.5)
    askew = replace_imu(sensors, rpy)
    facts = replace(PLANE_FACTS, file=changed(PLANE_FACTS.file, sensors=askew))
    down = FLU_FROM_FRD @ np.array((0.0, 0.0, -9.81))
    assert body_frd(facts, rotate(inverse(from_euler(*rpy)), down)) == pytest.approx((0.0, 0.0, -9.81))


def replace_imu(sensors, rpy):
    return changed(sensors, imu=changed(sensors.imu, mount=changed(sensors.imu.mount, rpy=rpy)))


def changed(struct, **fields):
    return msgspec.structs.replace(struct, **fields)


def test_pressures_are_hectopascal_and_agree_with_the_altitude():
    static = atmosphere.pressure(380.0)
    air = AirData(static_pressure=static, differential_pressure=380.0, temperature=285.65)
    heard = rig_with(imu=LEVEL, air_data=air).run(1.1)
    m, full = of(heard, "SCALED_PRESSURE", PLANE)[-1], of(heard, "HIGHRES_IMU", PLANE)[-1]
    assert (m.press_abs, m.press_diff, m.temperature) == (pytest.approx(static / 100), pytest.approx(3.8), 1250)
    assert full.pressure_alt == pytest.approx(380.0, abs=0.5) and full.temperature == pytest.approx(12.5, abs=1e-4)
    assert full.fields_updated & (mav.HIGHRES_IMU_UPDATED_ABS_PRESSURE | mav.HIGHRES_IMU_UPDATED_TEMPERATURE)


def test_surfaces_are_pulses_round_the_middle_in_the_order_of_a_plane():
    controls = PLANE_FACTS.file.air.controls
    asked = SurfaceCommand(
        aileron=controls.aileron.limit, elevator=-controls.elevator.limit / 2, throttle=0.75, flap=controls.flap.limit / 2
    )
    m = newest(rig_with(surface_command=asked), "SERVO_OUTPUT_RAW", seconds=0.5)
    assert [getattr(m, f"servo{n}_raw") for n in range(1, 9)] == [2000, 1250, 1750, 1500, 1500, 1000, 0, 0]


def test_an_aircraft_without_flaps_tells_of_none():
    air = PLANE_FACTS.file.air
    controls = changed(air.controls, flap=changed(air.controls.flap, limit=0.0), elevator=Surface(limit=0.1, negative_limit=0.2))
    rig = Rig(plane=replace(PLANE_FACTS, file=changed(PLANE_FACTS.file, air=changed(air, controls=controls))))
    rig.plane.sensed = {"surface_command": SurfaceCommand(elevator=-0.1, flap=0.2)}
    m = newest(rig, "SERVO_OUTPUT_RAW", seconds=0.5)
    assert (m.servo2_raw, m.servo5_raw) == (1250, 1000)


def test_wheels_are_pulses_in_parts_of_the_top_speed():
    rig = Rig()
    fastest = 0.5 / 0.03
    rig.rover.sensed = {"wheel_command": WheelCommand(left=fastest / 2, right=-2 * fastest)}
    m = newest(rig, "SERVO_OUTPUT_RAW", ROVER, seconds=0.5)
    assert [getattr(m, f"servo{n}_raw") for n in range(1, 5)] == [1750, 1000, 0, 0]


def test_behind_the_wheels_of_a_car_comes_its_steering_to_the_right():
    rig = Rig(rover=CAR_FACTS)
    rig.rover.sensed = {"wheel_command": WheelCommand(left=0.0, right=0.0, steering=0.2)}
    m = newest(rig, "SERVO_OUTPUT_RAW", ROVER, seconds=0.5)
    assert [getattr(m, f"servo{n}_raw") for n in range(1, 5)] == [1500, 1500, 1250, 0]


def test_shaking_is_told_and_steady_force_and_slow_motion_are_none():
    def level(force):
        shaking = Vibration()
        for n in range(600):
            t = n / 50
            shaking.hear(Imu(timestamp=stamp(t), specific_force=Vector3(x=force(t), z=9.81)))
        return shaking.level

    assert level(lambda t: 3.0) == pytest.approx(np.zeros(3), abs=0.01)
    assert level(lambda t: 2.0 * math.sin(0.5 * t))[0] < 0.05
    shaken = level(lambda t: 2.0 * math.sin(2 * math.pi * 20.0 * t))
    assert shaken[0] == pytest.approx(2.0 / math.sqrt(2), rel=0.25) and shaken[2] < 0.01


def test_samples_beyond_the_range_are_clipped_and_repeated_or_broken_ones_nothing():
    shaking = Vibration(limit=20.0)
    for n, x in enumerate((0.0, 25.0, 0.0, -20.0, math.nan, 5.0)):
        for _ in range(2):
            shaking.hear(Imu(timestamp=stamp(0.02 * n), specific_force=Vector3(x=x)))
    assert shaking.clipped == 2 and np.isfinite(shaking.level).all()


def test_the_place_steered_at_is_told_with_the_height_held():
    targets = Targets(place=Vector3(x=100.0, y=700.0, z=60.0), altitude=72.0, airspeed=28.0, bank=0.3, pitch=0.1)
    rig = rig_with(targets=targets)
    rig.plane.status.throttle = 0.6
    heard = rig.run(1.1)
    m = of(heard, "POSITION_TARGET_GLOBAL_INT", PLANE)[-1]
    assert (m.coordinate_frame, m.alt) == (mav.MAV_FRAME_GLOBAL_INT, 372.0)
    here = of(heard, "GLOBAL_POSITION_INT", PLANE)[-1]
    assert (m.lat_int - here.lat) * 1e-7 * 111_050.0 == pytest.approx(500.0, abs=1.0) and abs(m.lon_int - here.lon) < 20
    assert m.type_mask & 0x7 == 0 and m.type_mask | 0x207 == 0xFFF, "the place counts, nothing else"
    attitude = of(heard, "ATTITUDE_TARGET", PLANE)[-1]
    now = of(heard, "ATTITUDE", PLANE)[-1]
    assert to_euler(np.array(attitude.q)) == pytest.approx((0.3, 0.1, now.yaw), abs=1e-5)
    assert (attitude.thrust, attitude.type_mask) == (pytest.approx(0.6), 7)
    out = of(heard, "NAV_CONTROLLER_OUTPUT", PLANE)[-1]
    assert (out.wp_dist, out.target_bearing) == (500, 0)
    assert (out.nav_roll, out.nav_pitch, out.aspd_error) == pytest.approx((math.degrees(0.3), math.degrees(0.1), 3.0))


def test_with_nothing_steered_at_nothing_is_told():
    heard = rig_with(targets=Targets()).run(2.0)
    assert not {"POSITION_TARGET_GLOBAL_INT", "ATTITUDE_TARGET", "NAV_CONTROLLER_OUTPUT"} & {m.get_type() for m in heard}


@pytest.mark.parametrize(("state", "told"), [(NavStatus.DRIVING, True), (NavStatus.REACHED, False)])
def test_a_rover_tells_the_goal_that_it_drives_to(state, told):
    rig = Rig()
    rig.rover.sensed = {"planning": NavStatus(state=state, goal=Vector3(x=4.0, y=6.0))}
    found = of(rig.run(1.1), "POSITION_TARGET_GLOBAL_INT", ROVER)
    assert bool(found) is told
    if told:
        assert found[-1].alt == pytest.approx(300.0, abs=0.01)


def test_the_quality_of_the_estimate_is_told_as_ratios_of_the_gate():
    quality = EstimateQuality(
        position_known=True, height_known=True, height_sigma=0.4, velocity_ratio=0.25, position_ratio=0.04, field_ratio=2.25
    )
    rig = rig_with(quality=quality)
    rig.plane.nav.position_sigma = 0.7
    m = newest(rig, "ESTIMATOR_STATUS", seconds=1.1)
    assert (m.vel_ratio, m.pos_horiz_ratio, m.mag_ratio) == pytest.approx((0.5, 0.2, 1.5)) and math.isnan(m.hagl_ratio)
    assert (m.pos_horiz_accuracy, m.pos_vert_accuracy) == pytest.approx((0.7, 0.4))
    wanted = mav.ESTIMATOR_ATTITUDE | mav.ESTIMATOR_POS_HORIZ_ABS | mav.ESTIMATOR_POS_VERT_ABS | mav.ESTIMATOR_VELOCITY_HORIZ
    assert m.flags & wanted == wanted and not m.flags & mav.ESTIMATOR_GPS_GLITCH


def test_reckoning_without_fixes_is_no_absolute_position():
    m = newest(rig_with(quality=EstimateQuality(height_known=True, position_ratio=3.0)), "ESTIMATOR_STATUS", seconds=1.1)
    assert not m.flags & (mav.ESTIMATOR_POS_HORIZ_ABS | mav.ESTIMATOR_PRED_POS_HORIZ_ABS)
    assert m.flags & mav.ESTIMATOR_GPS_GLITCH and m.flags & mav.ESTIMATOR_POS_VERT_ABS


def test_wind_comes_with_its_uncertainty_and_no_vertical_part_is_made_up():
    rig = rig_with(quality=EstimateQuality(wind_sigma=0.5))
    rig.plane.nav.wind.CopyFrom(Vector3(x=1.5, y=1.3))
    m = newest(rig, "WIND_COV", seconds=1.1)
    assert (m.wind_x, m.wind_y, m.var_horiz, m.horiz_accuracy, m.wind_alt) == pytest.approx((1.3, 1.5, 0.25, 0.5, 380.0))
    assert math.isnan(m.wind_z) and math.isnan(m.var_vert)


@pytest.mark.parametrize("what", ["imu", "air_data", "surface_command", "targets", "quality"])
def test_what_is_no_longer_told_is_no_longer_sent(what):
    messages = {"imu": LEVEL, "air_data": AirData(static_pressure=1e5), "surface_command": SurfaceCommand(), "quality": EstimateQuality()}
    messages["targets"] = Targets(place=Vector3(x=1.0), bank=0.0, pitch=0.0)
    carried = {
        "imu": {"HIGHRES_IMU", "VIBRATION"},
        "air_data": {"SCALED_PRESSURE"},
        "surface_command": {"SERVO_OUTPUT_RAW"},
        "targets": {"ATTITUDE_TARGET", "POSITION_TARGET_GLOBAL_INT"},
        "quality": set(),
    }[what]
    rig = rig_with(**messages)
    assert carried <= {m.get_type() for m in rig.run(2.0)}
    del rig.plane.sensed[what]
    rig.run(2.2)
    heard = rig.run(2.0)
    assert not carried & {m.get_type() for m in heard}
    assert math.isnan(of(heard, "ESTIMATOR_STATUS", PLANE)[-1].vel_ratio) is (what == "quality")


def test_a_receiver_that_falls_silent_has_no_fix():
    rig = Rig()
    assert newest(rig, "GPS_RAW_INT", seconds=1.0).fix_type == mav.GPS_FIX_TYPE_3D_FIX
    rig.hears_satellites = False
    rig.run(2.1)
    heard = rig.run(1.1)
    assert of(heard, "GPS_RAW_INT", PLANE)[-1].fix_type == mav.GPS_FIX_TYPE_NO_FIX
    assert not of(heard, "SYS_STATUS", PLANE)[-1].onboard_control_sensors_health & mav.MAV_SYS_STATUS_SENSOR_GPS


def test_numbers_that_are_none_break_nothing():
    nan = math.nan
    bad = Vector3(x=nan, y=math.inf, z=-math.inf)
    rig = rig_with(
        imu=Imu(specific_force=bad, angular_velocity=bad, magnetic_field=bad),
        air_data=AirData(static_pressure=nan, differential_pressure=math.inf, temperature=nan),
        surface_command=SurfaceCommand(aileron=nan, throttle=math.inf),
        targets=Targets(place=bad, altitude=nan, bank=nan, pitch=nan),
        quality=EstimateQuality(velocity_ratio=nan, field_ratio=-1.0),
    )
    assert len(of(rig.run(3.0), "HEARTBEAT", PLANE)) == 3


@pytest.mark.parametrize(
    "number", [29, 36, 62, 83, 87, 105, 230, 231, 241, *(1, 2, 24, 30, 31, 32, 33, 42, 74, 141, 242, 245, 436, 49, 148, 300)]
)
def test_every_message_can_be_asked_for_and_comes_after_its_acknowledgement(number):
    rig = rig_with(
        imu=LEVEL,
        air_data=AirData(static_pressure=1e5),
        surface_command=SurfaceCommand(),
        quality=EstimateQuality(),
        targets=Targets(place=Vector3(x=1.0), bank=0.0, pitch=0.0),
    )
    rig.run(0.5)
    rig.say(long(mav.MAV_CMD_SET_MESSAGE_INTERVAL, float(number), -1.0))
    rig.run()
    rig.say(long(512, float(number)))
    heard = [m for m in rig.run() if m.get_srcSystem() == PLANE and m.get_msgId() in (77, number)]
    assert acks(heard)[0] == (512, 0) and heard[0].get_msgId() == 77
    assert [m.get_msgId() for m in heard[1:]] == [number]
