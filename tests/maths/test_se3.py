"""Rigid transforms against homogeneous matrices, and interpolation against scipy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from uvf.maths import se2 as plane
from uvf.maths.rotations import from_euler
from uvf.maths.se3 import IDENTITY, Transform, apply, compose, homogeneous, interpolate, inverse, planar, slerp

metres = st.floats(-50, 50)
angles = st.floats(-np.pi, np.pi)
transforms = st.builds(
    lambda rpy, xyz: Transform(from_euler(*rpy), np.array(xyz)), st.tuples(angles, angles, angles), st.tuples(metres, metres, metres)
)
checked = settings(max_examples=100, deadline=None, derandomize=True)


def scipy_of(q):
    return Rotation.from_quat(q[[1, 2, 3, 0]])


@checked
@given(transforms, transforms)
def test_composing_is_multiplying_matrices(a, b):
    assert homogeneous(compose(a, b)) == pytest.approx(homogeneous(a) @ homogeneous(b), abs=1e-10)


@checked
@given(transforms)
def test_the_inverse_is_the_inverse_matrix(a):
    assert homogeneous(inverse(a)) == pytest.approx(np.linalg.inv(homogeneous(a)), abs=1e-10)


@checked
@given(transforms, st.lists(st.tuples(metres, metres, metres), min_size=1, max_size=4))
def test_points_move_as_the_matrix_moves_them(a, points):
    points = np.array(points)
    by_matrix = (homogeneous(a) @ np.column_stack((points, np.ones(len(points)))).T).T[:, :3]
    assert apply(a, points) == pytest.approx(by_matrix, abs=1e-10)


@checked
@given(transforms, transforms, st.floats(0, 1))
def test_between_two_the_rotation_is_scipys_slerp_and_the_translation_a_straight_line(p, q, fraction):
    between = interpolate(p, q, fraction)
    if abs(p.rotation @ q.rotation) > 1e-3:  # half a turn apart, both ways round are the shorter one
        expected = Slerp([0, 1], Rotation.concatenate([scipy_of(p.rotation), scipy_of(q.rotation)]))(fraction)
        assert (scipy_of(between.rotation) * expected.inv()).magnitude() < 1e-6
    assert between.translation == pytest.approx((1 - fraction) * p.translation + fraction * q.translation, abs=1e-10)


@pytest.mark.parametrize("turn", [1e-9, 1e-3, 0.05, 0.0633, 3.1])
def test_half_way_is_half_the_turn_however_small(turn):
    half = slerp(from_euler(0, 0, 0), -from_euler(0, 0, turn), 0.5)
    assert half == pytest.approx(from_euler(0, 0, turn / 2), abs=1e-12)


@checked
@given(metres, metres, angles, metres, metres, angles)
def test_on_level_ground_it_is_the_motion_in_the_plane(x, y, yaw, u, v, turn):
    a, b = (Transform(from_euler(0, 0, angle), np.array((p, q, 0.0))) for p, q, angle in ((x, y, yaw), (u, v, turn)))
    expected = plane.compose(plane.Pose2(x, y, yaw), plane.Pose2(u, v, turn))
    found = planar(compose(a, b))
    assert found[:2] == pytest.approx(expected[:2], abs=1e-9)
    assert np.exp(1j * found.yaw) == pytest.approx(np.exp(1j * expected.yaw))


def test_the_identity_changes_nothing():
    a = Transform(from_euler(0.1, 0.2, 0.3), np.array((1.0, 2.0, 3.0)))
    for same in (compose(a, IDENTITY), compose(IDENTITY, a), interpolate(a, a, 0.3)):
        assert homogeneous(same) == pytest.approx(homogeneous(a), abs=1e-12)
