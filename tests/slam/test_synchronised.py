"""A skew between the stamps of sweeps and odometry, found while the graph is built."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.slam.evaluation.building import corridors
from benchmarks.slam.evaluation.driven import Wear, drive, route
from tests.slam.graph.buildings import HALF_ROUND
from uvf.maths.se2 import Pose2
from uvf.slam.graph.method import GraphSlam
from uvf.slam.logs.laser_log import OdometryTrack
from uvf.slam.synchronised import Synchronised

CORNERS = np.array(((0.0, 0.0), (6.0, 0.0), (6.0, 5.0), (0.0, 5.0), (0.0, 0.0), (6.0, 0.0), (6.0, 5.0)))
LINES = np.array(((0.0, 0.0, 6.0, 0.0), (6.0, 0.0, 6.0, 5.0), (6.0, 5.0, 0.0, 5.0), (0.0, 5.0, 0.0, 0.0)))


def driven(late):
    """A log whose sweeps are stamped ``late`` [s] after they were taken, with the odometry of their stamps."""
    made = drive(route(CORNERS), corridors(LINES, np.random.default_rng(3)), HALF_ROUND, Wear(), 3)
    track = made.log.odometry
    finer = np.arange(track.t[0], track.t[-1], 0.05)
    columns = (*track.odom_from_base[:, :2].T, np.unwrap(track.odom_from_base[:, 2]))
    poses = np.column_stack([np.interp(finer, track.t, column) for column in columns])
    readings = []
    for reading in made.log.readings:
        t = reading.t + late
        readings.append(replace(reading, t=t, odom_from_base=Pose2(*(float(np.interp(t, finer, column)) for column in poses.T))))
    return replace(made, log=replace(made.log, readings=readings, odometry=OdometryTrack(finer, poses)))


def mapped(made, synchronised=True):
    """(the method, poses of all readings)"""
    method = Synchronised(GraphSlam(), made.log.odometry) if synchronised else GraphSlam()
    for reading in made.log:
        method.add(reading)
    method.finish()
    return method, method.trajectory()


@pytest.mark.parametrize("late", [0.15, -0.2])
def test_a_skew_is_found_and_taken_off(late):
    made = driven(late)
    method, poses = mapped(made)
    assert method.shifts
    assert method.skew.seconds == pytest.approx(-late, abs=0.04)
    assert np.hypot(*(poses - made.map_from_base)[:, :2].T).max() < 0.25


def test_a_track_that_ends_before_the_sweeps_leaves_the_rest_to_their_own_odometry():
    made = driven(0.15)
    track = made.log.odometry
    half = 2 * len(track.t) // 3
    cut = replace(made, log=replace(made.log, odometry=OdometryTrack(track.t[:half], track.odom_from_base[:half])))
    fed = Followed()
    method = Synchronised(fed, cut.log.odometry)
    for reading in cut.log:
        method.add(reading)
    told, own = (np.array(p)[:, :2] for p in (fed.odometry, [r.odom_from_base for r in cut.log]))
    assert 0.05 < np.hypot(*(told - own).T).max() < 0.5


class Followed(GraphSlam):
    """Notes what odometry it is fed with."""

    def __init__(self):
        super().__init__()
        self.odometry = []

    def add(self, reading):
        self.odometry.append(reading.odom_from_base)
        return super().add(reading)


def test_a_good_log_is_left_alone():
    made = driven(0.0)
    method, poses = mapped(made)
    assert not method.shifts
    assert abs(method.skew.seconds) < 0.03
    np.testing.assert_array_equal(poses, mapped(made, synchronised=False)[1])
    assert len(list(method.keyframes())) > 50
