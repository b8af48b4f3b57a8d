"""Ways in the plane made of segments of constant curvature, driven forwards or backwards.

Segments are an array (k, 2): signed length [m], negative = backwards, and curvature [1/m], positive = to the left of x towards y.
"""

from math import cos, isfinite, sin, tau

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Triple = tuple[float, float, float]

MOST = 5
"""Segments of a Reeds-Shepp path at most; of a Dubins path there are three."""


@compiled
def wrapped(angle: float) -> float:
    """The same angle [rad] from -pi to pi."""
    turns: float = np.floor(angle / tau + 0.5)
    return angle - tau * turns


@compiled
def moved(x: float, y: float, heading: float, curvature: float, s: float) -> Triple:
    """(x [m], y [m], heading [rad], not wrapped) after ``s`` [m] along a curvature [1/m]; the half angle keeps short arcs exact."""
    half = 0.5 * curvature * s
    chord = s
    if abs(half) > 1e-4:
        chord *= sin(half) / half
    else:
        chord *= 1.0 - half * half / 6.0
    return x + chord * cos(heading + half), y + chord * sin(heading + half), heading + 2.0 * half


@compiled
def end_of(start: Triple, segments: Floats) -> Triple:
    """Configuration (x [m], y [m], heading [rad], not wrapped) at the end of segments (k, 2) from ``start``."""
    x, y, heading = start
    for k in range(segments.shape[0]):
        x, y, heading = moved(x, y, heading, segments[k, 1], segments[k, 0])
    return x, y, heading


@compiled
def sampled(start: Triple, segments: Floats, at: Floats) -> Floats:
    """Configurations (n, 4): x, y [m], heading [rad], not wrapped, and direction of travel (1 or -1), at ascending ``at`` (n,) [m].

    ``at`` are distances driven along segments (k, 2) from ``start``; before the start and beyond the end the ends are repeated.
    """
    found = np.empty((at.size, 4))
    x, y, heading = start
    k, begin = 0, 0.0
    direction = 1.0
    if segments.shape[0] > 0 and segments[0, 0] < 0.0:
        direction = -1.0
    for i in range(at.size):
        while k < segments.shape[0] and at[i] > begin + abs(segments[k, 0]):
            x, y, heading = moved(x, y, heading, segments[k, 1], segments[k, 0])
            begin += abs(segments[k, 0])
            k += 1
        here = (x, y, heading)
        if k < segments.shape[0]:
            direction = -1.0 if segments[k, 0] < 0.0 else 1.0
            here = moved(x, y, heading, segments[k, 1], direction * max(at[i] - begin, 0.0))
        found[i, 0], found[i, 1], found[i, 2], found[i, 3] = here[0], here[1], here[2], direction
    return found


def checked_radius(radius: float) -> float:
    """A turning radius [m]. Raises ValueError for one that is not positive and finite."""
    if not (radius > 0 and isfinite(radius)):
        raise ValueError(f"a turning radius of {radius:g} m; it must be positive and finite")
    return float(radius)


def checked_configuration(what: str, configuration: Triple) -> Triple:
    """(x [m], y [m], heading [rad]) as floats. Raises ValueError, with ``what`` it is, for other than three finite numbers."""
    if len(configuration) != 3 or not all(isfinite(value) for value in configuration):
        raise ValueError(f"{what}: {configuration} is no configuration; it takes three finite numbers: x [m], y [m], heading [rad]")
    return float(configuration[0]), float(configuration[1]), float(configuration[2])


def checked_pairs(starts: Floats, goals: Floats) -> tuple[Floats, Floats]:
    """Configurations (n, 3), (n, 3) as contiguous float64. Raises ValueError for other shapes and for what is not finite."""
    pair = []
    for what, given in (("starts", starts), ("goals", goals)):
        array = np.ascontiguousarray(given, dtype=np.float64)
        if array.ndim != 2 or array.shape[1] != 3:
            raise ValueError(f"{what}: an array of shape {array.shape}; it takes (n, 3): x [m], y [m], heading [rad]")
        if not np.isfinite(array).all():
            raise ValueError(f"{what}: row {int(np.argmin(np.isfinite(array).all(axis=1)))} is not finite")
        pair.append(array)
    if len(pair[0]) != len(pair[1]):
        raise ValueError(f"{len(pair[0])} starts and {len(pair[1])} goals; it takes as many of one as of the other")
    return pair[0], pair[1]
