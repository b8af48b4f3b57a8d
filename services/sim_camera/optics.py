"""The pinhole camera: intrinsics, the renderer's frustum, and where a point appears in the picture."""

import numpy as np
from numpy.typing import NDArray

from uvf.models.vehicle.sensors import Camera

Floats = NDArray[np.float64]


def intrinsics(camera: Camera) -> Floats:
    """Intrinsic matrix K (3, 3) [pixels] of the optical frame (x right, y down, z along the view).

    Pixel (0, 0) is the centre of the first pixel.
    """
    f = camera.width / 2 / np.tan(camera.fov / 2)
    return np.array(((f, 0.0, (camera.width - 1) / 2), (0.0, f, (camera.height - 1) / 2), (0.0, 0.0, 1.0)))


def frustum(camera: Camera, near: float) -> tuple[float, float, float, float]:
    """left, right, bottom, top [m] of the picture on the plane at ``near`` for a renderer that samples the lower left corner
    of each pixel: moved by half a pixel, so that it samples where the intrinsics say that the pixel is."""
    pixel = near / intrinsics(camera)[0, 0]
    left, top = (0.5 - camera.width / 2) * pixel, (0.5 + camera.height / 2) * pixel
    return left, left + camera.width * pixel, top - camera.height * pixel, top


def project(k: Floats, point: Floats) -> tuple[float, float]:
    """Pixel (column, row) [pixels] of a ``point`` (3,) [m] in the optical frame, before a camera with intrinsics ``k`` (3, 3)."""
    u, v, w = k @ point
    return float(u / w), float(v / w)
