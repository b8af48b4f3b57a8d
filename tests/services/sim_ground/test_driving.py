"""The simulated burger does what the kinematics say, on its wheels, in the real engine."""

from itertools import pairwise

import numpy as np
import pytest

from schemas import topics
from tests.services.sim_ground.ride import BURGER, STILL, ride, site_with
from uvf.maths.kinematics import Twist, WheelSpeeds, move
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.runtime.messages.convert import array

HALL = (6.0, 4.4, 0.0)
LIDAR_RADIUS = 0.055  # m; both carry it at the same height


def drive(tmp_path, until, script, start=HALL):
    return ride(site_with(tmp_path, {"burger": start}), until, {"burger": script})


def test_drives_one_metre_straight(tmp_path):
    record = drive(tmp_path, 6.0, lambda t: Twist(0.2, 0.0) if t < 5.0 else STILL)
    x, y, yaw = record.pose(-1)
    assert x - HALL[0] == pytest.approx(1.0, abs=0.02)
    assert abs(y - HALL[1]) < 0.005
    assert abs(yaw) < 0.005


def test_turns_on_the_spot(tmp_path):
    record = drive(tmp_path, 6.0, lambda t: Twist(0.0, 1.0) if t < 5.0 else STILL)
    x, y, yaw = record.pose(-1)
    assert np.hypot(x - HALL[0], y - HALL[1]) < 0.005
    assert wrap(yaw - 5.0) == pytest.approx(0.0, abs=0.05)


def test_drives_an_arc_about_the_icc(tmp_path):
    twist = Twist(0.2, 0.5)
    record = drive(tmp_path, 6.0, lambda t: twist if t < 3.0 else STILL, start=(6.0, 4.2, -0.75))
    wanted = move(Pose2(6.0, 4.2, -0.75), twist, 3.0)
    assert record.pose(-1)[:2] == pytest.approx(wanted[:2], abs=0.02)
    assert record.pose(-1).yaw == pytest.approx(wanted.yaw, abs=0.06)


def test_the_encoders_tell_the_way(tmp_path):
    """Dead reckoning from the ticks alone follows the truth over a ride of curves."""
    record = drive(tmp_path, 8.0, lambda t: Twist(0.25, 0.9 * np.sin(t)))
    ticks, pose = record.of(topics.WHEELS), record.pose(0)
    for before, after in pairwise(ticks):
        steps = (after.left - before.left, after.right - before.right)
        pose = move(pose, BURGER.twist(WheelSpeeds(*(n * after.radians_per_tick for n in steps))), 1.0)
    assert record.pose(-1)[:2] == pytest.approx(pose[:2], abs=0.04)
    assert wrap(record.pose(-1).yaw - pose.yaw) == pytest.approx(0.0, abs=0.04)


def test_full_speed_and_a_full_stop_do_not_tip_it(tmp_path):
    record = drive(tmp_path, 5.0, lambda t: Twist(0.5, 0.0) if 1.0 < t < 4.0 else STILL, start=(6.0, 4.4, 0.0))
    speeds = [np.linalg.norm(array(s.velocity)) for s in record.of(topics.TRUTH)]
    assert max(speeds) == pytest.approx(0.5, abs=0.02)
    assert speeds[-1] < 0.01
    assert record.tilts().max() < 0.05


def test_full_turn_at_full_speed_does_not_tip_it(tmp_path):
    record = drive(tmp_path, 4.0, lambda t: Twist(0.5, 2.0))
    assert record.tilts().max() < 0.05
    assert not any(c.touching for c in record.of(topics.CONTACT))


def test_a_command_that_stops_coming_stops_the_wheels(tmp_path):
    record = drive(tmp_path, 4.0, lambda t: Twist(0.3, 0.0) if t < 2.0 else None)
    speed = {round(s.timestamp.seconds + s.timestamp.nanos * 1e-9, 3): s.velocity.x for s in record.of(topics.TRUTH)}
    assert speed[2.4] == pytest.approx(0.3, abs=0.01)
    assert abs(speed[3.0]) < 0.01


def test_without_any_command_it_stays(tmp_path):
    record = drive(tmp_path, 2.0, lambda t: None)
    assert record.pose(-1)[:2] == pytest.approx(HALL[:2], abs=1e-3)


def test_it_bumps_into_the_wall_and_says_so(tmp_path):
    record = drive(tmp_path, 4.0, lambda t: Twist(0.3, 0.0), start=(5.6, 4.4, np.pi / 2))
    contacts = record.of(topics.CONTACT)
    assert not contacts[0].touching
    assert contacts[-1].touching
    assert contacts[-1].other == "wall"
    assert record.pose(-1).y < 5.05


def test_two_robots_meet_and_see_each_other(tmp_path):
    starts = {"left": (6.0, 4.4, 0.0), "right": (7.2, 4.4, np.pi)}
    record = ride(site_with(tmp_path, starts), 4.0, dict.fromkeys(starts, lambda t: Twist(0.2, 0.0) if t > 0.5 else STILL))
    assert record.of(topics.SCAN, "left")[0].ranges[0] == pytest.approx(1.2 + 2 * 0.032 - LIDAR_RADIUS, abs=0.04)
    assert record.of(topics.CONTACT, "left")[-1].other == "right"
    assert record.of(topics.CONTACT, "right")[-1].other == "left"
