"""The odometry filter: arcs are exact, the gyroscope turns, the bias is found at rest, nothing jumps."""

import numpy as np
import pytest

from services.slam.odometry_filter import Noise, OdometryFilter
from uvf.maths.kinematics import Twist, move

NOISE = Noise(distance=0.02, gyro=0.005, bias_walk=1e-4, bias_start=0.05, slip=1.0, rest=0.01)
DT = 0.02


def drive(odometry, steps, linear, angular, bias=0.0, wheel_factor=1.0):
    for _ in range(steps):
        odometry.step(linear * DT, wheel_factor * angular * DT, angular + bias, DT)


def test_a_circle_ends_where_the_arc_says():
    odometry = OdometryFilter(NOISE)
    drive(odometry, 200, 0.4, 0.7)
    assert odometry.pose == pytest.approx(move((0.0, 0.0, 0.0), Twist(0.4, 0.7), 200 * DT), abs=1e-3)


def test_the_bias_is_found_while_standing():
    odometry = OdometryFilter(NOISE)
    drive(odometry, 100, 0.0, 0.0, bias=0.03)
    assert odometry.bias == pytest.approx(0.03, abs=0.002)
    heading = odometry.pose[2]
    drive(odometry, 500, 0.0, 0.0, bias=0.03)
    assert odometry.pose[2] == pytest.approx(heading, abs=0.01)


def test_slipping_wheels_do_not_turn_the_vehicle():
    odometry = OdometryFilter(NOISE)
    drive(odometry, 50, 0.0, 0.0)
    drive(odometry, 100, 0.0, 0.5, wheel_factor=1.3)
    assert odometry.pose[2] == pytest.approx(0.5 * 100 * DT, abs=0.02)


def test_without_gyroscope_the_wheels_turn_it():
    odometry = OdometryFilter(NOISE)
    for _ in range(100):
        odometry.step(0.0, 0.5 * DT, None, DT)
    assert odometry.pose[2] == pytest.approx(1.0, abs=1e-6)


def test_a_sudden_stop_after_a_long_drive_does_not_move_the_pose():
    odometry = OdometryFilter(NOISE)
    drive(odometry, 3000, 0.4, 0.1)
    before = odometry.pose
    drive(odometry, 50, 0.0, 0.0, bias=0.02)
    assert np.hypot(odometry.pose[0] - before[0], odometry.pose[1] - before[1]) < 1e-6
    assert abs(odometry.pose[2] - before[2]) < 0.03


def test_the_uncertainty_grows_with_the_way():
    odometry = OdometryFilter(NOISE)
    drive(odometry, 100, 0.4, 0.0)
    early = odometry.covariance[1, 1]
    drive(odometry, 900, 0.4, 0.0)
    assert odometry.covariance[1, 1] > 3 * early
    assert np.linalg.eigvalsh(odometry.covariance).min() > -1e-12
