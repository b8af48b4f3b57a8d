"""Points and normals of a sweep."""

from dataclasses import replace

import numpy as np
import pytest

from tests.slam.matching.walls import ALL_ROUND, CORRIDOR, HALF_ROUND, ROOM, seen
from uvf.maths.se2 import IDENTITY, Pose2
from uvf.slam.matching.cloud import ENOUGH, cloud_of, window_of
from uvf.slam.reading import Beams, Reading

MOUNTS = {
    "in the middle": ALL_ROUND,
    "clockwise": Beams((0.0, 0.0), np.radians(np.arange(180.0, -180.0, -1.0)), 0.1, 30.0),
    "ahead and turned": Beams((0.3, -0.1), np.radians(np.arange(-90.0, 91.0) + 140.0), 0.1, 30.0),
    "half a circle": HALF_ROUND,
    "sparse": Beams((0.0, 0.0), np.radians(np.arange(0.0, 360.0, 5.0)), 0.1, 30.0),
}


@pytest.mark.parametrize("beams", MOUNTS.values(), ids=MOUNTS)
def test_every_normal_is_a_unit_vector_towards_the_lidar(beams):
    cloud = cloud_of(seen(ROOM, beams=beams, rng=np.random.default_rng(1)))
    flat = cloud.flat
    assert flat.mean() > 0.7
    np.testing.assert_allclose(np.hypot(*cloud.normals[flat].T), 1.0)
    to_lidar = np.array(beams.origin) - cloud.points[flat]
    assert (np.einsum("ij,ij->i", cloud.normals[flat], to_lidar) > 0.0).all()


def test_points_lie_where_the_beams_ended():
    beams = MOUNTS["ahead and turned"]
    reading = seen(CORRIDOR, beams=beams)
    points = cloud_of(reading).points
    assert len(points) == reading.returned.sum()
    np.testing.assert_allclose(np.abs(points[:, 1]), 1.2, atol=1e-9)


def test_normals_of_a_wall_seen_at_a_glance_are_square_to_it():
    cloud = cloud_of(seen(CORRIDOR, rng=np.random.default_rng(2)))
    far = cloud.flat & (np.abs(cloud.points[:, 0]) > 4.0)
    assert far.sum() > 15
    tilt = np.arccos(np.abs(cloud.normals[far, 1]))
    assert np.quantile(tilt, 0.9) < np.radians(5.0)


def test_hardly_a_normal_lies_between_those_of_two_walls():
    """All walls of the room run along the axes; only right beside a corner a line fits both of its walls a little."""
    normals = np.abs(cloud_of(seen(ROOM)).normals)
    slanting = normals.max(axis=1) < np.cos(np.radians(10.0))
    assert slanting[cloud_of(seen(ROOM)).flat].mean() < 0.05


def test_leaves_that_nobody_could_fit_a_line_to_have_no_normal():
    rng = np.random.default_rng(3)
    cloud = cloud_of(Reading(0.0, rng.uniform(1.0, 4.0, 360), ALL_ROUND, IDENTITY))
    assert cloud.flat.mean() < 0.3
    assert (cloud.weights[~cloud.flat] < 0.5).all()


def test_what_did_not_come_back_is_no_point():
    ranges = np.full(360, 2.0)
    ranges[:8] = (np.nan, np.inf, -np.inf, -1.0, 0.0, 0.05, 30.0, 1e300)
    cloud = cloud_of(Reading(0.0, ranges, ALL_ROUND, IDENTITY))
    assert np.isfinite(cloud.points).all()
    assert np.hypot(*cloud.points.T) == pytest.approx(2.0)


def test_dense_sweeps_are_thinned_but_their_normals_are_of_all_beams():
    dense = Beams((0.0, 0.0), np.radians(np.arange(0.0, 360.0, 0.25)), 0.1, 30.0)
    cloud = cloud_of(seen(ROOM, beams=dense))
    assert ENOUGH / 2 < len(cloud.points) <= ENOUGH
    assert cloud.flat.mean() > 0.8


@pytest.mark.parametrize("n", [0, 1, 2, 3, 4])
def test_a_lidar_of_few_beams_gives_few_points(n):
    beams = Beams((0.0, 0.0), np.linspace(-0.5, 0.5, n), 0.1, 30.0)
    cloud = cloud_of(Reading(0.0, np.full(n, 2.0), beams, IDENTITY))
    assert cloud.points.shape == cloud.normals.shape == (n, 2)
    assert window_of(beams.bearings) >= 3


def test_moved_points_and_normals_turn_together():
    cloud = cloud_of(seen(ROOM))
    moved = cloud.moved(Pose2(1.0, 2.0, np.pi / 2))
    np.testing.assert_allclose(moved.points, np.column_stack((1.0 - cloud.points[:, 1], 2.0 + cloud.points[:, 0])), atol=1e-12)
    np.testing.assert_allclose(moved.normals, np.column_stack((-cloud.normals[:, 1], cloud.normals[:, 0])), atol=1e-12)
    np.testing.assert_array_equal(replace(moved).weights, cloud.weights)
