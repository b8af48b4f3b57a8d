"""A slope is told from the accelerometer's biases, and a vehicle that turns on one does not seem to slip."""

import numpy as np
import pytest

from benchmarks.estimation.odometry.drive import DT, TRACK
from uvf.estimation.odometry.filter import DriveFilter
from uvf.estimation.odometry.inclination import Inclination
from uvf.estimation.odometry.states import Noise, Step
from uvf.maths.geodesy import GRAVITY
from uvf.maths.kinematics import WheelTravel
from uvf.maths.rotations import from_euler, matrix

BIAS = np.array((0.08, -0.06, 0.02))  # m/s^2


def on_a_slope(steepest, speed, turning, seconds=30.0):
    """Steps of a vehicle that stands for a second, drives onto a slope [rad] at 3 s, and in a circle there from 5 s on."""
    rng, heading, last = np.random.default_rng(1), 0.0, 0.0
    for k in range(round(seconds / DT)):
        t = k * DT
        slope, rising = steepest * min(max(t - 3.0, 0.0), 1.0), steepest * (3.0 <= t < 4.0)
        driven, turned = speed * min(max(t - 1.0, 0.0), 1.0), turning * min(max(t - 5.0, 0.0), 1.0)
        heading += turned * DT
        gravity = GRAVITY * np.array((np.sin(slope) * np.cos(heading), -np.sin(slope) * np.sin(heading), np.cos(slope)))
        force = gravity + ((driven - last) / DT, driven * turned, 0.0) + BIAS + 0.05 * rng.standard_normal(3)
        rate = np.array((0.002, -rising - 0.003, turned)) + 0.002 * rng.standard_normal(3)
        side = turned * TRACK / 2
        ways = WheelTravel(((driven + last) / 2 - side) * DT, ((driven + last) / 2 + side) * DT)
        last = driven
        yield rate, force, ways, gravity


@pytest.mark.parametrize("degrees", [0.0, 4.0, -8.0, 12.0])
def test_turning_on_a_slope_is_no_slip(degrees):
    for speed, turning in ((0.3, 1.0), (0.4, -2.5)):
        inclination, one = Inclination(), DriveFilter("ekf", Noise(), TRACK)
        for rate, force, ways, _ in on_a_slope(np.radians(degrees), speed, turning):
            one.step(Step(DT, ways, rate[2], force[0], *inclination.step(DT, rate, force, ways)))
            assert one.doubt is None
        assert one.velocity.linear == pytest.approx(speed, abs=0.01)


@pytest.mark.parametrize("degrees", [0.0, 6.0])
def test_gravity_and_biases_are_told_apart_by_turning(degrees):
    inclination = Inclination()
    steps = list(on_a_slope(np.radians(degrees), 0.3, 0.8))
    for rate, force, ways, _ in steps:
        inclination.step(DT, rate, force, ways)
    assert inclination.state[2:] == pytest.approx(BIAS[:2], abs=0.02)
    assert inclination.state[:2] == pytest.approx(steps[-1][3][:2], abs=0.06)


def test_the_change_is_uncertain_until_the_vehicle_has_turned():
    inclination = Inclination()
    noises = [inclination.step(DT, rate, force, ways).noise for rate, force, ways, _ in on_a_slope(0.0, 0.3, 1.0)]
    assert noises[150] == pytest.approx(0.0, abs=0.02)
    assert noises[310] > 1.5 * noises[-1] > 0.0


def test_a_blow_is_no_slope():
    inclination, blow = Inclination(), np.array((30.0, -30.0, 0.0))
    for k, (rate, force, ways, _) in enumerate(on_a_slope(0.0, 0.3, 1.0)):
        inclination.step(DT, rate, force + blow if 700 <= k < 705 else force, ways)
    assert inclination.state[:2] == pytest.approx((0.0, 0.0), abs=0.06)


@pytest.mark.parametrize("bias", [0.01, -0.05, 0.2])
def test_a_gyroscope_that_is_biased_does_not_tilt_a_vehicle_that_stands(bias):
    inclination = Inclination()
    for _ in range(1500):
        tilting = inclination.step(DT, np.array((0.01, bias, 0.0)), np.array((0.0, 0.0, GRAVITY)), WheelTravel(0.0, 0.0))
    assert tilting.rate == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("silent", [1.5, 3.0])
@pytest.mark.parametrize("degrees", [8.0, 15.0])
def test_a_slope_is_found_again_after_the_inertial_unit_was_silent(degrees, silent):
    """Turning all the while; the filter is never told of those steps."""
    inclination, doubted, one = Inclination(), 0, DriveFilter("ekf", Noise(), TRACK)
    steps = list(on_a_slope(np.radians(degrees), 0.3, 1.0, 40.0))
    for k, (rate, force, ways, _) in enumerate(steps):
        if 1000 <= k < 1000 + silent / DT:
            one.step(Step(DT, ways))
        else:
            one.step(Step(DT, ways, rate[2], force[0], *inclination.step(DT, rate, force, ways)))
        doubted += one.doubt is not None
    assert inclination.state[:2] == pytest.approx(steps[-1][3][:2], abs=0.15)
    assert doubted * DT < 2.5
    assert one.velocity.linear == pytest.approx(0.3, abs=0.02)


@pytest.mark.parametrize(("roll", "pitch"), [(0.0, 0.0), (0.0, -0.25), (0.2, 0.0), (-0.15, 0.2)])
def test_ways_and_turns_are_told_as_from_above(roll, pitch):
    """Against the Euler angles' own rates."""
    inclination = Inclination()
    upward = matrix(from_euler(roll, pitch, 0.0))[2]
    inclination.state[:2] = GRAVITY * upward[:2]
    rate = np.array((0.1, -0.2, 0.5))
    ways, turning = inclination.seen_from_above(WheelTravel(1.0, 2.0, 3.0), rate)
    assert ways == pytest.approx((np.cos(pitch), 2.0 * np.cos(pitch), 3.0 * np.sqrt(1.0 - upward[1] ** 2)))
    assert turning == pytest.approx((rate[1] * np.sin(roll) + rate[2] * np.cos(roll)) / np.cos(pitch))


def test_a_vehicle_that_rocks_as_it_stops_has_no_biased_gyroscope():
    """It nods by 0.4 degrees onto its castors and lies still then, in stops of half a second; before, it stood for a second."""
    inclination, force, standing = Inclination(), np.array((0.0, 0.0, GRAVITY)), WheelTravel(0.0, 0.0)
    for _ in range(round(1.0 / DT)):
        inclination.step(DT, np.array((0.002, -0.001, 0.0)), force, standing)
    for _ in range(5):
        for k in range(round(3.0 / DT)):
            stops, rocks = round(2.4 / DT), 0.035 if 0 <= k - round(2.4 / DT) < round(0.2 / DT) else 0.0
            ways = standing if k >= stops else WheelTravel(0.3 * DT, 0.3 * DT)
            inclination.step(DT, np.array((0.002, rocks - 0.001, 0.0)), force, ways)
    assert inclination._gyro_bias == pytest.approx((0.002, -0.001), abs=3e-4)
