"""Omni wheels of others: three or more of one size whose axes meet, as of a kiwi drive."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uvf.models.importing.driving.wheel_guess import WheelGuess

Floats = NDArray[np.float64]

LEVEL = 0.02  # of an axis' z, at most
ALIKE = 0.1  # share by which radii may differ
MEETS = 0.15  # of a wheel's distance, by which its axis may miss the middle
APART = 0.9  # the cosine between two axes that are not one


def ring_of(wheels: Sequence[WheelGuess]) -> tuple[WheelGuess, ...]:
    """The largest wheels that make an omnidirectional drive, counter-clockwise from ahead; none where no three do.

    Their axes are level and meet in one point about which they stand, and are not those of one axle.
    """
    level = [w for w in wheels if abs(w.axis[2]) < LEVEL]
    for size in sorted({round(w.radius, 4) for w in level}, reverse=True):
        ring = [w for w in level if abs(w.radius - size) <= ALIKE * size]
        if len(ring) >= 3 and _meet(ring):
            middle = meeting_point(ring)
            bearings = [float(np.arctan2(*(w.centre - middle)[1::-1])) for w in ring]
            return tuple(wheel for _, wheel in sorted(zip(bearings, ring, strict=True), key=lambda each: each[0] % (2 * np.pi)))
    return ()


def meeting_point(ring: Sequence[WheelGuess]) -> Floats:
    """The point (3,) [m] nearest to the axes of all wheels, at their mean height."""
    across = [np.array((-w.axis[1], w.axis[0])) / np.hypot(*w.axis[:2]) for w in ring]
    offsets = [float(n @ w.centre[:2]) for n, w in zip(across, ring, strict=True)]
    x, y = np.linalg.lstsq(np.array(across), np.array(offsets), rcond=None)[0]
    return np.array((x, y, np.mean([w.centre[2] for w in ring])))


def heading_of(axis: Floats) -> float:
    """Where a wheel rolls to [rad] that turns forward about a level axis (3,): the axis points to the left of it."""
    return float(np.arctan2(-axis[0], axis[1]))


def _meet(ring: Sequence[WheelGuess]) -> bool:
    if not any(abs(float(a.axis @ b.axis)) < APART for a in ring for b in ring):
        return False
    middle = meeting_point(ring)
    for wheel in ring:
        arm = (wheel.centre - middle)[:2]
        distance = float(np.hypot(*arm))
        missed = abs(float(arm @ (-wheel.axis[1], wheel.axis[0])))
        if distance < wheel.radius or missed > MEETS * distance:
            return False
    heights = [wheel.centre[2] for wheel in ring]
    return bool(np.ptp(heights) < ALIKE * ring[0].radius)
