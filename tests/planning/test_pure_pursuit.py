"""Path tracking and the look ahead, closed over ideal kinematics."""

import numpy as np
import pytest

from uvf.maths.kinematics import Twist, move
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.planning.collision_check import clearance_along, safe_share
from uvf.planning.pure_pursuit import PathTracker, SpeedLimits

PACE = SpeedLimits(linear=0.45, angular=1.5, deceleration=0.5, tolerance=0.06)
BRAKE = (0.3, 0.5)
KEEP = 0.15


def follow(path, start, seconds, final_heading=None, room=np.inf):
    """(n, 3) poses and (n, 2) commands at 20 Hz."""
    tracker, pose = PathTracker(PACE), Pose2(*start)
    poses, commands = [pose], []
    for _ in range(round(seconds * 20)):
        command = tracker.follow(pose, path, final_heading, room)
        pose = move(pose, Twist(*command), 0.05)
        poses.append(pose)
        commands.append(command)
    return np.array(poses), np.array(commands)


def test_a_straight_way_is_driven_briskly_and_stops_at_its_end():
    path = np.column_stack((np.linspace(0, 3, 31), np.zeros(31)))
    poses, commands = follow(path, (0.0, 0.0, 0.0), 12.0)
    assert commands[:, 0].max() == pytest.approx(PACE.linear)
    assert np.hypot(*(poses[-1, :2] - path[-1])) <= PACE.tolerance
    assert (commands[-1] == 0.0).all()
    assert np.abs(poses[:, 1]).max() < 1e-6


def test_a_bend_is_followed_closely():
    angle = np.linspace(0, np.pi, 40)
    path = np.column_stack((np.sin(angle), 1 - np.cos(angle)))
    poses, _ = follow(path, (0.0, 0.0, 0.0), 15.0)
    off = np.abs(np.hypot(poses[:, 0], poses[:, 1] - 1.0) - 1.0)
    assert off.max() < 0.08
    assert np.hypot(*(poses[-1, :2] - path[-1])) <= PACE.tolerance


def test_corners_are_cut_less_where_room_is_short():
    corner = np.vstack((np.column_stack((np.linspace(0, 1, 11), np.zeros(11))), np.column_stack((np.ones(10), np.linspace(0.1, 1, 10)))))

    def cut(room):
        """m from the corner to the nearest pose."""
        poses, _ = follow(corner, (0.0, 0.0, 0.0), 12.0, room=room)
        return np.hypot(poses[:, 0] - 1.0, poses[:, 1]).min()

    assert cut(0.0) < 0.5 * cut(np.inf)


def test_turns_on_the_spot_when_the_path_lies_behind():
    path = np.column_stack((np.linspace(0, -2, 21), np.zeros(21)))
    poses, commands = follow(path, (0.0, 0.0, 0.3), 9.0)
    assert commands[0, 0] == 0.0
    assert abs(commands[0, 1]) == PACE.angular
    assert np.hypot(*(poses[-1, :2] - path[-1])) <= PACE.tolerance


def test_comes_back_to_a_path_it_is_beside():
    path = np.column_stack((np.linspace(0, 4, 41), np.zeros(41)))
    poses, _ = follow(path, (0.0, 0.4, 0.0), 12.0)
    assert np.abs(poses[-40:, 1]).max() < 0.03


def test_turns_to_the_wanted_heading_at_the_end():
    path = np.column_stack((np.linspace(0, 1, 11), np.zeros(11)))
    poses, commands = follow(path, (0.0, 0.0, 0.0), 10.0, final_heading=-2.0)
    assert abs(wrap(poses[-1, 2] + 2.0)) < 0.06
    assert (commands[-1] == 0.0).all()


def test_never_faster_than_its_pace():
    path = np.cumsum(np.random.default_rng(4).normal(0.05, 0.1, (60, 2)), axis=0)
    _, commands = follow(path, (0.0, 0.0, 2.0), 20.0)
    assert commands[:, 0].min() >= 0.0
    assert commands[:, 0].max() <= PACE.linear
    assert np.abs(commands[:, 1]).max() <= PACE.angular + 1e-9


def test_an_empty_path_means_stand():
    assert PathTracker(PACE).follow((1.0, 2.0, 3.0), np.zeros((0, 2)), None, np.inf) == (0.0, 0.0)


def test_the_clearance_along_an_arc_equals_that_of_its_poses():
    points = np.random.default_rng(2).uniform((0.5, -1.0), (2.5, 1.0), (40, 2))
    now, least = clearance_along(points, 0.4, 0.9, 1.0)
    poses = [move(Pose2(0.0, 0.0, 0.0), Twist(0.4, 0.9), 0.04 * k) for k in range(26)]
    distances = [np.hypot(*(points - (p.x, p.y)).T).min() for p in poses]
    assert now == pytest.approx(distances[0])
    assert least == pytest.approx(min(distances), abs=1e-6)


def test_full_speed_where_nothing_is_near():
    assert safe_share(np.zeros((0, 2)), (0.45, 0.0), KEEP, BRAKE) == 1.0
    assert safe_share(np.array(((0.0, 0.4),)), (0.45, 0.0), KEEP, BRAKE) == 1.0


def test_stops_before_a_wall():
    x, speed = 0.0, 0.0
    for _ in range(200):
        wall = np.column_stack((np.full(21, 1.0 - x), np.linspace(-1, 1, 21)))
        wanted = 0.45 * safe_share(wall, (0.45, 0.0), KEEP, BRAKE)
        speed = max(wanted, speed - 0.8 * 0.05)
        x += 0.05 * speed
    assert 0.7 < x <= 1.0 - KEEP + 1e-6


def test_turning_on_the_spot_is_always_possible():
    assert safe_share(np.array(((0.05, 0.0),)), (0.0, 1.0), KEEP, BRAKE) == 1.0


def test_who_is_too_near_may_only_move_away():
    ahead = np.array(((0.12, 0.0),))
    assert safe_share(ahead, (0.1, 0.0), KEEP, BRAKE) == 0.0
    assert safe_share(ahead, (-0.1, 0.0), KEEP, BRAKE) == 1.0
