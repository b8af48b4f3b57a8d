"""Wheel encoders: whole ticks counted since the start."""

from collections.abc import Sequence

import numpy as np

from uvf.models.vehicle.sensors import Encoders


def radians_per_tick(encoders: Encoders) -> float:
    """Wheel angle [rad] from one tick to the next."""
    return 2 * np.pi / encoders.ticks_per_turn


def ticks(encoders: Encoders, angles: Sequence[float]) -> tuple[int, int]:
    """Counts of the left and the right side with the wheels, the left ones first, at these angles [rad] since the start.

    An edge counts when it is passed; of several wheels the mean angle counts.
    """
    per_tick, half = radians_per_tick(encoders), len(angles) // 2
    left, right = (int(np.floor(sum(side) / half / per_tick)) for side in (angles[:half], angles[half:]))
    return left, right
