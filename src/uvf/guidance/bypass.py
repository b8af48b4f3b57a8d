"""A curve from one leg onto another past the waypoints between them, where their corners cannot be rounded one by one.

Of Dubins paths from points before the first waypoint to points after the last one, it is the one that strays least from legs and
waypoints: mild bends close together become one, a row of a survey is joined from the one before by a loop outside, and a waypoint
with too sharp a corner is flown over.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from uvf.guidance.clothoid_dubins import SampledPath, smooth_dubins_path
from uvf.guidance.corners import CornerLimits
from uvf.guidance.vector_field import Point
from uvf.maths.curves.dubins import Triple, dubins_path

Floats = NDArray[np.float64]

BEFORE = (0.0, 0.5, 1.0, 1.6)  # of the radius, before the first waypoint
AFTER = (0.0, 0.5, 1.0, 1.6, 2.2, 2.8, 3.4)  # of the radius, after the last
MISSABLE = (0.4, 0.8, 1.2)  # of the radius, on the first and last leg: where these may not be missed either
SAMPLES = 30
MISSING = 2.0  # m of straying from the legs that a metre off a waypoint is worth
NOT_ACCEPTED = 30.0  # the same, beyond the acceptance radius
LENGTH = 0.1  # m of straying that a metre of way is worth


@dataclass(frozen=True)
class Bypass:
    """A curve past waypoints.

    ``passing``: [m] along the path where it is nearest to each waypoint; ``before``, ``after``: [m] of the legs that it replaces.
    """

    way: SampledPath
    passing: tuple[float, ...]
    before: float
    after: float


def plan(places: Sequence[Point], acceptances: Sequence[float], room: Point, flying: CornerLimits) -> Bypass:
    """A curve past all but the first and last of ``places`` (north, east [m]), with ``room`` [m] on the first and last leg.

    ``acceptances``: acceptance radius [m] of each waypoint passed.
    """
    corners, radius, ramp = np.array(places), flying.radius, flying.ramp
    enters, leaves = _along(corners[0], corners[1]), _along(corners[-2], corners[-1])
    legs = _points(corners[1], enters + pi, room[0], radius) + _points(corners[-2], leaves, room[1], radius)
    wanted = np.vstack((corners[1:-1], *legs))
    best = None
    for before, after in itertools.product((f * radius for f in BEFORE), (f * radius for f in AFTER)):
        if before > room[0] or after > room[1]:
            continue
        path = dubins_path(_on(corners[1], enters, ramp / 2 - before), _on(corners[-2], leaves, after - ramp / 2), radius)
        points = path.at(np.linspace(0, path.length, SAMPLES))[:, :2]
        cost = _straying(points, wanted, corners, np.array(acceptances)) + LENGTH * (path.length - before - after)
        if best is None or cost < best[0]:
            best = cost, before, after
    _, before, after = best if best is not None else (0.0, 0.0, 0.0)
    way = smooth_dubins_path(_on(corners[1], enters, -before), _on(corners[-2], leaves, after), radius, ramp)
    return Bypass(way, _passing(way, corners[1:-1]), before, after)


def _along(a: Floats, b: Floats) -> float:
    """rad."""
    return atan2(b[1] - a[1], b[0] - a[0])


def _on(place: Floats, course: float, distance: float) -> Triple:
    return float(place[0]) + distance * cos(course), float(place[1]) + distance * sin(course), course


def _points(place: Floats, course: float, room: float, radius: float) -> list[Floats]:
    """Of a leg, as far as it may be left out."""
    return [np.array(_on(place, course, f * radius)[:2]) for f in MISSABLE if f * radius < room]


def _straying(points: Floats, wanted: Floats, corners: Floats, acceptances: Floats) -> float:
    """m, of the way from the legs at most, and of legs and waypoints from the way at most."""
    a, d = corners[:-1], np.diff(corners, axis=0)
    share = np.clip(np.einsum("kij,ij->ki", points[:, None] - a, d) / np.maximum((d**2).sum(axis=1), 1e-9), 0.0, 1.0)
    away = np.linalg.norm(points[:, None] - a - share[..., None] * d, axis=2).min(axis=1).max()
    missed = np.linalg.norm(points[:, None] - wanted, axis=2).min(axis=0)
    beyond = np.maximum(missed[: len(acceptances)] - acceptances, 0.0).max()
    return float(away + MISSING * missed.max() + NOT_ACCEPTED * beyond)


def _passing(way: SampledPath, waypoints: Floats) -> tuple[float, ...]:
    nearest = np.linalg.norm(way.points[:, None] - waypoints, axis=2).argmin(axis=0)
    return tuple(np.maximum.accumulate(way.s[nearest]).tolist())
