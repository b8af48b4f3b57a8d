"""Wheel encoders: whole ticks counted since the start."""

from collections.abc import Sequence

import numpy as np

from uvf.models.vehicle.sensors import Encoders


def radians_per_tick(encoders: Encoders) -> float:
    """Wheel angle [rad] from one tick to the next."""
    return 2 * np.pi / encoders.ticks_per_turn


def ticks(encoders: Encoders, angles: Sequence[float], channels: Sequence[int]) -> list[int]:
    """Counts of each channel with the wheels at these angles [rad] since the start; channels: of each wheel, which it is part of.

    An edge counts when it is passed; of several wheels the mean angle counts.
    """
    of = [[angle for angle, k in zip(angles, channels, strict=True) if k == channel] for channel in range(max(channels) + 1)]
    return [int(np.floor(sum(some) / len(some) / radians_per_tick(encoders))) for some in of]
