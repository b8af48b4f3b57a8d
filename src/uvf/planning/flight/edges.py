"""Dubins airplane edges: the shortest curve that turns no tighter and climbs no steeper than the aircraft can.

Beard & McLain, "Small Unmanned Aircraft" (2012), chapter 12, and Owen, Beard, McLain, "Implementing Dubins airplane paths on fixed-wing
UAVs", Handbook of Unmanned Aerial Vehicles (2015): where the curve is too short for its climb, wider turns or circles make it longer.
Circles are flown at the start when it climbs, at the end when it sinks: high ground between is passed high.
"""

from math import floor, inf, tau
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.dubins_words import dubins_length, dubins_segments
from uvf.planning.flight.clearance import Configuration

Floats = NDArray[np.float64]

PIECES = 5
"""Of an edge: a circle, a Dubins path, a circle. Those that are not flown have no length."""
WIDER = 12
WIDENED = 0.1
"""Wider turns that are tried, each by so much of the radius wider than the one before."""


class Agility(NamedTuple):
    """Turning ``radius`` [m], and tangents of the steepest ``climb`` and ``sink`` angles, both positive."""

    radius: float
    climb: float
    sink: float


@compiled
def plane_length(agility: Agility, a: Configuration, b: Configuration) -> float:
    """Length [m] over ground of the Dubins path, whatever it climbs."""
    return dubins_length((a[0], a[1], a[3]), (b[0], b[1], b[3]), agility.radius)


@compiled
def needed(agility: Agility, rise: float) -> float:
    """Shortest distance [m] over ground on which the height can change by ``rise`` [m]."""
    return rise / agility.climb if rise > 0.0 else -rise / agility.sink


@compiled
def straight_edge(agility: Agility, a: Configuration, b: Configuration, out: Floats) -> float:
    """Writes the Dubins path from ``a`` to ``b`` into ``out`` (5, 2); its length [m], inf where it would be too steep."""
    length = _dubins(agility.radius, a, b, out)
    return length if length >= needed(agility, b[2] - a[2]) else inf


@compiled
def _dubins(radius: float, a: Configuration, b: Configuration, out: Floats) -> float:
    length = dubins_segments((a[0], a[1], a[3]), (b[0], b[1], b[3]), radius, out)
    for k in (2, 1, 0):
        out[k + 1, 0], out[k + 1, 1] = out[k, 0], out[k, 1]
    out[0, :] = 0.0
    return length


@compiled
def edge(agility: Agility, a: Configuration, b: Configuration, out: Floats) -> float:
    """Writes the shortest edge found from ``a`` to ``b`` into ``out`` (5, 2), made longer where it must be; its length [m]."""
    length = _dubins(agility.radius, a, b, out)
    missing = needed(agility, b[2] - a[2]) - length
    if missing <= 0.0:
        return length
    circles = max(floor(missing / (tau * agility.radius)), 1)
    radius = max(missing / (tau * circles), agility.radius)
    circling = length + tau * radius * circles
    for k in range(1, WIDER + 1):
        wider = agility.radius * (1.0 + WIDENED * k)
        way = _dubins(wider, a, b, out)
        if length + missing <= way < circling:
            return way
    length = _dubins(agility.radius, a, b, out)
    where = 0 if b[2] > a[2] else PIECES - 1
    turn = out[1, 1] if where == 0 else out[3, 1]
    out[where, 0], out[where, 1] = tau * radius * circles, (-1.0 if turn < 0.0 else 1.0) / radius
    return circling
