"""Camera pictures as arrays, and their pixels as rays."""

import io
from collections.abc import Sequence
from math import isfinite

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from schemas.messages import CameraCalibration, CompressedImage
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]


def decoded(picture: CompressedImage, info: CameraCalibration, formats: Sequence[str], what: str) -> Image.Image:
    """A compressed picture of the camera that ``info`` tells of, all of it read; ``what`` it is called in errors.

    Raises BadInput for one that is no picture of this camera.
    """
    try:
        opened = Image.open(io.BytesIO(picture.data), formats=tuple(formats))
        if (opened.height, opened.width) != (info.height, info.width):
            own, told = f"{opened.width} x {opened.height}", f"{info.width} x {info.height}"
            raise BadInput(f"{picture.frame_id}: a {what} of {own}, but its camera has {told}")
        opened.load()
    except (UnidentifiedImageError, Image.DecompressionBombError, OSError, SyntaxError, ValueError) as error:
        raise BadInput(f"{picture.frame_id}: a {what} that cannot be read as {' or '.join(formats)}: {error}") from None
    return opened


def rgb_picture(picture: CompressedImage, info: CameraCalibration) -> NDArray[np.uint8]:
    """The picture (height, width, 3) RGB of the camera that ``info`` tells of. Raises BadInput for one that is no picture of it."""
    return np.asarray(decoded(picture, info, ("JPEG", "PNG"), "picture").convert("RGB"))


def intrinsics_of(info: CameraCalibration) -> tuple[float, ...]:
    """K, nine numbers row by row [pixels]. Raises BadInput for intrinsics that are none."""
    k = tuple(float(value) for value in info.K)
    if len(k) != 9 or not all(map(isfinite, k)) or not (k[0] > 0.0 and k[4] > 0.0):
        raise BadInput(f"{info.frame_id}: a camera's K must hold nine numbers, the focal lengths above zero")
    return k


class PinholeRays:
    """Rays of a camera without distortion, optical frame: x right, y down, z along the view."""

    def __init__(self, info: CameraCalibration) -> None:
        """Raises BadInput for intrinsics that are none."""
        self._k = intrinsics_of(info)
        self.focal = self._k[4]
        """Focal length across rows [pixels]."""

    def at(self, column: float, row: float) -> Floats:
        """Unit vector (3,) along which a pixel looks; pixel (0, 0) is the centre of the first one."""
        k = self._k
        ray = np.array(((column - k[2]) / k[0], (row - k[5]) / k[4], 1.0))
        found: Floats = ray / np.linalg.norm(ray)
        return found
