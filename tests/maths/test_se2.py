"""Rigid motion in the plane: the axioms of a group, and poses by time."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvf.maths.se2 import IDENTITY, PoseHistory, compose, interpolate, inverse, transform

lengths = st.floats(-50, 50)
poses = st.tuples(lengths, lengths, st.floats(-3.1, 3.1))


@settings(deadline=None, derandomize=True)
@given(poses)
def test_a_pose_and_its_inverse_cancel(pose):
    assert compose(pose, inverse(pose)) == pytest.approx(IDENTITY, abs=1e-9)


@settings(deadline=None, derandomize=True)
@given(poses, poses)
def test_points_go_through_a_composition_as_through_both(a_from_b, b_from_c):
    points = np.array(((0.0, 0.0), (1.0, 2.0), (-3.0, 0.5)))
    once = transform(compose(a_from_b, b_from_c), points)
    np.testing.assert_allclose(once, transform(a_from_b, transform(b_from_c, points)), atol=1e-9)


def test_a_quarter_turn_carries_x_to_y():
    np.testing.assert_allclose(transform((1.0, 1.0, np.pi / 2), np.array(((2.0, 0.0),))), ((1.0, 3.0),), atol=1e-12)


def test_headings_are_interpolated_the_short_way_round():
    middle = interpolate((0.0, 0.0, 3.0), (2.0, 4.0, -3.1), 0.5)
    assert middle == pytest.approx((1.0, 2.0, (3.0 - 3.1 + 2 * np.pi) / 2), abs=1e-9)


def test_history_interpolates_between_poses():
    history = PoseHistory(10)
    history.add(1.0, (0.0, 0.0, 0.0))
    history.add(2.0, (4.0, 0.0, 1.0))
    assert history.at(1.25) == pytest.approx((1.0, 0.0, 0.25))
    assert history.at(2.0) == pytest.approx((4.0, 0.0, 1.0))


def test_history_does_not_guess_beyond_what_it_knows():
    history = PoseHistory(10)
    assert history.at(0.0) is None
    history.add(1.0, IDENTITY)
    assert history.at(0.9) is None
    assert history.at(1.1) is None
    assert history.at(1.0) == IDENTITY


def test_history_forgets_the_oldest():
    history = PoseHistory(3)
    for t in range(20):
        history.add(float(t), (float(t), 0.0, 0.0))
    assert history.at(1.0) is None
    assert history.at(18.5) == pytest.approx((18.5, 0.0, 0.0))
