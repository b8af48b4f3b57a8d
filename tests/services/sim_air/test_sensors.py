"""Each sensor's errors are those of the vehicle file, in rate, size and delay."""

import math
from dataclasses import replace

import numpy as np
import pytest

from services.sim_air.engine.states import Air, AircraftMotion
from services.sim_air.sensors import Gnss, Imu, PressureSensors
from uvf.maths import rotations
from uvf.maths.geodesy import LocalTangent
from uvf.models.vehicle.sensors import AirDataSensor, GnssSensor, ImuSensor, Mount

FIELD = np.array((2e-6, 25e-6, -39e-6))
TANGENT = LocalTangent.from_degrees(40.77, 14.79, 300.0)


def moving(x=0.0, attitude=rotations.IDENTITY):
    return AircraftMotion(
        np.array((x, 0.0, 50.0)), np.array((25.0, 0.0, 0.0)), attitude, np.array((0.1, 0.2, 0.3)), np.array((0.0, 0.0, 9.81)), 25.0
    )


def rng():
    return np.random.default_rng(5)


def test_a_sensor_without_errors_reads_the_truth_in_its_own_frame():
    quarter_left = Mount(rpy=(0.0, 0.0, math.pi / 2))
    sample = Imu(ImuSensor(quarter_left, 100.0), FIELD, rng()).read(0.01, moving())
    assert sample.angular_velocity == pytest.approx((0.2, -0.1, 0.3))
    assert sample.specific_force == pytest.approx((0.0, 0.0, 9.81))


def test_away_from_the_centre_of_gravity_an_imu_feels_the_turning():
    """On a disc at w about z, r ahead: w^2 r inwards, and r dw/dt to the left."""
    turning = replace(moving(), angular_velocity=np.array((0.0, 0.0, 2.0)), angular_acceleration=np.array((0.0, 0.0, 3.0)))
    sample = Imu(ImuSensor(Mount(xyz=(0.5, 0.0, 0.0)), 100.0), FIELD, rng()).read(0.01, turning)
    assert sample.specific_force == pytest.approx((-2.0, 1.5, 9.81))
    assert sample.angular_velocity == pytest.approx((0.0, 0.0, 2.0))


def test_imu_errors_are_a_constant_bias_and_white_noise():
    imu = Imu(ImuSensor(Mount(), 100.0, gyro_noise=0.01, gyro_bias=0.1), FIELD, rng())
    errors = np.array([imu.read(k / 100, moving()).angular_velocity - (0.1, 0.2, 0.3) for k in range(1, 2001)])
    assert errors.std(axis=0) == pytest.approx(0.01, rel=0.1)
    assert np.abs(errors.mean(axis=0)).max() > 0.01
    assert errors[:1000].mean(axis=0) == pytest.approx(errors[1000:].mean(axis=0), abs=0.002)


def test_magnetic_north_is_seen_on_the_left_when_flying_east():
    field = Imu(ImuSensor(Mount(), 100.0), FIELD, rng()).read(0.01, moving()).magnetic_field
    assert field == pytest.approx(FIELD)
    turned_north = moving(attitude=rotations.from_euler(0.0, 0.0, math.pi / 2))
    field = Imu(ImuSensor(Mount(), 100.0), FIELD, rng()).read(0.01, turned_north).magnetic_field
    assert field == pytest.approx((25e-6, -2e-6, -39e-6))


def test_a_fix_arrives_late_and_is_stamped_with_the_moment_it_is_valid_for():
    gnss = Gnss(GnssSensor(5.0, latency=0.1), TANGENT, rng())
    fixes = [(k / 100, fix) for k in range(1, 101) if (fix := gnss.read(k / 100, moving(x=25 * k / 100)))]
    assert [t for t, _ in fixes] == pytest.approx([0.3, 0.5, 0.7, 0.9])
    t, first = fixes[0]
    east = TANGENT.enu(first.latitude, first.longitude, first.altitude)[0]
    assert first.t == pytest.approx(t - 0.1)
    assert east == pytest.approx(25 * first.t, abs=1e-6)


def test_fixes_scatter_as_told():
    gnss = Gnss(GnssSensor(100.0, horizontal_noise=0.8, vertical_noise=1.5, speed_noise=0.1), TANGENT, rng())
    fixes = [gnss.read(k / 100, moving()) for k in range(1, 2001)]
    enu = np.array([TANGENT.enu(f.latitude, f.longitude, f.altitude) for f in fixes])
    assert enu.std(axis=0) == pytest.approx((0.8, 0.8, 1.5), rel=0.1)
    assert np.array([f.velocity for f in fixes]).std(axis=0) == pytest.approx(0.1, rel=0.1)


def test_pressures_scatter_about_a_constant_bias():
    pressures = PressureSensors(AirDataSensor(50.0, static_noise=3.0, differential_noise=4.0, static_bias=20.0), rng())
    read = [pressures.read(k / 50, lambda: Air(97_000.0, 370.0, 285.0)).air for k in range(1, 2001)]
    static = np.array([r.static_pressure for r in read])
    assert static.std() == pytest.approx(3.0, rel=0.1)
    assert abs(static.mean() - 97_000) > 1.0
    assert np.mean([r.differential_pressure for r in read]) == pytest.approx(370.0, abs=0.5)


def test_late_readings_keep_the_moment_they_are_valid_for():
    imu = Imu(ImuSensor(Mount(), 100.0, latency=0.02), FIELD, rng())
    pressures = PressureSensors(AirDataSensor(50.0, latency=0.03), rng())
    steps = [k / 100 for k in range(1, 21)]
    felt = [(t, reading.t) for t in steps if (reading := imu.read(t, moving()))]
    heard = [(t, sample.t) for t in steps if (sample := pressures.read(t, lambda: Air(97_000.0, 370.0, 285.0)))]
    assert [t - taken for t, taken in felt] == pytest.approx([0.02] * 18)
    assert [t - taken for t, taken in heard] == pytest.approx([0.03] * 8)


def test_the_books_receiver_wanders_slowly_about_the_truth():
    gnss = Gnss(GnssSensor(1.0, horizontal_drift=4.927, vertical_drift=9.385), TANGENT, rng())
    fixes = [gnss.read(float(k), moving()) for k in range(1, 20_001)]
    enu = np.array([TANGENT.enu(f.latitude, f.longitude, f.altitude) for f in fixes]) - (0.0, 0.0, 50.0)
    assert np.diff(enu, axis=0).std(axis=0) == pytest.approx((0.21, 0.21, 0.40), rel=0.02)  # the increments of its table 7.1
    assert enu.std(axis=0) == pytest.approx((4.927, 4.927, 9.385), rel=0.5)  # 18 independent values
