"""Camera pictures as arrays, and their pixels as rays."""

import io

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from schemas.messages import CameraCalibration, CompressedImage
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]


def rgb_picture(picture: CompressedImage, info: CameraCalibration) -> NDArray[np.uint8]:
    """The picture (height, width, 3) RGB of the camera that ``info`` tells of. Raises BadInput for one that is no picture of it."""
    try:
        opened = Image.open(io.BytesIO(picture.data), formats=("JPEG", "PNG"))
        if (opened.height, opened.width) != (info.height, info.width):
            own, told = f"{opened.width} x {opened.height}", f"{info.width} x {info.height}"
            raise BadInput(f"{picture.frame_id}: a picture of {own}, but its camera has {told}")
        return np.asarray(opened.convert("RGB"))
    except (UnidentifiedImageError, Image.DecompressionBombError, OSError, SyntaxError, ValueError) as error:
        raise BadInput(f"{picture.frame_id}: a picture that cannot be read as JPEG or PNG: {error}") from None


class PinholeRays:
    """Rays of a camera without distortion, optical frame: x right, y down, z along the view."""

    def __init__(self, info: CameraCalibration) -> None:
        """Raises BadInput for intrinsics that are none."""
        k = info.K
        if len(k) != 9 or not all(np.isfinite(k)) or not (k[0] > 0.0 and k[4] > 0.0):
            raise BadInput(f"{info.frame_id}: a camera's K must hold nine numbers, the focal lengths above zero")
        self.focal = float(k[4])
        """Focal length across rows [pixels]."""
        self._k = tuple(float(value) for value in k)

    def at(self, column: float, row: float) -> Floats:
        """Unit vector (3,) along which a pixel looks; pixel (0, 0) is the centre of the first one."""
        k = self._k
        ray = np.array(((column - k[2]) / k[0], (row - k[5]) / k[4], 1.0))
        found: Floats = ray / np.linalg.norm(ray)
        return found
