"""How clear of everything an aircraft is, at a place and along a curve that climbs."""

from math import hypot, inf, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import moved
from uvf.planning.flight.airspace import Areas, Space

Floats = NDArray[np.float64]
Configuration = tuple[float, float, float, float]
"""x, y, height [m], course [rad]."""

STEP = 0.5
"""[m] along a curve at least, where there is no room for more."""


class ClearanceMargins(NamedTuple):
    """Distances [m] that are kept at least: ``aside`` from edges, ``above`` and below from heights."""

    aside: float
    above: float


@compiled
def outside(areas: Areas, i: int, x: float, y: float, enough: float) -> float:
    """Signed distance [m] from a place to the edge of an area, negative inside; a lower bound where that is ``enough``."""
    gap: float = hypot(x - areas.discs[i, 0], y - areas.discs[i, 1]) - areas.discs[i, 2]
    first, count = areas.spans[i]
    if count == 0 or gap >= enough:
        return gap
    least, is_in = inf, False
    for k in range(count):
        ax, ay = areas.corners[first + k]
        bx, by = areas.corners[first + (k + 1) % count]
        ux, uy, px, py = bx - ax, by - ay, x - ax, y - ay
        part = min(max((px * ux + py * uy) / max(ux * ux + uy * uy, 1e-12), 0.0), 1.0)
        least = min(least, (px - part * ux) ** 2 + (py - part * uy) ** 2)
        if (ay > y) != (by > y) and x < ax + ux * (y - ay) / uy:
            is_in = not is_in
    return -sqrt(least) if is_in else sqrt(least)


@compiled
def _within(fence: Areas, x: float, y: float) -> float:
    """Signed distance [m] to the edge of the fence, positive inside; inf without one."""
    best, i, n = -inf, 0, fence.groups.size
    while i < n:
        group, least = fence.groups[i], inf
        while i < n and fence.groups[i] == group:
            least = min(least, -outside(fence, i, x, y, inf))
            i += 1
        best = max(best, least)
    return best if n > 0 else inf


@compiled
def room(space: Space, margins: ClearanceMargins, at: tuple[float, float, float], slope: float) -> float:
    """Distance [m] over ground that may be flown any way from x, y, height; ``slope`` is the steepest climb or sink on it.

    Negative where the place is nearer than the margins to something; margins are taken half a ``STEP`` larger, so that they hold between
    the places that are looked at.
    """
    x, y, height = at
    aside, above, steep = margins.aside + 0.5 * STEP, margins.above + 0.5 * STEP, max(abs(slope), 1e-9)
    least = _within(space.fence, x, y) - aside
    least = min(least, (height - space.heights[0] - above) / steep, (space.heights[1] - above - height) / steep)
    areas = space.obstacles
    for i in range(areas.groups.size):
        if least < 0.0:
            return -1.0
        upright = (max(areas.heights[i, 0] - height, height - areas.heights[i, 1]) - above) / steep
        if upright < least:
            least = min(least, max(upright, outside(areas, i, x, y, least + aside) - aside))
    return least if least >= 0.0 else -1.0


@compiled
def is_clear_way(space: Space, margins: ClearanceMargins, start: Configuration, segments: Floats, slope: float) -> bool:
    """Whether an aircraft stays clear along segments (k, 2), as in ``uvf.maths.curves.segments``, climbing by ``slope`` all the way."""
    x, y, height, course = start
    if room(space, margins, (x, y, height), slope) < 0.0:
        return False
    for k in range(segments.shape[0]):
        length, curvature, s = segments[k, 0], segments[k, 1], 0.0
        here = (x, y, course)
        while s < length:
            free = room(space, margins, (here[0], here[1], height + slope * s), slope)
            if free < 0.0:
                return False
            s = min(s + max(free, STEP), length)
            here = moved(x, y, course, curvature, s)
        x, y, course = here
        height += slope * length
    return room(space, margins, (x, y, height), slope) >= 0.0


@compiled
def are_clear(space: Space, margins: ClearanceMargins, places: Floats) -> bool:
    """Whether an aircraft is clear at every one of places (n, 3): x, y, height [m]."""
    i, n = 0, places.shape[0]
    while i < n and room(space, margins, (places[i, 0], places[i, 1], places[i, 2]), 1.0) >= 0.0:
        i += 1
    return bool(i == n)
