"""Broken poses, maps and scans on the bus: planner and tracker stand and wait, are not ended, and go on with the next good ones."""

import math

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Grid, LaserScan, PoseInFrame, PosesInFrame
from services.planner.params import PlannerParams
from services.planner.planned_vehicle import PlannedVehicle
from services.planner.planner_service import PlannerService
from services.planner.tracker_service import TrackerParams, TrackerService
from tests.services.autopilot.ground.test_service import BODY
from tests.services.planner.plans import room
from tests.services.planner.seeing import sensors_of
from uvf.maths.se2 import IDENTITY
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.messages.convert import occupancy_grid, planar_pose, stamp

NAN = math.nan
FOOTPRINT = RobotFootprint.circle(0.1)
POSES = {
    "good": (1.0, 1.0, 0.0),
    "nan": (NAN, 1.0, 0.0),
    "turned by nan": (1.0, 1.0, NAN),
    "infinite": (1.0, -math.inf, 0.0),
    "far": (1e11, 1e11, 0.0),
}
RANGES = {"good": [2.0] * 360, "nan": [NAN] * 360, "infinite": [math.inf] * 360, "huge": [1e300] * 360, "minus": [-1.0] * 360, "none": []}
GRIDS = {
    "good": occupancy_grid(room(4.0, 3.0), 0.05, 0.0, 0.0, "v/map", 0.0),
    "empty": Grid(),
    "no cells": occupancy_grid(np.zeros((0, 4), dtype=np.int8), 0.05, 0.0, 0.0, "v/map", 0.0),
    "one cell": occupancy_grid(np.zeros((1, 1), dtype=np.int8), 0.05, 0.0, 0.0, "v/map", 0.0),
    "no resolution": occupancy_grid(room(4.0, 3.0), 0.0, 0.0, 0.0, "v/map", 0.0),
    "nan resolution": occupancy_grid(room(4.0, 3.0), NAN, 0.0, 0.0, "v/map", 0.0),
    "nowhere": occupancy_grid(room(4.0, 3.0), 0.05, NAN, 0.0, "v/map", 0.0),
}


class Bench:
    """Planner (explores) and tracker on one bus, fed by hand."""

    def __init__(self):
        self.bus, self.told, self.t = LocalBus(), [], 0.0
        makers = {
            PlannerService: lambda: PlannerService(
                IDENTITY, PlannedVehicle(FOOTPRINT, sensors_of(FOOTPRINT), 0.45, True, "v"), PlannerParams()
            ),
            TrackerService: lambda: TrackerService("v", (BODY, FOOTPRINT), sensors_of(FOOTPRINT), TrackerParams()),
        }
        self.shells = [ServiceRunner(ServiceInstance(kind, make, "v"), self.bus, self.told.append) for kind, make in makers.items()]

    def put(self, topic, message):
        message.timestamp.CopyFrom(stamp(self.t))
        self.bus.publisher(topic.at("v"), topic.message.DESCRIPTOR.full_name, topic.qos).put(
            message.SerializeToString(), round(self.t * 1e9)
        )

    def run(self, seconds, pose="good", grid="good", ranges="good"):
        for _ in range(round(seconds / 0.05)):
            self.put(topics.POSE, PoseInFrame(pose=planar_pose(*POSES[pose])))
            self.put(topics.SCAN, LaserScan(start_angle=-3.0, end_angle=3.0, ranges=RANGES[ranges]))
            self.put(topics.MAP, Grid.FromString(GRIDS[grid].SerializeToString()))
            self.put(topics.PATH, PosesInFrame(poses=[planar_pose(*POSES[pose])] * 2))
            self.t += 0.05
            for shell in self.shells:
                while shell.due_ns <= self.t * 1e9:
                    shell.advance()
        return self

    @property
    def stale(self):
        return [shell.counters.missing for shell in self.shells]


@pytest.mark.parametrize("what", [*(("pose", k) for k in POSES), *(("ranges", k) for k in RANGES), *(("grid", k) for k in GRIDS)], ids=str)
def test_nothing_that_is_sent_ends_them_and_good_data_gets_them_going_again(what):
    bench = Bench().run(0.5).run(3.0, **dict([what])).run(1.0)
    assert bench.stale == [(), ()]


@pytest.mark.parametrize("pose", ["nan", "turned by nan", "infinite"])
def test_a_pose_that_is_none_counts_as_missing_and_is_told_of_once_by_each(pose):
    bench = Bench().run(3.0, pose=pose)
    assert all("pose" in missing for missing in bench.stale)
    assert sum("nav/pose: broken foxglove.PoseInFrame: pose." in line for line in bench.told) == 2
    assert bench.shells[0].refusals.count > 5
