"""Wheel encoders: whole ticks counted since the start."""

import numpy as np

from uvf.models.vehicle.sensors import Encoders


def radians_per_tick(encoders: Encoders) -> float:
    """Wheel angle [rad] from one tick to the next."""
    return 2 * np.pi / encoders.ticks_per_turn


def ticks(encoders: Encoders, angles: tuple[float, float]) -> tuple[int, int]:
    """Counts of the left and right wheel at these angles [rad] since the start: an edge counts when it is passed."""
    per_tick = radians_per_tick(encoders)
    return int(np.floor(angles[0] / per_tick)), int(np.floor(angles[1] / per_tick))
