"""What the planner tries when the vehicle does not get on, what it takes the scan for, and previews of ways."""

import numpy as np
import pytest

from schemas.messages import (
    LaserScan,
    NavDirective,
    NavReport,
    NavStatus,
)
from tests.services.planner.planner_bench import START, Bench, asked, preview, world
from uvf.runtime.messages.convert import stamp

RECOVERIES = ["forgetting obstacles farther", "turning round", "forgetting all obstacles", "backing up", "waiting"]


def test_a_goal_is_given_up_when_the_vehicle_gets_nowhere_whatever_is_tried():
    bench = Bench().step(goal=[asked(3.0, 2.0)]).step(4 * 60)
    told = [event for event in bench.events if "does not move" in event]
    assert [event.startswith(recovery) for event, recovery in zip(told, RECOVERIES, strict=True)] == [True] * 5
    assert "goal: goal given up" in bench.events
    assert bench.said["nav_status"].job == "idle"
    bench.step(20)
    assert [event for event in bench.events if "given up" in event] == ["goal: goal given up"]


def test_trembling_about_the_heading_where_angles_wrap_is_not_getting_anywhere():
    bench = Bench().step(goal=[asked(3.0, 2.0)])
    for i in range(4 * 60):
        bench.yaw = START[2] + np.pi + (0.01 if i % 2 else -0.01)
        bench.step()
    assert "goal: goal given up" in bench.events


def test_what_the_tracker_is_to_do_goes_with_the_path():
    bench = Bench().step(goal=[asked(3.0, 2.0)])
    following = bench.said["directive"]
    assert (following.action, len(bench.said["path"].poses) > 10) == (NavDirective.FOLLOW, True)
    assert bench.step().said["directive"].number == following.number
    while bench.state != NavStatus.RECOVERING:
        bench.step()
    resetting = bench.said["directive"]
    assert (resetting.action, resetting.clear_beyond) == (NavDirective.STOP, 3.0)
    assert resetting.number > following.number
    assert (bench.state, len(bench.said["path"].poses)) == (NavStatus.RECOVERING, 0)
    assert bench.said["nav_status"].recoveries == 1


def test_a_recovery_ends_when_the_tracker_says_so():
    bench = Bench().step(goal=[asked(3.0, 2.0)])
    while bench.said["directive"].action != NavDirective.SPIN:
        bench.step()
    spin = bench.said["directive"]
    bench.step(report=NavReport(number=spin.number - 1, done=True))
    assert bench.said["directive"].number == spin.number
    bench.step(report=NavReport(number=spin.number, done=True))
    assert bench.said["directive"].action == NavDirective.FOLLOW


def wall_seen(bench, x):
    """A scan of a vehicle that looks along the map's x, with a wall across its way ``x`` [m] ahead, as wide as the room but for a gap."""
    angles = np.radians(np.arange(-60.0, 61.0))
    across = x * np.tan(angles)
    ranges = np.where((across > -0.95) & (across < 1.0), x / np.cos(angles), 0.0)
    return LaserScan(timestamp=stamp(bench.t), start_angle=angles[0], end_angle=angles[-1], ranges=ranges.tolist())


def test_what_the_lidar_sees_and_the_map_does_not_is_gone_round():
    bench = Bench().step(goal=[asked(3.0, 1.0)]).step(2)
    highest = max(pose.position.x for pose in bench.said["path"].poses)
    bench.step(scan=wall_seen(bench, 1.0)).step(4)
    path = np.array([(pose.position.y - START[1], START[0] - pose.position.x) for pose in bench.said["path"].poses])
    assert highest == pytest.approx(START[0] - 1.0, abs=0.1)
    assert path[np.abs(path[:, 0] - 2.0) < 0.3, 1].min() > 2.0


def test_a_preview_tells_the_way_without_driving_it():
    bench = Bench().step()
    bench.step(preview=[preview(3.0, 2.0), preview(0.07, 1.0)])
    good, bad = bench.said["preview"]
    assert (good.accepted, bench.said["nav_status"].job) == (True, "idle")
    assert good.length == pytest.approx(np.hypot(2.0, 1.0), rel=0.1)
    assert good.duration == pytest.approx(good.length / 0.45)
    assert good.clearance == pytest.approx(0.9, abs=0.15)
    assert (good.poses[-1].position.x, good.poses[-1].position.y) == pytest.approx(world(3.0, 2.0))
    assert (bad.accepted, bad.reason, len(bad.poses)) == (False, "the goal lies in an obstacle", 0)


def test_a_preview_may_begin_elsewhere():
    bench = Bench().step()
    places = ((3.0, 1.0), (-50.0, 1.0), (float("nan"), 1.0), (0.07, 1.0))
    bench.step(preview=[preview(3.0, 2.0, start) for start in places])
    good, outside, nowhere, wall = bench.said["preview"]
    assert good.length == pytest.approx(1.0, abs=0.1)
    assert (good.poses[0].position.x, good.poses[0].position.y) == pytest.approx(world(3.0, 1.0))
    assert [answer.reason for answer in (outside, nowhere, wall)] == [
        "the start lies outside the map",
        "the start is not a place: its coordinates must be finite",
        "the start lies in an obstacle",
    ]


def test_a_flood_of_previews_is_answered_in_part():
    bench = Bench().step().step(preview=[preview(2.0, 2.0)] * 50)
    answers = bench.said["preview"]
    assert [answer.accepted for answer in answers] == [True] * 4 + [False] * 46
    assert "ask again" in answers[-1].reason
