"""Makes heights.png: hills round a level strip, one grey level a millimetre. ``python worlds/hills/make_heights.py``"""

from pathlib import Path

import numpy as np
from PIL import Image

EAST, NORTH, CELL = 480.0, 400.0, 5.0  # m
STRIP = (130.0, 15.0, 10.0)  # m: half length, half width, height
BLEND = 35.0  # m, over which the land comes down to the strip, and to z = 0 at the rim
HILLS = (  # m: x, y, height, radius
    (-150.0, 110.0, 36.0, 55.0),
    (-20.0, 130.0, 20.0, 60.0),
    (120.0, 95.0, 30.0, 50.0),
    (170.0, -100.0, 24.0, 55.0),
    (30.0, -115.0, 32.0, 50.0),
    (-120.0, -110.0, 22.0, 60.0),
)


def heights() -> np.ndarray:
    """(rows, columns) m, row 0 in the north."""
    x, y = np.meshgrid(np.arange(-EAST / 2, EAST / 2 + 1, CELL), np.arange(NORTH / 2, -NORTH / 2 - 1, -CELL))
    land = 6.0 + sum(up * np.exp(-((x - east) ** 2 + (y - north) ** 2) / (2 * (r / 1.5) ** 2)) for east, north, up, r in HILLS)
    length, width, level = STRIP
    beside = np.hypot(np.maximum(np.abs(x) - length, 0.0), np.maximum(np.abs(y) - width, 0.0))
    land = level + (land - level) * smooth(beside / BLEND)
    return land * smooth(np.minimum(EAST / 2 - np.abs(x), NORTH / 2 - np.abs(y)) / BLEND)


def smooth(share: np.ndarray) -> np.ndarray:
    """0 below 0, 1 above 1, without a bend between."""
    s = np.clip(share, 0.0, 1.0)
    return s * s * (3 - 2 * s)


if __name__ == "__main__":
    millimetres = np.round(1000 * heights()).astype(np.uint16)
    Image.fromarray(millimetres).save(Path(__file__).with_name("heights.png"), optimize=True)
