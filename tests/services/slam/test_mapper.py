"""Mapping on a drifting odometry: the correction follows the drift; what is published never jumps."""

import numpy as np
import pytest

from services.slam.mapper import Mapper, Scan, toward
from tests.services.slam.room import measured, points
from uvf.maths.planar import IDENTITY, compose
from uvf.maths.rotations import wrap

NOWHERE = np.zeros((0, 2))


def circle(i):
    """A round through the room's middle, starting at the origin."""
    angle = 0.05 * i
    return (0.5 * np.sin(angle), 0.5 * (1 - np.cos(angle)), wrap(angle))


def test_a_drifting_odometry_is_corrected():
    rng = np.random.default_rng(5)
    mapper = Mapper(0.05, 0.1, 0.1)
    for i in range(250):
        true = circle(i)
        odometry = (1.03 * true[0] + 0.0005 * i, true[1], wrap(true[2] + 0.001 * i))
        mapper.add(odometry, Scan(points(measured(true, rng)), NOWHERE, (0.0, 0.0)))
    assert np.hypot(odometry[0] - true[0], odometry[1] - true[1]) > 0.1
    found = compose(mapper.map_from_odom, odometry)
    assert np.hypot(found[0] - true[0], found[1] - true[1]) < 0.02
    assert abs(wrap(found[2] - true[2])) < 0.01


def test_a_jump_of_the_odometry_is_found_again():
    mapper = Mapper(0.05, 0.1, 0.1)
    for i in range(20):
        mapper.add(circle(i), Scan(points(measured(circle(i))), NOWHERE, (0.0, 0.0)))
    true = circle(20)
    slipped = compose(true, (0.22, 0.12, 0.24))
    mapper.add(slipped, Scan(points(measured(true)), NOWHERE, (0.0, 0.0)))
    assert compose(mapper.map_from_odom, slipped) == pytest.approx(true, abs=0.02)


def test_the_map_grows_only_when_the_vehicle_has_moved():
    mapper = Mapper(0.05, 0.1, 0.1)
    scan = Scan(points(measured(IDENTITY)), NOWHERE, (0.0, 0.0))
    assert mapper.add(IDENTITY, scan)
    assert not mapper.add(IDENTITY, scan)
    assert mapper.add((0.0, 0.0, 0.2), Scan(points(measured((0.0, 0.0, 0.2))), NOWHERE, (0.0, 0.0)))


def test_a_blind_scan_changes_nothing():
    mapper = Mapper(0.05, 0.1, 0.1)
    mapper.add(IDENTITY, Scan(points(measured(IDENTITY)), NOWHERE, (0.0, 0.0)))
    mapper.add((0.02, 0.0, 0.0), Scan(NOWHERE, NOWHERE, (0.0, 0.0)))
    assert mapper.map_from_odom == IDENTITY


def test_a_correction_is_spread_over_time():
    pose, target = IDENTITY, (0.1, 0.0, 0.02)
    steps = 0
    while pose != pytest.approx(target):
        last, pose = pose, toward(pose, target, 0.01, 0.01)
        assert np.hypot(pose[0] - last[0], pose[1] - last[1]) <= 0.01 + 1e-12
        steps += 1
    assert steps == 10
