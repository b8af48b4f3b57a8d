"""Graph SLAM driven through made-up buildings, against the truth."""

import numpy as np
import pytest

from benchmarks.slam.evaluation.building import corridors
from benchmarks.slam.evaluation.driven import Wear, drive, route
from tests.slam.graph.buildings import BAD, HALF_ROUND, SHORT, bend, false_loops, mapped, rectangle, round_trip
from uvf.maths.se2_arrays import wrapped

SIZE = (40.0, 20.0)


@pytest.fixture(scope="module", params=[HALF_ROUND, SHORT], ids=["half round", "short"])
def rounded(request):
    driven = round_trip(SIZE, request.param)
    return driven, mapped(driven)


def test_a_round_of_corridors_closes(rounded):
    driven, found = rounded
    assert np.hypot(*(driven.log.odom_from_base - driven.map_from_base)[:, :2].T).max() > 2.0
    assert found.slam.closing.loops >= 3
    assert np.hypot(*found.final[-1, :2]) < 0.08
    assert found.far_off < 0.3
    assert found.turned_off < np.radians(0.6)
    assert false_loops(found, driven) == 0


def test_what_was_said_at_the_time_was_near_the_truth_too(rounded):
    assert np.hypot(*rounded[1].online[:, :2].T).max() < 0.6


def test_bad_odometry_closes_all_the_same():
    driven = round_trip(SIZE, wear=BAD, seed=2)
    found = mapped(driven)
    assert np.hypot(*(driven.log.odom_from_base - driven.map_from_base)[:, :2].T).max() > 10.0
    assert np.hypot(*found.final[-1, :2]) < 0.15
    assert found.far_off < 0.5


def normalised(found, driven):
    """(n,) squared errors of the online poses in units of their covariances."""
    errors = found.run.online - driven.map_from_base
    errors[:, 2] = wrapped(errors[:, 2])
    covariances = found.run.covariances + 1e-9 * np.eye(3)
    return np.einsum("ni,ni->n", errors, np.linalg.solve(covariances, errors[..., None])[..., 0])


def test_covariance_covers_the_errors():
    """Three is the mean of honest ones; cautious ones have less."""
    means = []
    for seed in (1, 2, 3):
        driven = bend(seed=seed, readings=200)
        found = mapped(driven)
        means.append(normalised(found, driven)[5:].mean())
        assert (np.linalg.eigvalsh(found.run.covariances) > -1e-12).all()
    assert np.mean(means) < 4.0


def test_covariance_covers_the_errors_of_a_whole_round(rounded):
    driven, found = rounded
    assert normalised(found, driven).mean() < 4.0


def test_covariance_grows_without_loops_and_shrinks_with_one(rounded):
    _, found = rounded
    sigma = np.sqrt(np.trace(found.run.covariances[:, :2, :2], axis1=1, axis2=2))
    quarters = sigma[[50, 250, 500, 750]]
    assert (np.diff(quarters) > 0.0).all()
    assert sigma[-1] < 0.5 * sigma.max()


TWIN = np.concatenate((rectangle(16.0, 12.0), rectangle(16.0, 12.0) + np.array((40.0, 0.0, 40.0, 0.0))))


def test_twin_buildings_are_not_taken_for_one():
    """The same building stands twice, a corridor joins both: all that is seen in the second one fits the first."""
    first = corridors(TWIN[:4], np.random.default_rng(7))
    walls = np.concatenate((first, first + np.array((40.0, 0.0, 40.0, 0.0))))
    doorway = (np.abs(walls[:, 1::2]) < 1.19).all(axis=1) & (walls[:, ::2] > 16.0).all(axis=1) & (walls[:, ::2] < 40.0).all(axis=1)
    join = np.array(((17.2, 1.2, 38.8, 1.2), (17.2, -1.2, 25.0, -1.2), (25.0, -1.2, 25.0, -1.6), (25.0, -1.6, 38.8, -1.6)))
    corners = ((0, 0), (16, 0), (16, 12), (0, 12), (0, 0), (16, 0), (40, 0), (56, 0), (56, 12), (40, 12), (40, 0))
    driven = drive(route(np.array(corners, dtype=float)), np.concatenate((walls[~doorway], join)), HALF_ROUND, Wear(), 5)
    found = mapped(driven)
    assert false_loops(found, driven) == 0
    assert found.far_off < 1.0


def test_the_same_log_gives_the_same_poses():
    driven = bend(readings=100)
    np.testing.assert_array_equal(mapped(driven).run.final, mapped(driven).run.final)
