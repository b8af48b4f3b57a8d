"""The pinhole model against its definition."""

import numpy as np
import pytest

from services.sim_camera.optics import frustum, intrinsics, project
from uvf.models.vehicle.sensors import Camera, Mount

CAMERA = Camera(mount=Mount(), hz=5.0, width=160, height=120, fov=1.2)


def test_a_point_straight_ahead_is_in_the_middle_of_the_picture():
    assert project(intrinsics(CAMERA), np.array((0.0, 0.0, 3.0))) == pytest.approx((79.5, 59.5))


def test_the_field_of_view_ends_at_the_outer_edge_of_the_last_pixel():
    k = intrinsics(CAMERA)
    right, _ = project(k, np.array((np.tan(0.6), 0.0, 1.0)))
    _, bottom = project(k, np.array((0.0, np.tan(0.6) * 120 / 160, 1.0)))  # pixels are square
    assert (right, bottom) == pytest.approx((159.5, 119.5))


def test_the_frustum_puts_the_lower_left_corner_of_a_pixel_into_its_middle():
    left, right, bottom, top = frustum(CAMERA, 0.02)
    k = intrinsics(CAMERA)
    assert project(k, np.array((left, -top, 0.02))) == pytest.approx((0.0, -1.0), abs=1e-9)
    assert project(k, np.array((right, -bottom, 0.02))) == pytest.approx((160.0, 119.0))
