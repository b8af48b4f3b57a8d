"""Ground, coloured fields and sky behind all solids: each pixel's ray meets the plane z = 0 or the sky.

Drawn here because a plane that fills the picture is what the software renderer is slowest at.
"""

import numpy as np
from numpy.typing import NDArray

from services.sim_camera.optics import intrinsics
from uvf.maths.compiled import compiled
from uvf.models.vehicle.sensors import Camera
from uvf.models.world.file import WorldFile

Floats = NDArray[np.float64]
Picture = NDArray[np.uint8]

SKY = (155.0, 190.0, 225.0)
TILES = np.array(((0.5, 0.05), (20.0, 0.06)))
"""Checker patterns that make motion visible: side [m] and contrast; each fades where a pixel covers half a tile."""
HAZE = 2500.0  # m, distance at which the ground has lost 63 % of its colour


class Backdrop:
    """The background of one world (sky and ground) as seen from above z = 0."""

    def __init__(self, world: WorldFile) -> None:
        everywhere = (-np.inf, -np.inf, np.inf, np.inf)
        rows = [*((*field.area, *field.colour) for field in world.fields), (*everywhere, *world.ground_colour)]
        self._fields = np.array(rows, dtype=np.float64)
        """(n, 7): x_min, y_min, x_max, y_max [m], red, green, blue [0..1]; the last one is the open ground."""
        _paint(np.zeros((1, 1, 3), dtype=np.uint8), np.zeros(3), np.eye(3), self._fields)  # compiles it

    def paint(self, camera: Camera, eye: Floats, world_from_optical: Floats) -> Picture:
        """RGB image (height, width, 3). eye: (3,) [m, world]; world_from_optical: (3, 3), from x right, y down, z along the view."""
        rays = world_from_optical @ np.linalg.inv(intrinsics(camera))
        picture = np.empty((camera.height, camera.width, 3), dtype=np.uint8)
        _paint(picture, eye, rays, self._fields)
        return picture

    def depth(self, camera: Camera, eye: Floats, world_from_optical: Floats) -> Floats:
        """Depth (height, width) [m] of the ground along the view; inf in the sky. eye (3,) [m, world], world_from_optical (3, 3)."""
        down = -(world_from_optical @ np.linalg.inv(intrinsics(camera)))[2]
        fall = down[0] * np.arange(camera.width) + down[1] * np.arange(camera.height)[:, None] + down[2]
        with np.errstate(divide="ignore"):
            return np.where((fall > 0) & (eye[2] > 0), eye[2] / fall, np.inf)


@compiled
def _field_at(x: float, y: float, fields: Floats) -> int:
    """Index of the first field that holds a point; the last one holds all."""
    last: int = fields.shape[0] - 1
    for i in range(last):
        if fields[i, 0] <= x < fields[i, 2] and fields[i, 1] <= y < fields[i, 3]:
            return i
    return last


@compiled
def _shade(x: float, y: float, footprint: float) -> float:
    """Brightness by the checkers at a point whose pixel covers ``footprint`` [m]."""
    light = 1.0
    for i in range(TILES.shape[0]):
        side, contrast = TILES[i]
        fade = 1.0 - 2.0 * footprint / side
        if fade > 0.0:
            odd = (np.int64(np.floor(x / side)) + np.int64(np.floor(y / side))) & 1
            light += contrast * fade * (1.0 if odd else -1.0)
    return light


@compiled
def _paint(picture: Picture, eye: Floats, rays: Floats, fields: Floats) -> None:
    """The ray of a pixel is ``rays @ (column, row, 1)``: (3, 3), world."""
    field = 0
    pixel = np.sqrt(rays[0, 1] ** 2 + rays[1, 1] ** 2 + rays[2, 1] ** 2)
    for row in range(picture.shape[0]):
        for column in range(picture.shape[1]):
            dx = rays[0, 0] * column + rays[0, 1] * row + rays[0, 2]
            dy = rays[1, 0] * column + rays[1, 1] * row + rays[1, 2]
            dz = rays[2, 0] * column + rays[2, 1] * row + rays[2, 2]
            clear, light = 0.0, 0.0
            if dz < 0.0 < eye[2]:
                reach = -eye[2] / dz
                square = dx * dx + dy * dy + dz * dz
                x, y = eye[0] + reach * dx, eye[1] + reach * dy
                field = _field_at(x, y, fields)
                clear = np.exp(-reach * np.sqrt(square) / HAZE)
                light = clear * _shade(x, y, reach * pixel * square / -dz)
            for k in range(3):
                picture[row, column, k] = min(255.0 * light * fields[field, 4 + k] + (1.0 - clear) * SKY[k], 255.0)
