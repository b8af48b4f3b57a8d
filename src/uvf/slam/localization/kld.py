"""How many particles are enough: Fox, "Adapting the Sample Size in Particle Filters Through KLD-Sampling" (2003)."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

BIN, BIN_TURN = 0.4, 0.175  # m, rad: side of the bins in which particles are counted
ERROR = 0.05  # bound of the Kullback-Leibler distance to the true distribution
QUANTILE = 2.326  # of the normal distribution: the bound holds in 99 % of cases


def bins_of(poses: Floats) -> int:
    """Number of bins that poses (n, 3) [m, m, rad] fall into."""
    places = np.floor(poses / (BIN, BIN, BIN_TURN)).astype(np.int64)
    return len(np.unique((places[:, 0] << 40) ^ ((places[:, 1] & 0xFFFFF) << 16) ^ (places[:, 2] & 0xFFFF)))


def enough(bins: int) -> int:
    """Number of particles that are enough for so many bins: equation 7, by Wilson and Hilferty's approximation."""
    if bins < 2:
        return 1
    a = 2.0 / (9.0 * (bins - 1))
    return int(np.ceil((bins - 1) / (2.0 * ERROR) * (1.0 - a + np.sqrt(a) * QUANTILE) ** 3))
