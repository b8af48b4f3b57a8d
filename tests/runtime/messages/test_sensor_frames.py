"""The frames of a vehicle's sensors, and which way a picture's axes point."""

import numpy as np
import pytest

from uvf.maths.rotations import rotate
from uvf.models.vehicle.sensors import Camera, ImuSensor, Mount, Sensors
from uvf.runtime.messages.convert import array, wxyz
from uvf.runtime.messages.sensor_frames import sensor_frames

CAMERA = Camera(mount=Mount((0.4, 0.0, -0.1), (0.0, 0.5, 0.0)), hz=5.0, width=32, height=24, fov=1.0)


def frames_of(**sensors):
    return {f.child_frame_id: f for f in sensor_frames("v", Sensors(**sensors), 2.0).transforms}


def test_only_what_is_fitted_has_a_frame():
    assert set(frames_of(imu=ImuSensor(mount=Mount(), hz=100.0))) == {"v/imu"}


def test_a_mount_is_told_as_it_is_written():
    frame = frames_of(camera=CAMERA)["v/camera"]
    assert frame.parent_frame_id == "v/base_link"
    assert array(frame.translation) == pytest.approx((0.4, 0.0, -0.1))


def test_a_camera_pitched_down_looks_forward_and_down():
    forward = rotate(wxyz(frames_of(camera=CAMERA)["v/camera"].rotation), np.array((1.0, 0.0, 0.0)))
    assert forward == pytest.approx((np.cos(0.5), 0.0, -np.sin(0.5)))


@pytest.mark.parametrize(
    ("optical", "camera"),
    [((0, 0, 1), (1, 0, 0)), ((1, 0, 0), (0, -1, 0)), ((0, 1, 0), (0, 0, -1))],
    ids=["depth is ahead", "columns grow to the right", "rows grow downwards"],
)
def test_axes_of_the_picture(optical, camera):
    frame = frames_of(camera=CAMERA)["v/camera_optical"]
    assert frame.parent_frame_id == "v/camera"
    assert rotate(wxyz(frame.rotation), np.array(optical, dtype=float)) == pytest.approx(camera, abs=1e-12)
