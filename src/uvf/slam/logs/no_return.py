"""From which range on a lidar's readings mean that nothing came back."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

BAND = 0.1
"""m: codes for "no return" lie within this of the largest value."""
BEFORE = 1.0
"""m before the band, in which values are taken for returns."""
LEAST = 20
"""Times that a code occurs at the least."""
OUTSTANDING = 5.0
"""By how much more often a code occurs than a value of the metre before does on average: returns grow rarer toward the far end."""


def farthest_return(ranges: Sequence[Floats]) -> float:
    """Range [m] from which on a lidar's readings are no returns, by its sweeps' ranges (n,) [m].

    Lidars that answer with their largest value, or codes near it, where nothing comes back have single values at the end of the
    histogram that stand out. Where none does every reading is a return, and the answer lies just above the longest.
    """
    known = np.concatenate(ranges)
    known = np.sort(known[np.isfinite(known) & (known > 0.0)])
    if not len(known):
        return 0.0
    end = known[-min(LEAST, len(known))]  # the few that are longer may be garbled
    values, counts = np.unique(known[known > end - BAND - BEFORE], return_counts=True)
    last = values >= end - BAND
    usual = counts[~last].mean() if not last.all() else 1.0
    codes = values[last & (counts >= max(LEAST, OUTSTANDING * usual))]
    return float(codes.min() if len(codes) else np.nextafter(known[-1], np.inf))
