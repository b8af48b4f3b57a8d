"""Pictures and camera data as messages."""

import io

import numpy as np
from google.protobuf.timestamp_pb2 import Timestamp
from numpy.typing import NDArray
from PIL import Image

from schemas.messages import CameraCalibration, CompressedImage, JointState, JointStates
from services.sim_camera.gimbal import Joints
from services.sim_camera.optics import intrinsics
from uvf.models.vehicle.sensors import Camera
from uvf.runtime.messages.convert import stamp

JPEG_QUALITY = 70
MILLIMETRES = 1000.0
DEEPEST = np.iinfo(np.uint16).max / MILLIMETRES  # m


def image_message(taken: Timestamp, frame: str, picture: NDArray[np.uint8]) -> CompressedImage:
    """The picture (height, width, 3) RGB as a JPEG message."""
    stream = io.BytesIO()
    Image.fromarray(picture).save(stream, format="JPEG", quality=JPEG_QUALITY)
    return CompressedImage(timestamp=taken, frame_id=frame, data=stream.getvalue(), format="jpeg")


def depth_message(taken: Timestamp, frame: str, depth: NDArray[np.float64]) -> CompressedImage:
    """The depth (height, width) [m] along the view as a PNG in mm, 0 where there is nothing within 65.535 m (16UC1 of REP-118)."""
    millimetres = np.where((depth > 0) & (depth <= DEEPEST), np.round(depth * MILLIMETRES), 0.0).astype(np.uint16)
    stream = io.BytesIO()
    Image.fromarray(millimetres).save(stream, format="PNG", compress_level=1)
    return CompressedImage(timestamp=taken, frame_id=frame, data=stream.getvalue(), format="png")


def info_message(t: float, frame: str, camera: Camera) -> CameraCalibration:
    """The camera's intrinsics [pixels] as a message stamped ``t`` [s]."""
    k = intrinsics(camera)
    return CameraCalibration(
        timestamp=stamp(t),
        frame_id=frame,
        width=camera.width,
        height=camera.height,
        distortion_model="plumb_bob",
        D=[0.0] * 5,
        K=k.ravel().tolist(),
        R=np.eye(3).ravel().tolist(),
        P=np.column_stack((k, np.zeros(3))).ravel().tolist(),
    )


def joints_message(taken: Timestamp, joints: Joints) -> JointStates:
    """The gimbal's joint angles [rad] as a message."""
    return JointStates(timestamp=taken, joints=[JointState(name=name, position=angle) for name, angle in joints._asdict().items()])
