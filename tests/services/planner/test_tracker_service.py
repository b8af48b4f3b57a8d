"""The tracker step by step: driving, slowing down before what it sees, backing off, standing without inputs."""

import numpy as np
import pytest

from schemas.messages import (
    LaserScan,
    PoseInFrame,
    PosesInFrame,
)
from services.planner.tracker_service import TrackerParams, TrackerService
from tests.runtime.stepping import stale, stepped
from tests.services.autopilot.ground.test_service import BODY
from tests.services.live_params import all_settable_are_read
from uvf.maths.rotations import from_euler
from uvf.maths.se3 import IDENTITY, Transform
from uvf.runtime.messages.convert import planar_pose, stamp
from uvf.sensors.sweeping import AT_ONCE, SPACING, Sweeping


def scan(t, ahead):
    """A wall across the way, ``ahead`` [m] of the lidar; nothing elsewhere."""
    angles = np.radians(np.arange(360.0))
    ranges = np.where(np.cos(angles) > 0.5, ahead / np.maximum(np.cos(angles), 0.5), 0.0)
    return LaserScan(timestamp=stamp(t), start_angle=0.0, end_angle=angles[-1], ranges=ranges.tolist())


class TrackerBench:
    """A vehicle at the world's origin that looks east; the wall stays ``ahead``, the path leads 3 m east."""

    def __init__(self, base_from_lidar=IDENTITY):
        self.service = TrackerService(BODY, base_from_lidar, TrackerParams())
        self.t = 0.0
        self.commands = []
        self.events = []

    def step(self, n, ahead, blind=False):
        path = PosesInFrame(poses=[planar_pose(0.1 * i, 0.0, 0.0) for i in range(31)])
        for _ in range(n):
            self.t += 0.05
            poses = [PoseInFrame(timestamp=stamp(self.t - s), pose=planar_pose(0.0, 0.0, 0.0)) for s in (0.04, 0.02)]
            seen_at = 0.0 if blind else self.t - 0.03
            out = stepped(self.service, self.t, path=path, pose=poses, scan=scan(seen_at, ahead))
            self.commands.append((out["drive"].linear, out["drive"].angular))
            self.events += [e.text for e in out.get("events", [])]
        return self


def test_drives_where_the_way_is_free():
    assert TrackerBench().step(10, ahead=3.0).commands[-1][0] == pytest.approx(TrackerParams().speed)


def test_slows_down_and_stops_before_what_it_sees():
    free, near, close = (TrackerBench().step(3, ahead).commands[-1][0] for ahead in (3.0, 0.4, 0.18))
    assert free > near > 0.0
    assert close == 0.0


def test_what_a_scanner_sees_that_hangs_upside_down_is_on_the_side_where_it_is():
    """Its right is the vehicle's left: an obstacle in front and on the left slows a curve to the left, not one to the right."""
    beside = LaserScan(timestamp=stamp(1.0), start_angle=-1.0, end_angle=-0.8, ranges=[0.2] * 9)
    poses = [PoseInFrame(timestamp=stamp(1.0), pose=planar_pose(0.0, 0.0, 0.0))]
    hanging = Transform(from_euler(np.pi, 0.0, 0.0), np.zeros(3))

    def speed(side):
        path = PosesInFrame(poses=[planar_pose(0.1 * i, side * 0.1 * i, 0.0) for i in range(11)])
        return stepped(TrackerService(BODY, hanging, TrackerParams()), 1.0, path=path, pose=poses, scan=beside)["drive"].linear

    assert speed(-1.0) > 1.2 * speed(1.0)


TURNING = 1.5  # rad/s
SWEEP = 0.2  # s


def swept_post(clockwise):
    """A post 0.5 m east of a vehicle that turns left on the spot, and its lidar with it; the sweep ends at 1 s."""
    moments, angles = np.linspace(1.0 - SWEEP, 1.0, 360), np.radians(np.arange(360.0))
    seen_along = angles + TURNING * (moments[::-1] if clockwise else moments)
    ranges = np.where(np.cos(seen_along) > np.cos(0.1), 0.5, 0.0)
    return LaserScan(timestamp=stamp(1.0 - SWEEP), start_angle=0.0, end_angle=angles[-1], ranges=ranges.tolist())


def poses_until(end):
    return [PoseInFrame(timestamp=stamp(t), pose=planar_pose(0.0, 0.0, TURNING * t)) for t in np.arange(0.0, end + 1e-9, 0.02)]


def post_seen(sweeping, clockwise, end=1.02):
    """Bearings [rad] in the world at which it is taken to stand."""
    service = TrackerService(BODY, IDENTITY, TrackerParams(), sweeping)
    stepped(service, 1.02, path=PosesInFrame(), pose=poses_until(end), scan=swept_post(clockwise))
    return np.arctan2(service._seen[:, 1], service._seen[:, 0])


@pytest.mark.parametrize("clockwise", [False, True])
def test_what_a_slow_lidar_sees_is_where_it_was_when_it_was_seen(clockwise):
    found = post_seen(Sweeping(SWEEP, clockwise), clockwise)
    assert len(found) > 8
    assert np.abs(found).max() < 0.1 + TURNING * SPACING / 2
    assert np.abs(post_seen(AT_ONCE, clockwise)).max() > 0.15


def test_a_sweep_counts_when_the_pose_at_its_last_beam_is_known():
    assert len(post_seen(Sweeping(SWEEP), False, end=0.96)) == 0


def test_a_slow_scan_is_as_old_as_its_last_beam():
    wall = scan(1.0, ahead=3.0)
    path = PosesInFrame(poses=[planar_pose(0.1 * i, 0.0, 0.0) for i in range(31)])
    service = TrackerService(BODY, IDENTITY, TrackerParams(), Sweeping(0.5))
    poses = [PoseInFrame(timestamp=stamp(0.02 * k), pose=planar_pose(0.0, 0.0, 0.0)) for k in range(100)]
    assert stepped(service, 2.0, path=path, pose=poses, scan=wall)["drive"].linear > 0.1
    assert stepped(service, 2.2, path=path, pose=[], scan=wall)["drive"].linear == 0.0


def test_backs_off_when_it_stays_blocked():
    bench = TrackerBench().step(70, ahead=0.18)
    assert bench.commands[5][0] == 0.0
    assert bench.commands[-1][0] == pytest.approx(-TrackerParams().back_off)
    assert bench.events == ["obstacle ahead"]


def test_an_obstacle_that_comes_and_goes_is_told_every_ten_seconds_at_most():
    bench = TrackerBench()
    for _ in range(50):
        bench.step(6, ahead=0.18).step(4, ahead=3.0)
    assert bench.t == pytest.approx(25.0)
    assert bench.events == ["obstacle ahead"] * 3


def test_blind_it_does_not_move():
    bench = TrackerBench().step(10, ahead=3.0)
    assert bench.step(20, ahead=3.0, blind=True).commands[-1] == (0.0, 0.0)


def test_stale_inputs_mean_stop():
    drive = stale(TrackerBench().service, 3.0, ("pose",))["drive"]
    assert (drive.linear, drive.angular) == (0.0, 0.0)


def test_parameters_of_the_tracker_count_while_running():
    bench = TrackerBench()
    with all_settable_are_read(bench.service):
        bench.step(5, ahead=3.0).step(40, ahead=0.18)
    bench = TrackerBench().step(5, ahead=3.0)
    bench.service.params = TrackerParams(speed=0.1)
    assert bench.step(5, ahead=3.0).commands[-1][0] == pytest.approx(0.1)
    bench.service.params = TrackerParams(margin=1.0)
    assert bench.step(3, ahead=1.0).commands[-1] == (0.0, 0.0)
