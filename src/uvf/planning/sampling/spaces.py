"""State spaces of sampling planners: the plane, and configurations of vehicles with a turning radius, joined by their shortest curves.

Configurations are x [m], y [m] and heading [rad]; in the plane the heading is that of the way and not planned.
"""

from math import atan2, hypot, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.dubins_words import dubins_length, dubins_segments
from uvf.maths.curves.reeds_shepp_words import reeds_shepp_length, reeds_shepp_segments
from uvf.maths.curves.segments import Triple, checked_radius, wrapped

Floats = NDArray[np.float64]

PLANE, DUBINS, REEDS_SHEPP = 0, 1, 2


class SteeringSpace(NamedTuple):
    """``kind``: PLANE, DUBINS or REEDS_SHEPP; ``radius``: turning radius [m], 0 in the plane. Made by the functions below."""

    kind: int
    radius: float

    @property
    def dimensions(self) -> int:
        """2 in the plane, else 3."""
        return 2 if self.kind == PLANE else 3


def plane() -> SteeringSpace:
    """Points joined by straight lines."""
    return SteeringSpace(PLANE, 0.0)


def dubins(radius: float) -> SteeringSpace:
    """A vehicle that only drives forwards, with turns of at least ``radius`` [m]. Raises ValueError for one that is not positive."""
    return SteeringSpace(DUBINS, checked_radius(radius))


def reeds_shepp(radius: float) -> SteeringSpace:
    """A vehicle that drives both ways, with turns of at least ``radius`` [m]. Raises ValueError for one that is not positive."""
    return SteeringSpace(REEDS_SHEPP, checked_radius(radius))


@compiled
def distance(space: SteeringSpace, a: Triple, b: Triple) -> float:
    """Length [m] of the shortest curve from ``a`` to ``b``."""
    if space.kind == PLANE:
        return hypot(b[0] - a[0], b[1] - a[1])
    if space.kind == DUBINS:
        return dubins_length(a, b, space.radius)
    return reeds_shepp_length(a, b, space.radius)


@compiled
def connect(space: SteeringSpace, a: Triple, b: Triple, out: Floats) -> float:
    """Writes the segments of the shortest curve from ``a`` to ``b`` into ``out`` (5, 2); its length [m]."""
    if space.kind == PLANE:
        out[:, :] = 0.0
        out[0, 0] = hypot(b[0] - a[0], b[1] - a[1])
        length: float = out[0, 0]
        return length
    if space.kind == DUBINS:
        return dubins_segments(a, b, space.radius, out)
    return reeds_shepp_segments(a, b, space.radius, out)


@compiled
def leaving(space: SteeringSpace, a: Triple, b: Triple) -> Triple:
    """The configuration in which the curve from ``a`` to ``b`` begins: ``a``, in the plane with the heading of the line."""
    return (a[0], a[1], atan2(b[1] - a[1], b[0] - a[0])) if space.kind == PLANE else a


@compiled
def turned(space: SteeringSpace, a: Triple) -> Triple:
    """The same place, looking the other way: curves back are curves there for who looks the other way."""
    return a if space.kind == PLANE else (a[0], a[1], wrapped(a[2] + pi))


@compiled
def cut(segments: Floats, length: float) -> float:
    """Shortens segments to a ``length`` [m] in place; the length that they have then."""
    done = 0.0
    for k in range(segments.shape[0]):
        part = abs(segments[k, 0])
        left = max(length - done, 0.0)
        if part > left:
            segments[k, 0] = left if segments[k, 0] > 0.0 else -left
            part = left
        done += part
    return done
