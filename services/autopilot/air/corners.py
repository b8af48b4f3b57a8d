"""The way round a corner between two legs: a swing to the outside, an arc, and a swing back.

A fillet tangent to the legs (Beard & McLain 11.2) passes R (1 - cos(turn / 2)) inside of them. Shifting it outwards by half of
that halves the largest distance to the legs; a smooth step before and after the arc leads to the shifted lines.
"""

import math
from dataclasses import dataclass

from services.autopilot.air.guidance import Point

STRAIGHT = 0.02  # rad, below which a corner is none
SHARPEST = 2.8  # rad, beyond which the waypoint is overflown and the next leg joined from there
SHORTEST_RADIUS = 0.5  # of the wanted radius; a leg too short for that is joined from the waypoint
SWING_CURVATURE = 0.45  # of the arc's
STEEPEST_STEP = 10 / math.sqrt(3)  # largest second derivative of the smooth step


@dataclass(frozen=True, slots=True)
class Corner:
    """turn: +1 right, -1 left; lengths in m. ``before``: from the arc's start to the waypoint, along the first leg."""

    centre: Point
    radius: float
    turn: float
    shift: float  # distance of the shifted lines to the legs, outside
    before: float
    swing: float  # length of the step before and after the arc
    course_out: float  # rad


def plan(waypoint: Point, courses: tuple[float, float], radius: float, room: float) -> Corner | None:
    """The corner at ``waypoint`` between two ``courses`` [rad], with ``room`` [m] on each leg to use; None if there is nothing to round."""
    course_in, course_out = courses
    change = math.remainder(course_out - course_in, math.tau)
    if not STRAIGHT < abs(change) < SHARPEST:
        return None
    radius_fit = _fit(abs(change), radius, room)
    if radius_fit < SHORTEST_RADIUS * radius:
        return None
    turn = math.copysign(1.0, change)
    shift = _shift(abs(change), radius_fit)
    half_tan = math.tan(abs(change) / 2)
    before = (radius_fit - shift) * half_tan
    sideways = turn * (radius_fit - shift)
    n, e = math.cos(course_in), math.sin(course_in)
    centre = (waypoint[0] - before * n - sideways * e, waypoint[1] - before * e + sideways * n)
    return Corner(centre, radius_fit, turn, shift, before, swing_length(shift, radius_fit), course_out)


def _shift(change: float, radius: float) -> float:
    return radius * (1 - math.cos(change / 2)) / 2


def swing_length(shift: float, radius: float) -> float:
    """m, so that the step bends at most ``SWING_CURVATURE`` as much as the arc."""
    return math.sqrt(STEEPEST_STEP * shift * radius / SWING_CURVATURE)


def _fit(change: float, radius: float, room: float) -> float:
    """The wanted radius, or the largest with which arc and swing fit into ``room``: both grow with it."""
    shift = _shift(change, radius)
    needed = (radius - shift) * math.tan(change / 2) + swing_length(shift, radius)
    return radius * min(1.0, room / needed)


@dataclass(frozen=True, slots=True)
class Offset:
    """The path's distance to the right of the leg [m], its slope and its second derivative [1/m]."""

    value: float
    slope: float
    bend: float


def offset(s: float, length: float, entry: Corner | None, exit_: Corner | None) -> Offset:
    """The swings of both ends at ``s`` [m] along a leg of ``length`` [m]."""
    value = slope = bend = 0.0
    for corner, into, sign in ((entry, s, -1.0), (exit_, length - s, 1.0)):
        if corner is None:
            continue
        u = min(max((corner.before + corner.swing - into) / corner.swing, 0.0), 1.0)
        outside = -corner.turn * corner.shift
        value += outside * u**3 * (10 - 15 * u + 6 * u * u)
        slope += sign * outside * 30 * (u * (1 - u)) ** 2 / corner.swing
        bend += outside * 60 * u * (1 - u) * (1 - 2 * u) / corner.swing**2
    return Offset(value, slope, bend)
