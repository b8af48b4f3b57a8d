"""The search of a window against trying everything."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.slam.matching.walls import ROOM, off, seen
from uvf.maths.se2 import IDENTITY, Pose2, transform
from uvf.slam.matching import branch_and_bound
from uvf.slam.matching.branch_and_bound import Window, search
from uvf.slam.matching.cloud import cloud_of
from uvf.slam.matching.likelihood import FULL, likelihood_field

RESOLUTION, SIGMA = 0.1, 0.15


def everything(points, field, window):
    """The best sum of likelihoods over every heading and cell of the window, by plain indexing."""
    turns = np.linspace(-window.turn, window.turn, 2 * int(window.turn / branch_and_bound._turn_step(points, SIGMA)) + 1)
    side = int(np.ceil(window.side / RESOLUTION))
    shape = np.array(field.levels[0].shape)
    best = 0
    for turn in turns:
        pose = Pose2(window.centre.x, window.centre.y, window.centre.yaw + turn)
        cells = np.floor((transform(pose, points) - field.corner) / RESOLUTION).astype(int)
        for a in range(-side, side + 1):
            for b in range(-side, side + 1):
                at = cells + np.array((a, b))
                at = at[((at >= 0) & (at < shape)).all(axis=1)]
                best = max(best, int(field.levels[0][at[:, 0], at[:, 1]].astype(int).sum()))
    return best


POINTS = st.lists(st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)), min_size=3, max_size=12).map(np.array)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(POINTS, POINTS, st.integers(1, 4), st.floats(0.05, 1.2), st.floats(0.0, 0.05))
def test_finds_the_best_of_all_poses(mapped, looked_for, depth, side, turn):
    field = likelihood_field(mapped, RESOLUTION, SIGMA, depth)
    window = Window(Pose2(0.2, -0.3, 0.4), side, turn)
    best = everything(looked_for, field, window)
    found = search(looked_for, field, window, 0.0)
    if best == 0:
        assert found is None
    else:
        assert found.score * FULL * len(looked_for) == pytest.approx(best)


@settings(max_examples=30, deadline=None, derandomize=True)
@given(POINTS, st.integers(1, 3))
def test_finds_nothing_where_the_best_is_too_bad(points, depth):
    field = likelihood_field(points + np.array((0.4, 0.1)), RESOLUTION, SIGMA, depth)
    window = Window(IDENTITY, 0.6, 0.02)
    best = everything(points, field, window) / (FULL * len(points))
    assert search(points, field, window, best + 0.01) is None
    assert search(points, field, window, best - 0.01).score == pytest.approx(best)


@settings(max_examples=30, deadline=None, derandomize=True)
@given(POINTS, st.integers(1, 4))
def test_every_bound_is_the_most_of_its_square(points, depth):
    levels = likelihood_field(points, RESOLUTION, SIGMA, depth).levels
    for level in range(1, depth + 1):
        step = 1 << level
        padded = np.pad(levels[0], ((0, step), (0, step)))
        squares = np.lib.stride_tricks.sliding_window_view(padded, (step, step))[: levels.shape[1], : levels.shape[2]]
        np.testing.assert_array_equal(levels[level], squares.max(axis=(2, 3)))


def test_the_field_is_a_bell_around_each_point():
    field = likelihood_field(np.array(((1.0, 2.0), (4.0, 2.0))), 0.05, 0.2, 3)
    at = np.array(((1.0, 2.0), (1.2, 2.0), (1.4, 2.0), (2.5, 2.0)))
    i, j = np.floor((at - field.corner) / 0.05).astype(int).T
    assert field.levels[0][i, j] / FULL == pytest.approx([1.0, np.exp(-0.5), np.exp(-2.0), 0.0], abs=0.15)


@pytest.mark.parametrize("true", [Pose2(1.4, -0.9, 0.4), Pose2(-1.2, 0.8, -0.45), Pose2(0.0, 0.0, 0.0)])
def test_a_place_in_a_room_is_found_from_far_off(true):
    field = likelihood_field(cloud_of(seen(ROOM)).points, 0.05, 0.08, 4)
    found = search(cloud_of(seen(ROOM, true)).points, field, Window(IDENTITY, 1.5, 0.5), 0.3)
    shift, turn = off(found.pose, true)
    assert shift < 0.08
    assert turn < 0.03


def test_points_beside_the_field_are_no_harm():
    field = likelihood_field(np.array(((0.0, 0.0),)), RESOLUTION, SIGMA, 3)
    assert search(np.array(((1e4, -1e4), (-1e4, 1e4))), field, Window(IDENTITY, 1.0, 0.1), 0.1) is None


def test_no_points_are_found_nowhere():
    assert search(np.zeros((0, 2)), likelihood_field(np.zeros((1, 2)), 0.1, 0.1, 2), Window(IDENTITY, 1.0, 0.1), 0.1) is None
