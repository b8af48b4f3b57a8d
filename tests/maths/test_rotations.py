"""Rotations obey the group axioms and agree with each other."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from uvf.maths import rotations as r

ANGLE = st.floats(-3.1, 3.1)
PITCH = st.floats(-1.5, 1.5)


@given(ANGLE, PITCH, ANGLE)
def test_euler_angles_survive_the_round_trip(roll, pitch, yaw):
    np.testing.assert_allclose(r.to_euler(r.from_euler(roll, pitch, yaw)), (roll, pitch, yaw), atol=1e-9)


@given(ANGLE, PITCH, ANGLE)
def test_quaternion_and_matrix_are_the_same_rotation(roll, pitch, yaw):
    q = r.from_euler(roll, pitch, yaw)
    back = r.from_matrix(r.matrix(q))
    assert abs(back @ q) == pytest.approx(1, abs=1e-9)


@given(ANGLE, ANGLE, ANGLE)
def test_many_matrices_are_those_of_one_each(roll, pitch, yaw):
    attitudes = np.array([r.from_euler(roll, pitch, yaw), r.from_euler(yaw, roll / 3, pitch)])
    np.testing.assert_allclose(r.matrices(attitudes), [r.matrix(q) for q in attitudes], atol=1e-12)


@given(ANGLE, ANGLE, ANGLE, ANGLE)
def test_product_is_composition(a, b, c, d):
    p, q = r.from_euler(a, b / 3, c), r.from_euler(d, a / 3, b)
    np.testing.assert_allclose(r.matrix(r.multiply(p, q)), r.matrix(p) @ r.matrix(q), atol=1e-12)
    np.testing.assert_allclose(r.multiply(p, r.inverse(p)), r.IDENTITY, atol=1e-12)


@settings(deadline=None)
@given(ANGLE, ANGLE, PITCH, PITCH)
def test_a_turn_about_an_axis_is_the_exponential_of_its_cross_product(angle, x, y, z):
    axis = np.array((x, y, z + 4)) / np.linalg.norm((x, y, z + 4))
    cross = np.array(((0, -axis[2], axis[1]), (axis[2], 0, -axis[0]), (-axis[1], axis[0], 0)))
    np.testing.assert_allclose(r.matrix(r.from_axis(axis, angle)), expm(angle * cross), atol=1e-12)


@given(st.floats(-100, 100))
def test_wrapped_angles_point_the_same_way(angle):
    wrapped = r.wrap(angle)
    assert -np.pi <= wrapped <= np.pi
    assert np.cos(wrapped - angle) == pytest.approx(1)


def test_an_aircraft_heading_north_points_along_y_in_enu():
    ned_from_frd = r.from_euler(0.1, 0.2, 0.0)
    enu_from_flu = r.enu_flu_from_ned_frd(ned_from_frd)
    nose = r.rotate(enu_from_flu, np.array((1.0, 0, 0)))
    np.testing.assert_allclose(nose, (0, np.cos(0.2), np.sin(0.2)), atol=1e-12)
    np.testing.assert_allclose(r.enu_flu_from_ned_frd(enu_from_flu), ned_from_frd, atol=1e-12)
