"""The pinhole camera: fields of view, intrinsics, and where a point appears in the picture."""

import numpy as np
from numpy.typing import NDArray

from uvf.runtime.vehicle_file import Camera

Floats = NDArray[np.float64]


def vertical_fov(camera: Camera) -> float:
    """rad; pixels are square."""
    return float(2 * np.arctan(np.tan(camera.fov / 2) * camera.height / camera.width))


def intrinsics(camera: Camera) -> Floats:
    """(3, 3) K of the optical frame (x right, y down, z along the view); pixel (0, 0) is the centre of the first pixel."""
    f = camera.width / 2 / np.tan(camera.fov / 2)
    return np.array(((f, 0.0, (camera.width - 1) / 2), (0.0, f, (camera.height - 1) / 2), (0.0, 0.0, 1.0)))


def project(k: Floats, point: Floats) -> tuple[float, float]:
    """(column, row) of a point before the camera, (3,) m in the optical frame."""
    u, v, w = k @ point
    return float(u / w), float(v / w)
