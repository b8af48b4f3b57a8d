"""The skid-steered robot: what friction allows and what four sliding wheels make of a turn."""

import numpy as np
import pytest

from benchmarks.planning.barn.jackal import JACKAL, TRACK, TRACK_FACTOR, WHEEL_BASE, Drive
from uvf.maths.kinematics import Twist

DT = 0.005


def driven(command, seconds):
    """Poses (n, 3) and twists (n, 2), forward and turning."""
    drive, poses, twists = Drive((0.0, 0.0, 0.0), DT), [], []
    for _ in range(round(seconds / DT)):
        drive.step(Twist(*command))
        poses.append(drive.pose.copy())
        twists.append(drive.twist[:2])
    return np.array(poses), np.array(twists)


def test_it_drives_straight_at_the_speed_asked_for():
    poses, twists = driven((1.5, 0.0), 4.0)
    assert twists[-1] == pytest.approx((1.5, 0.0), abs=1e-3)
    assert np.abs(poses[:, 1:]).max() < 1e-9
    assert poses[-1, 0] == pytest.approx(twists[:, 0].sum() * DT, rel=1e-3)


def test_it_gains_and_loses_speed_no_faster_than_its_tyres_hold():
    drive, speeds = Drive((0.0, 0.0, 0.0), DT), []
    for n in range(400):
        drive.step(Twist(2.0 if n < 200 else -2.0, 0.0))
        speeds.append(drive.twist.linear)
    gains = np.diff(speeds) / DT
    assert 0.9 * JACKAL.max_linear_acceleration < gains.max() <= JACKAL.max_linear_acceleration * 1.001
    assert -0.9 * JACKAL.max_linear_acceleration > gains.min() >= -JACKAL.max_linear_acceleration * 1.001


@pytest.mark.parametrize("rate", [0.3, 1.0, 3.0])
def test_a_turn_on_the_spot_is_as_slow_as_the_friction_of_four_wheels_balances(rate):
    """No moment is left where each wheel slides along the line to the middle: the track counts 1 + (L / B)^2 times."""
    _, twists = driven((0.0, rate), 4.0)
    assert twists[-1, 1] == pytest.approx(rate * TRACK_FACTOR / (1 + (WHEEL_BASE / TRACK) ** 2), rel=0.03)


def test_left_is_right_mirrored_and_backward_nearly_forward():
    left, right = driven((0.8, 1.0), 3.0)[0][-1], driven((0.8, -1.0), 3.0)[0][-1]
    assert left == pytest.approx(right * (1, -1, -1), abs=1e-9)
    assert left[1] > 0.0 and left[2] > 2.5


def test_commands_beyond_the_limits_are_clipped():
    assert driven((50.0, 0.0), 3.0)[1][-1, 0] == pytest.approx(2.0, abs=1e-3)
    assert driven((0.0, 50.0), 3.0)[1][-1, 1] == pytest.approx(driven((0.0, 4.0), 3.0)[1][-1, 1])


def test_a_finer_step_drives_the_same_way():
    coarse, _ = driven((1.0, 1.5), 2.0)
    drive = Drive((0.0, 0.0, 0.0), DT / 4)
    for _ in range(round(2.0 / (DT / 4))):
        drive.step(Twist(1.0, 1.5))
    assert coarse[-1] == pytest.approx(drive.pose, abs=0.02)
