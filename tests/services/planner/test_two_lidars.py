"""A vehicle with a lidar before and one behind: each shows what the other does not, and without either it stands."""

import numpy as np
import pytest

from schemas.messages import LaserScan, NavDirective, PoseInFrame
from services.planner.obstacle_sensors import ObstacleSensors
from services.planner.scan_placing import PlacedLidar, ScanPlacer
from services.planner.tracker_service import FARTHEST, TrackerParams, TrackerService
from tests.runtime.stepping import stepped
from tests.services.autopilot.ground.test_service import BODY
from tests.services.planner.seeing import NO_OTHERS, TOP
from tests.services.planner.test_tracker_service import EAST, FOOTPRINT, NOTHING
from uvf.maths.rotations import from_euler
from uvf.maths.se3 import Transform
from uvf.runtime.messages.convert import planar_pose, stamp
from uvf.sensors.sweeping import AT_ONCE

HALF = np.linspace(-np.pi / 2, np.pi / 2, 181)
BACK = NavDirective(number=7, action=NavDirective.BACK_UP, amount=0.5)


def lidar(x, yaw):
    return PlacedLidar(Transform(from_euler(0.0, 0.0, yaw), np.array((x, 0.0, 0.1))), AT_ONCE)


def half_scan(t, frame, wall):
    """A wall straight across, ``wall`` [m] from the lidar."""
    ranges = wall / np.maximum(np.cos(HALF), 1e-3)
    return LaserScan(timestamp=stamp(t), frame_id=frame, start_angle=HALF[0], end_angle=HALF[-1], ranges=np.minimum(ranges, 9.0).tolist())


class TwoLidars:
    """Looks east from the world's origin; a wall 3 m ahead, another ``behind`` [m] the vehicle's middle. apart: m, of the lidars."""

    def __init__(self, apart=0.05):
        self.apart = apart
        placer = ScanPlacer({"v/front": lidar(apart, 0.0), "v/rear": lidar(-apart, np.pi)}, FARTHEST)
        sensors = ObstacleSensors(placer, FOOTPRINT, NO_OTHERS, TOP)
        self.service = TrackerService("v", (BODY, FOOTPRINT), sensors, TrackerParams())
        self.t, self.x, self.out = 0.0, 0.0, {}

    def step(self, n, directive, behind, speaks=True):
        for _ in range(n):
            self.t += 0.1
            poses = [PoseInFrame(timestamp=stamp(self.t - s), pose=planar_pose(self.x, 0.0, 0.0)) for s in (0.08, 0.04, 0.02)]
            front = half_scan(self.t - 0.03, "v/front", 3.0 - self.x - self.apart)
            rear = half_scan(self.t - 0.05, "v/rear", behind + self.x - self.apart)
            told = NOTHING | {"directive": directive, "path": EAST, "pose": poses, "scan": front}
            self.out = stepped(self.service, self.t, other_scans=[rear] if speaks else [], **told)
            self.x += 0.1 * self.out["drive"].linear
        return self


@pytest.mark.parametrize("apart", [0.05, 0.0])
def test_backs_up_as_far_as_the_rear_lidar_shows_room(apart):
    free, shut = TwoLidars(apart).step(60, BACK, behind=3.0), TwoLidars(apart).step(60, BACK, behind=0.35)
    assert free.x == pytest.approx(-0.5, abs=0.05)
    assert -0.35 + BODY.radius < shut.x < -0.05
    assert shut.out["report"].impossible


def test_stands_when_either_lidar_falls_silent():
    follow = NavDirective(number=1, action=NavDirective.FOLLOW)
    bench = TwoLidars().step(10, follow, behind=3.0)
    assert bench.out["drive"].linear > 0.1
    assert bench.step(10, follow, behind=3.0, speaks=False).out["drive"].linear == 0.0
    assert bench.step(5, follow, behind=3.0).out["drive"].linear > 0.1


def test_a_lidar_whose_newest_scan_is_always_ahead_of_the_poses_is_seen_with():
    bench = TwoLidars()
    follow = NavDirective(number=1, action=NavDirective.FOLLOW)
    for _ in range(12):
        bench.t += 0.1
        poses = [PoseInFrame(timestamp=stamp(bench.t - s), pose=planar_pose(0.0, 0.0, 0.0)) for s in (0.08, 0.04, 0.02)]
        scans = [half_scan(bench.t - 0.01, frame, 3.0) for frame in ("v/front", "v/rear")]
        told = NOTHING | {"directive": follow, "path": EAST, "pose": poses, "scan": scans[0]}
        bench.out = stepped(bench.service, bench.t, other_scans=scans[1:], **told)
    assert bench.out["drive"].linear > 0.1
