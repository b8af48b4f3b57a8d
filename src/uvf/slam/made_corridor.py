"""Readings that a service's kernels are compiled with, or loaded from their cache, before the first scan."""

from collections.abc import Iterator

import numpy as np

from uvf.maths.se2 import Pose2
from uvf.slam.reading import Beams, Reading


def there_and_back() -> Iterator[Reading]:
    """Readings of a drive through a made-up corridor, there and back."""
    beams = Beams((0.0, 0.0), np.linspace(-np.pi, np.pi, 120), 0.1, 10.0)
    for k in range(50):
        x = 0.4 * min(k, 50 - k)
        along, across = np.abs(beams.directions).T
        ranges = np.minimum(
            1.5 / np.maximum(across, 1e-6), np.where(beams.directions[:, 0] > 0.0, 14.0 - x, 2.0 + x) / np.maximum(along, 1e-6)
        )
        yield Reading(float(k), ranges, beams, Pose2(x, 0.0, 0.0))
