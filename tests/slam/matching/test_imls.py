"""Sweeps matched to surfaces."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.slam.matching.walls import ALL_ROUND, CORRIDOR, HALF_ROUND, ROOM, off, seen
from uvf.maths.se2 import IDENTITY, Pose2
from uvf.slam.matching.cloud import cloud_of
from uvf.slam.matching.imls import honest, match
from uvf.slam.matching.point_map import point_map
from uvf.slam.reading import Beams, Reading

NO_PRIOR = np.zeros((3, 3))
CLOSE = st.tuples(st.floats(-0.15, 0.15), st.floats(-0.15, 0.15), st.floats(-0.1, 0.1)).map(lambda p: Pose2(*p))


def surfaces(walls, beams=ALL_ROUND, seed=10):
    """The walls as seen from the middle."""
    return point_map([cloud_of(seen(walls, beams=beams, rng=np.random.default_rng(seed)))])


def matched(walls, true, start, beams=ALL_ROUND, seed=11):
    cloud = cloud_of(seen(walls, true, beams, np.random.default_rng(seed)))
    return match(start, cloud, surfaces(walls, beams), NO_PRIOR)


@settings(max_examples=30, deadline=None, derandomize=True)
@given(CLOSE, st.integers(0, 99))
def test_a_displacement_in_a_room_is_found_to_a_few_millimetres(true, seed):
    found = matched(ROOM, true, IDENTITY, seed=seed)
    shift, turn = off(found.map_from_base, true)
    assert shift < 0.006
    assert turn < np.radians(0.15)
    assert found.share > 0.85
    assert found.rms < 0.025


def test_without_noise_hardly_an_error_is_left():
    true = Pose2(0.1, -0.05, 0.05)
    found = match(IDENTITY, cloud_of(seen(ROOM, true)), point_map([cloud_of(seen(ROOM))]), NO_PRIOR)
    shift, turn = off(found.map_from_base, true)
    assert shift < 0.002
    assert turn < np.radians(0.05)


def test_half_a_circle_of_beams_is_enough():
    true = Pose2(0.1, -0.05, 0.05)
    shift, turn = off(matched(ROOM, true, IDENTITY, HALF_ROUND).map_from_base, true)
    assert shift < 0.008
    assert turn < np.radians(0.2)


def test_headings_are_matched_across_the_half_turn():
    true = Pose2(0.05, 0.02, -np.pi + 0.02)
    found = matched(ROOM, true, Pose2(0.0, 0.0, np.pi - 0.03))
    assert off(found.map_from_base, true)[1] < np.radians(0.15)
    assert -np.pi <= found.map_from_base.yaw <= np.pi


def test_along_a_bare_corridor_next_to_nothing_is_known_across_it_much():
    information = matched(CORRIDOR, IDENTITY, IDENTITY).information
    covariance = np.linalg.inv(information + 1e-3 * np.eye(3))
    assert np.sqrt(covariance[0, 0]) > 0.1
    assert np.sqrt(covariance[1, 1]) < 0.01
    assert np.sqrt(covariance[2, 2]) < 0.005


def test_in_a_room_both_axes_are_known():
    covariance = np.linalg.inv(matched(ROOM, IDENTITY, IDENTITY).information)
    assert (np.sqrt(np.diag(covariance)) < (0.01, 0.01, 0.005)).all()


def test_the_information_covers_the_errors():
    errors = []
    for seed in range(60):
        found = matched(ROOM, IDENTITY, IDENTITY, seed=100 + seed)
        e = np.array(found.map_from_base)
        errors.append(e @ found.information @ e)
    assert np.mean(errors) < 3.0


def test_along_a_corridor_the_prior_alone_decides():
    true, start = Pose2(0.2, 0.05, 0.02), Pose2(0.0, 0.0, 0.0)
    cloud = cloud_of(seen(CORRIDOR, true, rng=np.random.default_rng(5)))
    found = match(start, cloud, surfaces(CORRIDOR), np.diag((1e3, 1e3, 1e3)))
    assert abs(found.map_from_base.x) < 0.1
    assert found.map_from_base.y == pytest.approx(0.05, abs=0.006)
    assert found.map_from_base.yaw == pytest.approx(0.02, abs=0.003)


def test_a_strong_prior_holds_the_pose():
    found = match(IDENTITY, cloud_of(seen(ROOM, Pose2(0.1, 0.0, 0.0))), surfaces(ROOM), np.diag((1e9, 1e9, 1e9)))
    assert off(found.map_from_base, IDENTITY)[0] < 0.001


@pytest.mark.parametrize("thickness", [0.06, 0.1, 0.15])
def test_the_two_faces_of_a_thin_wall_are_not_confused(thickness):
    """Only one face is in the map; from the other side nothing fits it, however near it is."""
    wall = np.array(((-4.0, 1.0, 4.0, 1.0),))
    behind = wall + np.array((0.0, thickness, 0.0, thickness))
    known = point_map([cloud_of(seen(wall))])
    found = match(IDENTITY, cloud_of(seen(behind, Pose2(0.0, 2.5, 0.0))).moved(Pose2(0.0, 2.5, 0.0)), known, NO_PRIOR)
    assert found.share < 0.05


def test_nothing_fits_an_empty_map_and_the_pose_stays():
    found = match(Pose2(1.0, 2.0, 0.3), cloud_of(seen(ROOM)), point_map([]), np.eye(3))
    assert found.share == 0.0
    assert off(found.map_from_base, (1.0, 2.0, 0.3))[0] < 1e-6
    assert np.abs(found.information).max() == 0.0


def test_a_sweep_without_returns_tells_nothing():
    none = cloud_of(Reading(0.0, np.full(360, np.nan), ALL_ROUND, IDENTITY))
    found = match(Pose2(1.0, 2.0, 0.3), none, surfaces(ROOM), np.eye(3))
    assert found.share == 0.0
    assert off(found.map_from_base, (1.0, 2.0, 0.3))[0] < 1e-6


def test_people_in_the_way_do_not_move_the_match():
    true = Pose2(0.05, 0.05, 0.03)
    reading = seen(ROOM, true, rng=np.random.default_rng(7))
    ranges = reading.ranges.copy()
    for first in (20, 130, 250):
        ranges[first : first + 15] = 1.0 + 0.02 * np.cos(np.linspace(0.0, np.pi, 15))
    found = match(IDENTITY, cloud_of(Reading(0.0, ranges, ALL_ROUND, IDENTITY)), surfaces(ROOM), NO_PRIOR)
    shift, turn = off(found.map_from_base, true)
    assert shift < 0.01
    assert turn < np.radians(0.2)


@settings(max_examples=50, deadline=None, derandomize=True)
@given(st.lists(st.floats(-50.0, 50.0), min_size=9, max_size=9))
def test_honest_information_is_never_more_and_still_a_covariances_inverse(numbers):
    factor = np.array(numbers).reshape(3, 3)
    h = factor @ factor.T
    less = honest(h)
    scale = 1e-9 * max(np.trace(h), 1.0)
    assert np.linalg.eigvalsh(less).min() > -scale
    assert np.trace(less) <= np.trace(h) + scale


def test_honest_information_of_a_room_is_nearly_all_of_it():
    h = np.diag((80.0, 70.0, 500.0))
    assert np.diag(honest(h)) == pytest.approx(np.diag(h), rel=0.05)


def test_the_mount_of_the_lidar_does_not_matter():
    beams = Beams((0.3, -0.2), np.radians(np.arange(180.0, -180.0, -1.0) + 70.0), 0.1, 30.0)
    true = Pose2(0.1, -0.05, 0.08)
    shift, turn = off(matched(ROOM, true, IDENTITY, beams).map_from_base, true)
    assert shift < 0.006
    assert turn < np.radians(0.15)
