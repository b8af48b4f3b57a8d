"""The inertial unit in motions whose specific force is known in closed form."""

import numpy as np
import pytest

from services.sim_ground.body import BodyState
from services.sim_ground.encoders import ticks
from services.sim_ground.imu import ImuModel
from uvf.maths.geodesy import GRAVITY
from uvf.maths.kinematics import WheelSpeeds
from uvf.maths.rotations import from_euler
from uvf.models.vehicle.sensors import Encoders, ImuSensor, Mount

NORTH_FIELD = np.array((0.0, 25e-6, -39e-6))
DT = 0.01


def body(velocity=(0.0, 0.0, 0.0), attitude=(0.0, 0.0, 0.0), rates=(0.0, 0.0, 0.0)):
    return BodyState(np.zeros(3), from_euler(*attitude), np.array(velocity), np.array(rates), (0.0, 0.0), WheelSpeeds(0.0, 0.0))


def unit(mount=None, **noise):
    return ImuModel(ImuSensor(mount=mount or Mount(), hz=100.0, **noise), NORTH_FIELD, np.random.default_rng(0))


def read_twice(imu, before, after):
    imu.read(DT, before)
    return imu.read(2 * DT, after)


def test_braking_is_felt_backwards():
    reading = read_twice(unit(), body((0.5, 0, 0)), body((0.48, 0, 0)))
    assert reading.specific_force == pytest.approx((-2.0, 0.0, GRAVITY))


def test_facing_north_the_field_lies_ahead_and_down():
    reading = unit().read(DT, body(attitude=(0, 0, np.pi / 2)))
    assert reading.magnetic_field == pytest.approx((25e-6, 0.0, -39e-6))


def test_on_a_slope_gravity_leans_the_other_way():
    reading = unit().read(DT, body(attitude=(0.0, -0.2, 0.0)))  # nose up
    assert reading.specific_force == pytest.approx((GRAVITY * np.sin(0.2), 0.0, GRAVITY * np.cos(0.2)))


def test_on_a_turntable_an_unit_off_the_axle_feels_the_centripetal_force():
    omega, arm = 2.0, 0.1
    imu = unit(Mount(xyz=(arm, 0.0, 0.0)))
    middle = read_twice(
        imu, body(rates=(0, 0, omega), attitude=(0, 0, -omega * DT / 2)), body(rates=(0, 0, omega), attitude=(0, 0, omega * DT / 2))
    )
    assert middle.specific_force[0] == pytest.approx(-(omega**2) * arm, rel=0.01)


def test_an_unit_mounted_sideways_measures_in_its_own_axes():
    imu = unit(Mount(rpy=(0.0, 0.0, np.pi / 2)))
    reading = read_twice(imu, body(rates=(0.3, 0, 0)), body((0.02, 0, 0), rates=(0.3, 0, 0)))
    assert reading.specific_force == pytest.approx((0.0, -2.0, GRAVITY))
    assert reading.angular_velocity == pytest.approx((0.0, -0.3, 0.0))


def test_the_bias_stays_and_the_noise_averages_out():
    imu = unit(gyro_bias=0.01, gyro_noise=0.002)
    rates = np.array([imu.read(n * DT, body()).angular_velocity for n in range(1, 2001)])
    halves = rates[:1000].mean(axis=0), rates[1000:].mean(axis=0)
    assert halves[0] == pytest.approx(halves[1], abs=4e-4)
    assert np.abs(halves[0]).max() > 1e-3


def test_the_encoder_counts_whole_ticks_both_ways():
    sensor = Encoders(hz=50.0, ticks_per_turn=4096)
    assert ticks(sensor, (2 * np.pi * 2 + 1e-6, -1e-6), (0, 1)) == [8192, -1]
