"""Differential drive: both directions of the kinematics, and the arc against the thesis' rotation about the ICC."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uvf.maths.kinematics import DifferentialDrive, Twist, WheelSpeeds, move, spin_velocity, twist_between
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2

BURGER = DifferentialDrive(wheel_radius=0.033, track=0.16)
speeds = st.floats(-20, 20)
poses = st.builds(Pose2, st.floats(-10, 10), st.floats(-10, 10), st.floats(-3, 3))
twists = st.builds(Twist, st.floats(-1, 1), st.floats(-3, 3), st.just(0.0))
sideways_twists = st.builds(Twist, st.floats(-1, 1), st.floats(-3, 3), st.floats(-1, 1))


def about_the_icc(pose, left, right, track, dt):
    """R = (l/2)(V_l + V_r)/(V_r - V_l); the pose rotated about ICC = [x - R sin, y + R cos] by omega dt."""
    radius = track / 2 * (left + right) / (right - left)
    turn = (right - left) / track * dt
    icc = np.array((pose.x - radius * np.sin(pose.yaw), pose.y + radius * np.cos(pose.yaw)))
    rotation = np.array(((np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))))
    return (*(rotation @ (np.array(pose[:2]) - icc) + icc), wrap(pose.yaw + turn))


def same(a, b):
    return a[:2] == pytest.approx(b[:2], abs=1e-9) and abs(wrap(a[2] - b[2])) < 1e-9


@given(speeds, speeds)
def test_inverse_kinematics_undo_forward_kinematics(left, right):
    assert BURGER.wheels(BURGER.twist(WheelSpeeds(left, right))) == pytest.approx((left, right), abs=1e-9)


def test_equal_wheels_drive_straight_and_opposite_wheels_turn_on_the_spot():
    assert BURGER.twist(WheelSpeeds(10, 10)) == pytest.approx((0.33, 0.0, 0.0))
    assert BURGER.twist(WheelSpeeds(-10, 10)) == pytest.approx((0.0, 0.033 * 20 / 0.16, 0.0))


@given(poses, st.floats(-1, 1), st.floats(-1, 1).filter(lambda v: abs(v) > 0.01), st.floats(0.001, 2))
def test_the_arc_is_the_rotation_about_the_icc(pose, middle, difference, dt):
    left, right = middle - difference / 2, middle + difference / 2
    twist = BURGER.twist(WheelSpeeds(left / BURGER.wheel_radius, right / BURGER.wheel_radius))
    assert same(move(pose, twist, dt), about_the_icc(pose, left, right, BURGER.track, dt))


@given(poses, sideways_twists, st.floats(0.01, 3), st.floats(0.01, 3))
def test_two_arcs_in_a_row_are_one_long_arc(pose, twist, first, second):
    assert same(move(move(pose, twist, first), twist, second), move(pose, twist, first + second))


@given(poses, sideways_twists, st.floats(0.01, 3))
def test_driving_backwards_returns(pose, twist, dt):
    back = Twist(-twist.linear, -twist.angular, -twist.lateral)
    assert same(move(move(pose, twist, dt), back, dt), pose)


@given(poses, twists)
def test_the_wheels_do_not_slip_sideways(pose, twist):
    """y' cos yaw - x' sin yaw = 0 (the non-holonomic constraint), by central differences."""
    after, before = move(pose, twist, 1e-4), move(pose, twist, -1e-4)
    sideways = (after.y - before.y) * np.cos(pose.yaw) - (after.x - before.x) * np.sin(pose.yaw)
    assert abs(sideways / 2e-4) < 1e-6


def test_straight_ahead_needs_no_special_case():
    assert move((1.0, 2.0, np.pi / 2), Twist(0.5, 0.0), 2.0) == pytest.approx((1.0, 3.0, np.pi / 2))


@given(st.lists(st.floats(-10, 10), min_size=6, max_size=6))
def test_a_point_of_a_spinning_body_moves_by_the_cross_product(values):
    omega, arm = np.array(values[:3]), np.array(values[3:])
    assert spin_velocity(omega, arm) == pytest.approx(np.cross(omega, arm), abs=1e-9)


@given(poses, sideways_twists, st.floats(0.01, 1.0))
def test_the_velocity_between_two_poses_is_the_one_that_led_there(start, twist, dt):
    assert twist_between(start, move(start, twist, dt), dt) == pytest.approx(twist, abs=1e-6)


@given(poses, twists, st.floats(0.01, 0.5), st.floats(0.05, 1.0), st.floats(0.01, 1.0))
def test_the_wheels_that_lead_from_one_pose_to_another_are_found_and_lead_there(start, twist, radius, track, dt):
    drive, end = DifferentialDrive(radius, track), move(start, twist, dt)
    left, right = drive.wheels(twist_between(start, end, dt))
    assert same(move(start, drive.twist(WheelSpeeds(left * dt, right * dt)), 1.0), end)
