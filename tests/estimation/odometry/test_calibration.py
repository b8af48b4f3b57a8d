"""Radii and track from matched motions: right, as certain as they are, and only where the drive shows them."""

import numpy as np
import pytest

from benchmarks.estimation.odometry.drive import TRACK, World, drive
from uvf.estimation.odometry.calibration import PRIOR, Scales, SegmentMaker, WheelCalibration
from uvf.maths.se2 import Pose2


def calibrated(world, seed, *, place=0.01, turn=0.005, slips=False, straight=False):
    """After a drive whose true poses, with the noise of a scan match, come ten times a second."""
    rng = np.random.default_rng(1000 + seed)
    calibration = WheelCalibration(TRACK)
    maker = SegmentMaker(calibration)
    for k, moment in enumerate(drive(world, seed)):
        step, pose = moment.step, moment.pose
        maker.roll(step.left, step.right, pose.yaw, slipping=False)
        if straight and abs(step.right - step.left) > 1e-3:
            maker.roll(0.0, 0.0, pose.yaw, slipping=True)
        if k % 5 == 0:
            x, y, yaw = np.array(pose) + rng.standard_normal(3) * (place, place, turn)
            maker.match(Pose2(float(x), float(y), float(yaw)))
    return calibration


WRONG = World(seconds=120.0, left=1.03, right=0.98, track=1.05, radius=0.0)


def test_radii_and_track_are_found():
    found = calibrated(WRONG, 1)
    assert found.scales.left == pytest.approx(1.03, abs=0.005)
    assert found.scales.right == pytest.approx(0.98, abs=0.005)
    assert found.scales.track == pytest.approx(1.05, abs=0.02)
    assert found.is_certain and found.differs


def test_wheels_as_they_should_be_do_not_differ():
    found = calibrated(World(seconds=120.0, radius=0.0), 2)
    assert found.is_certain
    assert np.abs(np.array(found.scales) - 1.0).max() < 0.01


def test_the_errors_are_as_large_as_the_covariance_says():
    true, errors = Scales(1.03, 0.98, 1.05), []
    for seed in range(12):
        found = calibrated(World(seconds=40.0, left=1.03, right=0.98, track=1.05, radius=0.0), seed)
        e = np.array(found.scales) - true
        errors.append(e @ np.linalg.solve(found.covariance, e) / 3)
    assert 0.1 < np.mean(errors) < 2.0


def test_slip_is_left_out():
    world = World(seconds=120.0, left=1.03, right=0.98, track=1.05, radius=0.0, slips=((30.0, 33.0, 0.3, 0.3), (70.0, 74.0, 0.0, 0.3)))
    found = calibrated(world, 3)
    assert found.refused > 0
    assert found.scales == pytest.approx((1.03, 0.98, 1.05), abs=0.02)


def test_the_track_stays_unknown_while_nothing_turns():
    found = calibrated(WRONG, 4, straight=True)
    assert found.sigmas[2] > 0.7 * PRIOR
    assert not found.is_certain


def test_matches_that_are_worse_than_thought_make_it_less_certain():
    good, bad = calibrated(WRONG, 5), calibrated(WRONG, 5, place=0.04, turn=0.02)
    assert np.all(bad.sigmas > good.sigmas)
    assert np.all(np.abs(np.array(bad.scales) - (1.03, 0.98, 1.05)) < 4 * bad.sigmas)
