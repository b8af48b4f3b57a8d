"""How fast an aircraft is over ground in a steady wind, on each course, and how long turns over ground take it."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]

COURSES = 720  # of the table over a whole turn
LEAST_SHARE = 0.05  # of the airspeed that must be left against the wind


@dataclass(frozen=True)
class GroundSpeed:
    """Ground speed at ``airspeed`` [m/s] in a ``wind`` [m/s, east and north, the way the air moves], courses from east to north [rad].

    The wind triangle, Beard & McLain, "Small Unmanned Aircraft", 2012, section 2.4.
    """

    airspeed: float
    wind: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        """Raises ValueError for a wind in which not every course can be flown."""
        if not 0.0 < self.airspeed < math.inf:
            raise ValueError(f"an airspeed of {self.airspeed:g} m/s; give a positive one")
        speed = math.hypot(*self.wind)
        if not speed <= (1.0 - LEAST_SHARE) * self.airspeed:
            raise ValueError(
                f"a wind of {speed:.1f} m/s against an airspeed of {self.airspeed:g} m/s: not every course can be flown; "
                f"wait for less than {(1.0 - LEAST_SHARE) * self.airspeed:.1f} m/s or fly faster"
            )

    def at(self, course: ArrayLike) -> Floats:
        """Ground speed [m/s] on a course or courses (k,) [rad]."""
        along = self.wind[0] * np.cos(course) + self.wind[1] * np.sin(course)
        across = self.wind[1] * np.cos(course) - self.wind[0] * np.sin(course)
        speed: Floats = along + np.sqrt(self.airspeed**2 - across**2)
        return speed

    @cached_property
    def table(self) -> Floats:
        """(721,) s/m: the integral of one over the ground speed from course 0 on, in even steps to a whole turn (Simpson's rule)."""
        step = math.tau / COURSES
        ends = np.arange(COURSES + 1) * step
        slow = 1.0 / self.at(ends)
        middle = 1.0 / self.at(ends[:-1] + step / 2)
        return np.concatenate(((0.0,), np.cumsum(step / 6 * (slow[:-1] + 4 * middle + slow[1:]))))

    def time(self, course: float, curvature: float, length: float) -> float:
        """Time [s] along an arc, or a straight with curvature 0 [1/m], of ``length`` [m] that begins on ``course`` [rad]."""
        if curvature == 0.0:
            return length / float(self.at(course))
        return abs(turning(self.table, course + curvature * length) - turning(self.table, course)) / abs(curvature)


@compiled
def turning(table: Floats, course: float) -> float:
    """The integral of one over the ground speed [s/m] from course 0 to any ``course`` [rad], by a table of ``GroundSpeed``."""
    steps = len(table) - 1
    whole = np.floor(course / (2 * np.pi))
    place = (course / (2 * np.pi) - whole) * steps
    k = min(int(place), steps - 1)
    found: float = whole * table[steps] + table[k] + (place - k) * (table[k + 1] - table[k])
    return found
