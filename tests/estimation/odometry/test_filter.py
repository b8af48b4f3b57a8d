"""Both filters on simulated drives: arcs, bias, standstill, slip, loss of sensors, and errors as large as the covariance says."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from benchmarks.estimation.odometry.drive import DT, TRACK, World, drive
from uvf.estimation.odometry.filter import DriveFilter
from uvf.estimation.odometry.states import LEFT, RIGHT, Noise, Step
from uvf.maths.kinematics import Twist, WheelTravel, move
from uvf.maths.rotations import wrap
from uvf.maths.se2 import IDENTITY

KINDS = ("ekf", "ukf")
CLEAN = World(distance=0.0, radius=0.0, gyro=0.0, gyro_turn=0.0, bias=0.0, bias_walk=0.0, accel=0.0, accel_offset=0.0, tick=1e-9)


def begun(kind="ekf", noise=None):
    return DriveFilter(kind, noise or Noise(), TRACK)


def wheels(linear, angular, rate=None, force=None):
    side = angular * TRACK / 2
    return Step(DT, WheelTravel((linear - side) * DT, (linear + side) * DT), rate, force)


def driven(one, moments):
    for moment in moments:
        one.step(moment.step)
    return one


def off(one, pose):
    """(3,) error of the pose [m, m, rad]."""
    return np.array((one.pose.x - pose.x, one.pose.y - pose.y, wrap(one.pose.yaw - pose.yaw)))


def stand(one, rate=0.0):
    for _ in range(100):
        one.step(wheels(0.0, 0.0, rate=rate, force=0.0))


@pytest.mark.parametrize("kind", KINDS)
def test_a_circle_ends_where_the_arc_says(kind):
    one = begun(kind)
    for _ in range(200):
        one.step(wheels(0.4, 0.7, rate=0.7))
    assert one.pose == pytest.approx(move(IDENTITY, Twist(0.4, 0.7), 200 * DT), abs=0.01)


@pytest.mark.parametrize("kind", KINDS)
def test_without_errors_the_pose_is_the_true_one(kind):
    moments = drive(replace(CLEAN, seconds=15.0), 3)
    assert np.abs(off(driven(begun(kind), moments), moments[-1].pose)).max() < 0.01


def test_both_filters_agree():
    moments = drive(World(seconds=15.0), 5)
    one, other = (driven(begun(kind), moments) for kind in KINDS)
    assert np.abs(off(one, other.pose)).max() < 0.01
    assert one.covariance[:3, :3] == pytest.approx(other.covariance[:3, :3], rel=0.1, abs=1e-4)


def consistency(kind, world, seeds, noise=None):
    """(seeds, 2): normalised squared errors of position and heading at the end of each drive."""
    found = []
    for seed in seeds:
        moments = drive(world, seed)
        one = driven(begun(kind, noise), moments)
        e, p = off(one, moments[-1].pose), one.covariance[:3, :3]
        found.append((e[:2] @ np.linalg.solve(p[:2, :2], e[:2]), e[2] ** 2 / p[2, 2]))
    return np.array(found)


@pytest.mark.parametrize(("kind", "seeds"), [("ekf", 25), ("ukf", 20)])
def test_the_errors_are_as_large_as_the_covariance_says(kind, seeds):
    """Sums of normalised squared errors are chi-square distributed; bounds of 99.9 %, where the noise is as the filter is told."""
    noise = Noise(rest=1e-5, skid=1e-3)
    position, heading = consistency(kind, World(seconds=10.0, radius=noise.scale_start, bias=0.02), range(seeds), noise).sum(axis=0)
    low, high = chi2.ppf((0.0005, 0.9995), 2 * seeds)
    assert low < position < high
    low, high = chi2.ppf((0.0005, 0.9995), seeds)
    assert low < heading < high


def test_a_covariance_that_is_too_small_would_be_noticed():
    """The test of the errors has teeth: the same drives with a filter that believes its wheels and gyroscope too much."""
    noise = Noise(distance=0.001, gyro=5e-5, turn=5e-4, scale_start=0.001, rest=1e-5, skid=1e-3)
    position, _ = consistency("ekf", World(seconds=16.0, radius=0.01), range(10), noise).sum(axis=0)
    assert position > chi2.ppf(0.9995, 20)


def test_the_bias_is_found_while_standing():
    one = begun()
    for _ in range(100):
        one.step(wheels(0.0, 0.0, rate=0.03, force=0.1))
    assert one.bias == pytest.approx(0.03, abs=1e-3)
    heading = one.pose.yaw
    for _ in range(500):
        one.step(wheels(0.0, 0.0, rate=0.03, force=0.1))
    assert one.pose.yaw == pytest.approx(heading, abs=1e-3)


def test_no_measurement_makes_the_pose_jump():
    one, before, longest = begun(), IDENTITY, 0.0
    for moment in drive(World(seconds=60.0, bias=0.05, slips=((20.0, 23.0, 0.4, 0.4),)), 7):
        one.step(moment.step)
        longest = max(longest, float(np.hypot(one.pose.x - before.x, one.pose.y - before.y)))
        before = one.pose
    assert longest < 1.2 * 0.5 * DT


def test_what_is_held_back_stays_uncertain():
    """Finding the bias late does not mend the heading that it has spoilt: the covariance must not pretend so."""
    one = begun(noise=Noise(distance=0.2))
    for _ in range(250):
        one.step(wheels(0.3, 0.0, rate=0.03, force=0.0))
    spoilt = one.covariance[2, 2]
    for _ in range(500):
        one.step(wheels(0.0, 0.0, rate=0.03, force=0.0))
    assert one.covariance[2, 2] >= 0.9 * spoilt
    assert one.pose.yaw > 0.1


@pytest.mark.parametrize("kind", KINDS)
def test_both_wheels_spinning_move_it_little_and_are_told(kind):
    """Against a wall, say: half a metre a second for three seconds, which would be 1.5 m."""
    world = World(seconds=12.0, slips=((6.0, 9.0, 0.5, 0.5),))
    for seed in (1, 2, 3):
        one, doubted, moments = begun(kind), 0, drive(world, seed)
        for moment in moments:
            one.step(moment.step)
            doubted += one.doubt is not None and 6.0 < moment.t <= 9.0
        assert np.hypot(*off(one, moments[-1].pose)[:2]) < 0.2
        assert doubted > 120


def test_one_wheel_on_ice_leaves_the_other_one_to_count():
    moments = drive(World(seconds=20.0, slips=((8.0, 14.0, 0.0, 0.6),)), 4)
    one = driven(begun(), moments)
    assert np.hypot(*off(one, moments[-1].pose)[:2]) < 0.1


def test_gripping_wheels_are_not_accused():
    doubted, steps = 0, 0
    for seed in range(3):
        one = begun()
        for moment in drive(World(seconds=30.0), seed):
            one.step(moment.step)
            doubted += one.doubt is not None
            steps += 1
    assert doubted < 0.002 * steps


def test_being_turned_with_wheels_standing_is_no_bias():
    one = begun()
    stand(one, rate=0.001)
    for _ in range(50):
        one.step(wheels(0.0, 0.0, rate=0.8, force=0.0))
    assert one.pose.yaw == pytest.approx(0.8, abs=0.05)
    assert "wheels stand" in one.doubt


def test_a_slope_is_no_slip():
    """Up a ramp of 10 degrees the accelerometer feels 1.7 m/s^2; the gyroscope has felt the pitching."""
    one, pitch, before = begun(), 0.0, 0.0
    for k in range(400):
        pitching = -0.35 if 150 <= k < 175 else 0.0
        pitch -= pitching * DT
        speed = min(max(k - 20, 0) * 0.01, 0.3)
        force = (speed - before) / DT + 9.80665 * np.sin(pitch)
        one.step(wheels((speed + before) / 2, 0.0, rate=0.0, force=force)._replace(tilting=-9.80665 * np.cos(pitch) * pitching))
        before = speed
        assert one.doubt is None
    assert one.pose.x == pytest.approx(0.3 * (379 - 14.5) * DT, rel=0.02)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("speed", [0.3, -0.3, 0.0])
@pytest.mark.parametrize("offset", [0.4, -0.4, 2.0])
def test_an_accelerometer_that_is_knocked_askew_does_not_run_away_with_it(kind, speed, offset):
    """The wheels go on as before, or are held fast, quivering; the pose is off by little, and they are believed again."""
    one = begun(kind)
    for k in range(1500):
        driven_at, quiver = min(0.01 * k, 1.0) * speed, 1e-4 * (-1) ** k if k > 100 else 0.0
        force = (speed / 100 / DT if k < 100 else 0.0) + (offset if k >= 500 else 0.0)
        travel = WheelTravel(driven_at * DT + quiver, driven_at * DT - quiver)
        one.step(wheels(driven_at, 0.0, rate=0.0, force=force)._replace(travel=travel))
    assert one.doubt is None
    assert one.velocity.linear == pytest.approx(speed, abs=0.02)
    assert one.pose.x == pytest.approx(speed * (1500 - 50) * DT, abs=0.5 * abs(offset) + 0.5)


def test_without_inertial_unit_the_wheels_turn_it():
    one = begun()
    for _ in range(100):
        one.step(wheels(0.0, 0.5))
    assert one.pose.yaw == pytest.approx(1.0, abs=1e-6)


def test_an_inertial_unit_that_comes_and_goes_leaves_no_gap():
    one = begun()
    for k in range(600):
        one.step(wheels(0.4, 0.2, rate=0.2, force=0.0) if k // 100 % 2 else wheels(0.4, 0.2))
    assert one.pose == pytest.approx(move(IDENTITY, Twist(0.4, 0.2), 600 * DT), abs=0.05)


def test_the_uncertainty_grows_with_the_way_and_with_turns():
    straight, turning = begun(), begun()
    for one in (straight, turning):
        stand(one)
    for k in range(1000):
        straight.step(wheels(0.4, 0.0, rate=0.0, force=0.0))
        turning.step(wheels(0.4, 1.0, rate=1.0, force=0.0))
        if k == 100:
            early = straight.covariance[:2, :2].trace()
    assert straight.covariance[:2, :2].trace() > 10 * early
    assert turning.covariance[2, 2] > straight.covariance[2, 2]
    assert np.linalg.eigvalsh(straight.covariance).min() > -1e-12


def test_the_ratio_of_the_wheels_is_learnt_from_the_gyroscope():
    one = driven(begun(), drive(World(seconds=120.0, left=1.01, right=0.99, radius=0.0), 2))
    left, right = one.state[[LEFT, RIGHT]]
    assert left - right == pytest.approx(0.02, abs=0.008)
