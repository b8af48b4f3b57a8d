"""A planned path: curves of constant curvature, one after the other."""

from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import moved

Floats = NDArray[np.float64]

X, Y, HEADING, LENGTH, CURVATURE = 0, 1, 2, 3, 4


@dataclass(frozen=True)
class SamplingPath:
    """``pieces`` (n, 5): x, y [m], heading [rad] where each begins, signed length [m], negative = backwards, curvature [1/m].

    ``end``: x, y [m], heading [rad] of the last one's end.
    """

    pieces: Floats
    end: tuple[float, float, float]

    @property
    def length(self) -> float:
        """Distance driven [m]."""
        return float(np.abs(self.pieces[:, LENGTH]).sum())

    def sampled(self, spacing: float) -> Floats:
        """Configurations (n, 4): x, y [m], heading [rad] and direction of travel (1 or -1), at most ``spacing`` [m] apart.

        Where pieces meet in the plane, or the direction changes, the place comes twice. Raises ValueError for a spacing that is not
        positive.
        """
        if not (spacing > 0 and isfinite(spacing)):
            raise ValueError(f"a spacing of {spacing:g} m; it must be positive and finite")
        counts = np.ceil(np.abs(self.pieces[:, LENGTH]) / spacing).astype(np.int64) + 1
        return _sampled(self.pieces, counts) if len(counts) else np.array([(*self.end, 1.0)])


@compiled
def _sampled(pieces: Floats, counts: NDArray[np.int64]) -> Floats:
    found = np.empty((counts.sum(), 4))
    n = 0
    for i in range(pieces.shape[0]):
        x, y, heading, length, curvature = pieces[i]
        for k in range(counts[i]):
            found[n, 0], found[n, 1], found[n, 2] = moved(x, y, heading, curvature, length * k / (counts[i] - 1))
            found[n, 3] = -1.0 if length < 0.0 else 1.0
            n += 1
    return found
