"""Connected patches of one colour in a picture.

By hue and saturation, which shading changes little, and connected components (Gonzalez & Woods, "Digital Image Processing", 4th edition,
sections 6.2 and 9.5).
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy import ndimage

LEVELS = 256  # of Pillow's hue, saturation and value
NEIGHBOURS = np.ones((3, 3))


@dataclass(frozen=True)
class ColourRange:
    """Which colours count: hue [rad] from red over green, no farther than ``width`` [rad] from ``hue``; saturation and value [0 to 1]."""

    hue: float
    width: float
    least_saturation: float
    least_value: float


@dataclass(frozen=True)
class Blob:
    """A patch of the colour [pixels]; pixel (0, 0) is the centre of the first one."""

    column: float
    row: float
    width: int
    height: int
    pixels: int
    is_cut: bool
    """Whether it reaches the rim of the picture: there is more of it than is seen."""


def colour_blobs(picture: NDArray[np.uint8], colour: ColourRange, least: int, most: int = 50) -> list[Blob]:
    """The ``most`` largest patches of ``colour`` in a ``picture`` (height, width, 3) RGB with ``least`` pixels or more, largest first."""
    mask = colour_mask(picture, colour)
    labels, count = ndimage.label(mask, NEIGHBOURS)
    if count == 0:
        return []
    sizes = np.bincount(labels.ravel())[1:]
    rows, columns = mask.shape
    parts = ndimage.find_objects(labels)
    largest = [int(k) for k in np.argsort(-sizes, kind="stable")[:most] if sizes[k] >= least]
    found = []
    for k in largest:
        across, along = parts[k]
        at = np.nonzero(labels[across, along] == k + 1)
        cut = across.start == 0 or along.start == 0 or across.stop == rows or along.stop == columns
        row, column = float(np.mean(at[0])) + across.start, float(np.mean(at[1])) + along.start
        found.append(Blob(column, row, along.stop - along.start, across.stop - across.start, int(sizes[k]), cut))
    return found


def colour_mask(picture: NDArray[np.uint8], colour: ColourRange) -> NDArray[np.bool_]:
    """(height, width) where a ``picture`` (height, width, 3) RGB has the colour."""
    hsv = np.asarray(Image.fromarray(picture).convert("HSV")).astype(np.int16)
    wanted = round(colour.hue % math.tau / math.tau * LEVELS)
    off = np.abs((hsv[:, :, 0] - wanted + LEVELS // 2) % LEVELS - LEVELS // 2)
    near = off <= colour.width / math.tau * LEVELS
    found: NDArray[np.bool_] = near & (hsv[:, :, 1] >= colour.least_saturation * (LEVELS - 1))
    return found & (hsv[:, :, 2] >= colour.least_value * (LEVELS - 1))
