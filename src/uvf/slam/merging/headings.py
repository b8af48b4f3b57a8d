"""Headings at which the walls of two places are parallel.

The histogram of the directions that surfaces face turns with the place: the correlation of two has its peaks where they may be the same.
Censi, Iocchi, Grisetti, "Scan matching in the Hough domain" (2005) has the idea for lines.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FACES = 180  # directions
BLUR = np.radians(4.0)  # 1 sigma: what normals are off by
LIKELY = 0.5
"""Part of the best correlation's height over the least one up to which a heading is looked at."""


def facing(normals: Floats, yaw: float = 0.0) -> Floats:
    """Histogram (FACES,) of the directions of unit normals (n, 2), turned by yaw [rad]; normals that are 0 do not count."""
    known = normals[(normals != 0.0).any(axis=1)]
    angles = np.arctan2(known[:, 1], known[:, 0]) + yaw
    counts = np.bincount(np.floor(angles / (2.0 * np.pi) * FACES).astype(np.int64) % FACES, minlength=FACES)
    return counts.astype(np.float64)


def likely(turns: Floats, a: Floats, b: Floats) -> Floats:
    """Those of the ``turns`` (n,) [rad] that bring what b (FACES,) faces to what a (FACES,) faces."""
    waves = np.fft.rfftfreq(FACES, 1.0 / FACES)
    blur = np.exp(-((waves * BLUR) ** 2))
    alike = np.fft.irfft(np.fft.rfft(a) * np.conj(np.fft.rfft(b)) * blur, FACES)
    bins = np.rint(turns / (2.0 * np.pi) * FACES).astype(np.int64) % FACES
    heights: Floats = alike[bins]
    low, high = float(alike.min()), float(alike.max())
    return turns[heights >= low + LIKELY * (high - low)]
