"""Where a body has been."""

from typing import NamedTuple

import numpy as np
import pytest

from uvf.maths.rotations import from_euler, to_euler
from uvf.sensors.body_track import BodyTrack


class Pose(NamedTuple):
    position: np.ndarray
    world_from_body: np.ndarray


def track_of(poses, span=1.0):
    """poses: (t, x, yaw)."""
    track = BodyTrack(span)
    for t, x, yaw in poses:
        track.add(t, Pose(np.array((x, 2.0, 0.0)), from_euler(0.0, 0.0, yaw)))
    return track


def yaws(attitudes):
    return [to_euler(q)[2] for q in attitudes]


def test_between_two_poses_the_body_is_between_them():
    positions, attitudes = track_of([(0.0, 0.0, 0.1), (0.1, 0.4, 0.2), (0.2, 0.4, 0.6)]).at(np.array((0.025, 0.1, 0.15)))
    assert positions[:, 0] == pytest.approx((0.1, 0.4, 0.4))
    assert positions[:, 1:] == pytest.approx(np.tile((2.0, 0.0), (3, 1)))
    assert yaws(attitudes) == pytest.approx((0.125, 0.2, 0.4), abs=1e-4)
    assert np.linalg.norm(attitudes, axis=1) == pytest.approx(np.ones(3))


def test_a_quaternion_that_changes_its_sign_is_no_turn():
    track = BodyTrack(1.0)
    for k, sign in enumerate((1.0, -1.0, -1.0, 1.0, -1.0)):
        track.add(0.1 * k, Pose(np.zeros(3), sign * from_euler(0.0, 0.0, 0.1 * k)))
    times = np.linspace(0.0, 0.4, 9)
    assert yaws(track.at(times)[1]) == pytest.approx(times, abs=1e-4)


def test_turning_past_half_a_turn_it_goes_the_short_way():
    attitudes = track_of([(0.0, 0.0, np.pi - 0.1), (0.1, 0.0, -np.pi + 0.1)]).at(np.array((0.025, 0.075)))[1]
    assert yaws(attitudes) == pytest.approx((np.pi - 0.05, -np.pi + 0.05), abs=1e-3)


def test_before_the_first_pose_and_after_the_last_the_body_stands():
    positions, attitudes = track_of([(1.0, 3.0, 0.2), (1.1, 4.0, 0.3)]).at(np.array((0.0, 5.0)))
    assert positions[:, 0].tolist() == [3.0, 4.0]
    assert yaws(attitudes) == pytest.approx((0.2, 0.3))


def test_a_single_pose_holds_at_all_times():
    positions, attitudes = track_of([(1.0, 3.0, 0.2)]).at(np.array((0.0, 1.0, 2.0)))
    assert positions[:, 0].tolist() == [3.0] * 3
    assert yaws(attitudes) == pytest.approx([0.2] * 3)


def test_what_is_older_than_the_span_is_forgotten_and_the_span_itself_is_known():
    track = track_of([(0.01 * k, 0.01 * k, 0.0) for k in range(1001)], span=0.2)
    assert len(track._poses) < 25
    assert track.at(np.array((9.8, 9.9, 10.0)))[0][:, 0] == pytest.approx((9.8, 9.9, 10.0))
