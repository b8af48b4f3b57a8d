"""The ends of a sweep's beams, for methods that match to grids."""

import numpy as np
from numpy.typing import NDArray

from uvf.slam.reading import Reading

Floats = NDArray[np.float64]


def points_of(reading: Reading, reach: float, most: int) -> Floats:
    """Ends (n, 2) [m, base frame] of the beams that came back from within ``reach`` [m], thinned evenly to no more than ``most``.

    None of a reading that has another number of ranges than of beams.
    """
    if reading.ranges.shape != reading.beams.bearings.shape:
        return np.zeros((0, 2))
    used = np.flatnonzero(reading.returned & (np.nan_to_num(reading.ranges) < reach))
    used = used[:: -(-len(used) // most)] if len(used) else used
    points: Floats = reading.beams.directions[used] * reading.ranges[used, None] + np.array(reading.beams.origin)
    return points
