"""Pictures and sweeps as beams in the sensor's frame: unit directions and how far each one saw."""

import io
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from schemas.messages import CameraCalibration, CompressedImage, LaserScan
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import scan_rays

Floats = NDArray[np.float64]

MILLIMETRES = 1000.0
BEYOND = 2.0
"""A beam without a return is taken to end at so many times the reach: it is free as far as there, and has met nothing."""


class RayBundle(NamedTuple):
    """Beams. ends: (n, 3) [m] in the sensor's frame; reach [m]: a beam that ends farther away has met nothing."""

    ends: Floats
    reach: float


def depth_beams(picture: CompressedImage, info: CameraCalibration, reach: float) -> RayBundle:
    """Beams (n, 3) [m] of a depth picture (16-bit PNG: mm along the view, 0 = no return), in the optical frame (x right, y down).

    reach: [m], not more than the camera's own. Raises BadInput.
    """
    depths = _depths(picture, (info.height, info.width)).ravel() / MILLIMETRES
    rays = _rays(info.width, info.height, tuple(info.K))
    ends = rays * depths[:, None]
    nothing = depths == 0.0
    ends[nothing] = rays[nothing] * (BEYOND * reach)
    return RayBundle(ends, reach)


def sweep_beams(scan: LaserScan, reach: float) -> RayBundle:
    """Beams (n, 3) [m] of a 2-D lidar, in its own frame; reach: [m], not more than the lidar's own."""
    ranges, rays = scan_rays(scan)
    lengths = np.where((ranges > 0.0) & (ranges <= reach), ranges, BEYOND * reach)
    return RayBundle(np.column_stack((rays * lengths[:, None], np.zeros(len(rays)))), reach)


def _depths(picture: CompressedImage, shape: tuple[int, int]) -> NDArray[np.uint16]:
    """(height, width) mm."""
    try:
        opened = Image.open(io.BytesIO(picture.data), formats=("PNG",))
        if (opened.height, opened.width) != shape:
            raise BadInput(
                f"{picture.frame_id}: a depth picture of {opened.width} x {opened.height}, but its camera has {shape[1]} x {shape[0]}"
            )
        depths = np.asarray(opened)
    except (UnidentifiedImageError, Image.DecompressionBombError, OSError, SyntaxError, ValueError) as error:
        raise BadInput(f"{picture.frame_id}: a depth picture that cannot be read as PNG: {error}") from None
    if depths.ndim != 2 or not np.issubdtype(depths.dtype, np.integer) or depths.dtype == np.uint8:
        raise BadInput(f"{picture.frame_id}: a depth picture must be grey with 16 bits; this one is {opened.mode}")
    return depths.astype(np.uint16)


@lru_cache(maxsize=8)
def _rays(width: int, height: int, k: tuple[float, ...]) -> Floats:
    """(height * width, 3) the ways along which the pixels look, 1 m along the view, row by row. Raises BadInput."""
    if len(k) != 9 or not (k[0] > 0.0 and k[4] > 0.0):
        raise BadInput("a camera's K must hold nine numbers, the focal lengths above zero")
    rows, columns = np.mgrid[:height, :width]
    rays: Floats = np.stack(((columns - k[2]) / k[0], (rows - k[5]) / k[4], np.ones((height, width))), axis=2).reshape(-1, 3)
    return rays
