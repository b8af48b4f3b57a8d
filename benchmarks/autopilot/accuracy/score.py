"""Scores a flight of the course from the truth: legs, path, heights, airspeed, circles, and how hard the surfaces worked."""

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from benchmarks.autopilot.accuracy.course import ENTRY, EXIT, TURNS, Course

Floats = NDArray[np.float64]
Pair = tuple[Floats, Floats]
"""Of the truth, and of the estimate."""

NONE = np.array((np.nan,))  # of a course without such legs: a glider's never runs level
SETTLED = 30.0  # s after the start; nothing before it counts


@dataclass(frozen=True)
class Flight:
    """What was recorded, every row at its time; n samples."""

    t: Floats  # (n,) s
    truth: Floats  # (n, 3) m north, east, height
    estimate: Floats  # (n, 3) m
    airspeed: Floats  # (n, 2) m/s true airspeed: the truth, and the estimate
    surfaces: Floats  # (n, 4) rad where the servos are: aileron, elevator, rudder; throttle
    off_path: Floats  # (n, 2) m to the right of the path planned by the autopilot: the truth, and the estimate
    bank: Floats  # (n,) rad
    wind_error: Floats  # (n,) m/s, of the estimated wind


@dataclass(frozen=True)
class Window:
    """Samples of one leg that count; ``k``: (m,) indices."""

    k: NDArray[np.intp]
    begin: Floats  # (3,) m
    end: Floats

    @property
    def along(self) -> Floats:
        """(2,) unit vector."""
        d = self.end[:2] - self.begin[:2]
        unit: Floats = d / np.linalg.norm(d)
        return unit

    def aside(self, points: Floats) -> Floats:
        """(m,) m to the right of the leg, of (n, 3) points of the flight."""
        d = points[self.k, :2] - self.begin[:2]
        return np.asarray(d[:, 1] * self.along[0] - d[:, 0] * self.along[1])

    def above(self, points: Floats) -> Floats:
        """(m,) m above the line between the leg's heights."""
        d = points[self.k] - self.begin
        part = (d[:, :2] @ self.along) / np.linalg.norm(self.end[:2] - self.begin[:2])
        return np.asarray(d[:, 2] - part * (self.end[2] - self.begin[2]))

    @property
    def climbs(self) -> bool:
        """Whether the leg ends at another height, above or below."""
        return bool(self.begin[2] != self.end[2])


def leg_windows(flight: Flight, course: Course) -> list[Window]:
    """A leg is left for good at its first sample past its end less EXIT; the first ENTRY of it does not count. Raises ValueError."""
    corners, first, found = course.corners, int(np.searchsorted(flight.t, SETTLED)), []
    for begin, end in itertools.pairwise(corners):
        leg = Window(np.arange(first, len(flight.t)), begin, end)
        s = (flight.truth[first:, :2] - begin[:2]) @ leg.along
        length = float(np.linalg.norm(end[:2] - begin[:2]))
        past = np.flatnonzero(s >= length - EXIT * course.scale)
        if not len(past):
            raise ValueError(f"leg {len(found) + 1} of {len(corners) - 1} was not flown to its end")
        k = first + np.flatnonzero(s[: past[0]] >= ENTRY * course.scale)
        found.append(Window(k, begin, end))
        first += int(past[0])
    return found


@dataclass(frozen=True)
class Ring:
    """Samples of one circle that count."""

    k: NDArray[np.intp]
    centre: Floats  # (2,) m
    radius: float  # m

    def outside(self, points: Floats) -> Floats:
        """(m,) m from the circle."""
        d = points[self.k, :2] - self.centre
        return np.asarray(np.hypot(d[:, 0], d[:, 1]) - self.radius)


def circle_windows(flight: Flight, course: Course, after: int) -> list[Ring]:
    """Both circles: two full turns after half a turn. Raises ValueError."""
    found = []
    for north, east, radius in course.circles:
        d = flight.truth[after:, :2] - (north, east)
        r = np.hypot(d[:, 0], d[:, 1])
        near = np.flatnonzero(r <= 1.25 * abs(radius))
        if not len(near):
            raise ValueError("a circle was not reached")
        turned = np.sign(radius) * np.unwrap(np.arctan2(d[near[0] :, 1], d[near[0] :, 0]))
        turned -= turned[0]
        if turned.max() < (2 * TURNS - 1) * pi:
            raise ValueError("a circle was not flown to its end")
        inside = np.flatnonzero((turned >= pi) & (np.maximum.accumulate(turned) <= (2 * TURNS - 1) * pi))
        k = after + near[0] + inside
        found.append(Ring(k, np.array((north, east)), abs(radius)))
        after = int(k[-1])
    return found


def rms(x: Floats) -> float:
    """In the unit of x."""
    return float(np.sqrt(np.mean(np.square(x))))


def activity(flight: Flight, k: NDArray[np.intp]) -> Floats:
    """(4,) rad/s and 1/s: the way of each surface and of the throttle over the time, within windows."""
    step = np.abs(np.diff(flight.surfaces, axis=0))
    follows = np.flatnonzero(np.diff(k) == 1)
    seconds = float((flight.t[k[follows + 1]] - flight.t[k[follows]]).sum())
    way: Floats = step[k[follows]].sum(axis=0) / seconds
    return way


def spread(x: Floats) -> float:
    """Standard deviation, in the unit of x."""
    return float(np.std(x))


def score(flight: Flight, course: Course) -> dict[str, float]:
    """Metric -> value; those that begin with ``control`` are of the estimate, with ``estimation`` of the truth less the estimate.

    Raises ValueError for a flight that did not fly the course.
    """
    legs = leg_windows(flight, course)
    rings = circle_windows(flight, course, int(legs[-1].k[-1]))
    on_legs, on_rings = np.concatenate([w.k for w in legs]), np.concatenate([ring.k for ring in rings])
    level, slopes = [w for w in legs if not w.climbs], [w for w in legs if w.climbs]
    whole = slice(int(legs[0].k[0]), int(legs[-1].k[-1]))

    def both(deviation: Callable[[Floats], list[Floats]]) -> Pair:
        true, known = (np.concatenate(deviation(points) or [NONE]) for points in (flight.truth, flight.estimate))
        return true, known

    aside = both(lambda points: [w.aside(points) for w in legs])
    off_path, speed = flight.off_path[whole].T, flight.airspeed[on_legs].T
    busy, busy_turning = activity(flight, on_legs), activity(flight, on_rings)
    return {
        **_split("xtrack", aside, rms),
        "p95": float(np.percentile(np.abs(aside[0]), 95)),
        "max": float(np.abs(aside[0]).max()),
        **_split("path", (off_path[0], off_path[1]), rms),
        **_split("orbit", both(lambda points: [ring.outside(points) for ring in rings]), rms),
        **_split("level", both(lambda points: [w.above(points) for w in level]), rms),
        **_split("slope", both(lambda points: [w.above(points) for w in slopes]), rms),
        **_split("orbit alt", both(lambda points: [points[on_rings, 2] - course.corners[0, 2]]), rms),
        **_split("V sd", (speed[0], speed[1]), spread),
        "V mean": float(speed[0].mean()) - course.speed,
        "deg/s": float(np.degrees(busy[:3].sum())),
        "orbit deg/s": float(np.degrees(busy_turning[:3].sum())),
        "throttle/s": float(busy[3]),
        "bank": float(np.degrees(np.abs(flight.bank[whole]).max())),
        "wind": rms(flight.wind_error[on_legs]),
    }


def _split(name: str, pair: Pair, measure: Callable[[Floats], float]) -> dict[str, float]:
    true, known = pair
    return {name: measure(true), f"control {name}": measure(known), f"estimation {name}": measure(true - known)}
