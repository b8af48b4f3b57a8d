"""Pictures and camera data as messages."""

import io

import numpy as np
from google.protobuf.timestamp_pb2 import Timestamp
from numpy.typing import NDArray
from PIL import Image

from schemas.convert import stamp
from schemas.messages import CameraCalibration, CompressedImage
from services.sim_camera.optics import intrinsics
from uvf.runtime.vehicle_file import Camera

JPEG_QUALITY = 70


def image_message(taken: Timestamp, frame: str, picture: NDArray[np.uint8]) -> CompressedImage:
    """picture: (height, width, 3) RGB."""
    stream = io.BytesIO()
    Image.fromarray(picture).save(stream, format="JPEG", quality=JPEG_QUALITY)
    return CompressedImage(timestamp=taken, frame_id=frame, data=stream.getvalue(), format="jpeg")


def info_message(t: float, frame: str, camera: Camera) -> CameraCalibration:
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
