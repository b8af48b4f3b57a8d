"""Makes heights.png: level ground with two mounds, one grey level a millimetre. ``python worlds/depot/make_heights.py``"""

from pathlib import Path

import numpy as np
from PIL import Image

EAST, NORTH, CELL = 120.0, 100.0, 0.5  # m
MOUNDS = ((19.0, 11.0, 3.2, 4.5), (-26.0, 17.0, 4.0, 6.0))  # m: x, y, height, radius


def heights() -> np.ndarray:
    """(rows, columns) m, row 0 in the north."""
    x, y = np.meshgrid(np.arange(-EAST / 2, EAST / 2 + CELL / 2, CELL), np.arange(NORTH / 2, -NORTH / 2 - CELL / 2, -CELL))
    land = np.zeros_like(x)
    for east, north, up, radius in MOUNDS:
        share = np.clip(1.0 - np.hypot(x - east, y - north) / radius, 0.0, 1.0)
        land += up * share
    return land


if __name__ == "__main__":
    millimetres = np.round(1000 * heights()).astype(np.uint16)
    Image.fromarray(millimetres).save(Path(__file__).with_name("heights.png"), optimize=True)
