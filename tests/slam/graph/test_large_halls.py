"""Halls so large that the beams of a lidar lie far apart on their walls: a sweep must not be matched to its own beams of before."""

import numpy as np
import pytest

from tests.slam.matching.walls import seen
from uvf.maths.se2 import IDENTITY, Pose2, compose
from uvf.slam.graph.method import GraphSlam
from uvf.slam.matching.cloud import SPACING, cloud_of
from uvf.slam.reading import Beams, Reading

STEP = 0.05  # m


def square(half):
    return np.array(((-half, -half, half, -half), (half, -half, half, half), (half, half, -half, half), (-half, half, -half, -half)))


def drive_off(half, beams, noise, turn, seed=1):
    """Largest error [m] of a drive of 6 m in an empty square hall of that half side [m], with odometry that is off by 1 %."""
    rng, slam = np.random.default_rng(seed), GraphSlam()
    lidar = Beams((0.0, 0.0), np.linspace(-np.pi, np.pi, beams, endpoint=False), 0.1, 2.0 * half)
    true, told, worst = IDENTITY, IDENTITY, 0.0
    for k in range(120):
        reading = seen(square(half), true, lidar)
        estimate = slam.add(Reading(0.1 * k, reading.ranges + noise * rng.standard_normal(beams), lidar, told))
        worst = max(worst, float(np.hypot(estimate.map_from_base.x - true.x, estimate.map_from_base.y - true.y)))
        true = compose(true, Pose2(STEP, 0.0, turn * STEP))
        told = compose(told, Pose2(STEP * 1.01, 0.0, turn * STEP))
    return worst


@pytest.mark.parametrize("turn", [0.0, 0.2], ids=["straight", "bend"])
@pytest.mark.parametrize(("half", "beams", "noise"), [(15.0, 360, 0.01), (20.0, 360, 0.03), (32.0, 920, 0.03), (50.0, 1080, 0.03)])
def test_a_vehicle_in_a_large_hall_gets_on(half, beams, noise, turn):
    assert drive_off(half, beams, noise, turn) < 0.05


def test_a_far_wall_is_filled_and_an_open_door_in_it_is_not():
    wall = np.array(((20.0, -8.0, 20.0, -0.6), (20.0, 0.6, 20.0, 8.0), (26.0, -9.0, 26.0, 9.0)))
    lidar = Beams((0.0, 0.0), np.radians(np.arange(-15.0, 15.01, 1.0)), 0.1, 30.0)
    cloud = cloud_of(seen(wall, beams=lidar))
    filled = cloud.filled()
    aside = np.sort(filled.points[np.abs(filled.points[:, 0] - 20.0) < 0.05][:, 1])
    gaps = np.diff(aside)
    before, after = len(cloud.points), len(filled.points)
    assert after > 1.7 * before
    assert sorted(gaps)[-2] <= SPACING
    assert aside[:-1][gaps > SPACING] == pytest.approx(-0.6, abs=0.4)
    assert np.abs(filled.normals[np.abs(filled.points[:, 0] - 20.0) < 0.05] - (-1.0, 0.0)).max() < 0.05
