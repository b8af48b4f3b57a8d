"""Where a ground vehicle cannot drive, by the heights of a map from above: steps, slopes, and what stands on the ground."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Singles = NDArray[np.float32]
Floats = NDArray[np.float64]
Cells = NDArray[np.int8]
Mask = NDArray[np.bool_]

FREE, UNKNOWN, OCCUPIED, OVERHEAD = 0, -1, 100, 99
"""Values of cells. Overhead: an obstacle whose top is higher than vehicles are tall; if it is a crown, one may stand under it."""
TALLEST, NEAR = 1.5, 2.0  # m: over the lowest ground within so many metres
HOLES = 0.5  # m from what was seen, within which the ground is taken to go on: a lidar from the air leaves gaps between its lines
BASELINE = 1.0  # m over which a slope is measured: a step between two cells says more of the noise
BESIDE = np.ones((3, 3), dtype=np.bool_)


class TerrainLimits(NamedTuple):
    """What a vehicle can drive over."""

    step: float  # m
    slope: float  # rad


def terrain_obstacles(heights: tuple[Singles, Singles], resolution: float, limits: TerrainLimits) -> Cells:
    """Cells (rows, columns): 0 where one can drive, 100 where not, or 99 overhead; -1 where nothing was seen.

    heights: top and ground (rows, columns) [m], NaN unknown; resolution [m]. An obstacle is where the top lies more than the step of the
    limits above the ground, the higher one of two neighbours whose ground differs by more than that, and ground that is steeper.
    """
    known = np.isfinite(heights[1])
    if not known.any():
        return np.full(known.shape, UNKNOWN, dtype=np.int8)
    distance, nearest = ndimage.distance_transform_edt(~known, return_indices=True)
    top, ground = (np.asarray(each, dtype=np.float64)[tuple(nearest)] for each in heights)
    seen = distance * resolution <= HOLES
    climb = np.tan(limits.slope) * np.sqrt(2.0) * resolution  # that a slope which can be driven has from a cell to the next one
    blocked = (top - ground > limits.step) | _higher_of_steps(ground, max(limits.step, float(climb)))
    level = seen & ~ndimage.binary_dilation(blocked, BESIDE)
    blocked |= _slope(ground, level, resolution) > np.tan(limits.slope)
    lowest = ndimage.minimum_filter(ground, size=2 * round(NEAR / resolution) + 1, mode="nearest")
    obstacle = np.where(top - lowest > TALLEST, OVERHEAD, OCCUPIED)
    return np.where(seen, np.where(blocked, obstacle, FREE), UNKNOWN).astype(np.int8)


def _higher_of_steps(ground: Floats, max_step: float) -> Mask:
    higher: Mask = ground - ndimage.minimum_filter(ground, size=3, mode="nearest") > max_step
    return higher


def _slope(ground: Floats, level: Mask, resolution: float) -> Floats:
    """Gradient [-] between the ends of a baseline across each cell, along both axes; 0 where one of its three cells is not level."""
    half = max(round(BASELINE / 2 / resolution), 1)
    smooth = ndimage.uniform_filter(ground, size=3, mode="nearest")
    gradient = np.zeros(ground.shape)
    for axis in (0, 1):
        n = ground.shape[axis]
        if n > 2 * half:
            before, middle, after = (_along(axis, slice(low, n - 2 * half + low)) for low in (0, half, 2 * half))
            rise = np.where(level[before] & level[middle] & level[after], smooth[after] - smooth[before], 0.0)
            gradient[middle] = np.hypot(gradient[middle], rise / (2 * half * resolution))
    return gradient


def _along(axis: int, part: slice) -> tuple[slice, slice]:
    return (part, slice(None)) if axis == 0 else (slice(None), part)
