"""Depth pictures as rays of the camera and how far along each one something was seen."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from schemas.messages import CameraCalibration, CompressedImage
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.readings.pictures import decoded, intrinsics_of

Floats = NDArray[np.float64]

MILLIMETRES = 1000.0


def depth_rays(picture: CompressedImage, info: CameraCalibration) -> tuple[Floats, Floats]:
    """Rays (n, 3), 1 m along the view, in the optical frame (x right, y down), row by row, and depths (n,) [m], 0 = no return.

    picture: 16-bit PNG of mm along the view. Raises BadInput.
    """
    depths = _depths(picture, info).ravel() / MILLIMETRES
    return _rays(info.width, info.height, intrinsics_of(info)), depths


def _depths(picture: CompressedImage, info: CameraCalibration) -> NDArray[np.uint16]:
    """(height, width) mm."""
    opened = decoded(picture, info, ("PNG",), "depth picture")
    depths = np.asarray(opened)
    if depths.ndim != 2 or not np.issubdtype(depths.dtype, np.integer) or depths.dtype == np.uint8:
        raise BadInput(f"{picture.frame_id}: a depth picture must be grey with 16 bits; this one is {opened.mode}")
    return depths.astype(np.uint16)


@lru_cache(maxsize=8)
def _rays(width: int, height: int, k: tuple[float, ...]) -> Floats:
    """(height * width, 3) the ways along which the pixels look."""
    rows, columns = np.mgrid[:height, :width]
    rays: Floats = np.stack(((columns - k[2]) / k[0], (rows - k[5]) / k[4], np.ones((height, width))), axis=2).reshape(-1, 3)
    return rays
