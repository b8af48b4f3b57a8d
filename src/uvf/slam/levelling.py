"""A sweep taken on a slope, as it is seen from above."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from uvf.slam.reading import Beams, Reading

Floats = NDArray[np.float64]


def levelled(reading: Reading, level_from_base: Floats, height: float) -> Reading:
    """Reading whose lidar, origin and beams are projected onto the level.

    level_from_base: rotation matrix (3, 3), of the tilt alone; height: m, of the lidar in the base frame.
    What is no return is infinite, what says nothing NaN.
    """
    beams, ranges = reading.beams, reading.ranges
    x, y, _ = (level_from_base @ (*beams.origin, height)).tolist()
    seen = beams.directions @ level_from_base[:2, :2].T
    shorter = np.hypot(*seen.T)
    bearings = np.unwrap(np.arctan2(seen[:, 1], seen[:, 0]))
    free = (ranges == 0.0) | (ranges >= beams.range_max)
    projected = np.where(reading.returned, ranges * shorter, np.where(free, np.inf, np.nan))
    from_above = Beams((x, y), bearings, beams.range_min * float(shorter.min()), beams.range_max, beams.duration)
    return replace(reading, ranges=projected, beams=from_above)
