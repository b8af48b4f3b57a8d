"""Loiter patterns: circles on which an aircraft waits, climbs or sinks, with room all round at every height on the way.

A helix as in Beard & McLain, "Small Unmanned Aircraft" (2012), chapter 10, and Owen, Beard, McLain (2015): it climbs as steeply as the
aircraft can. Where on the circle the height is reached depends on wind and power, so the whole circle is looked at from the lowest to
the largest height.
"""

from dataclasses import dataclass
from math import cos, isfinite, pi, sin, tan, tau

import numpy as np
from numpy.typing import NDArray

from uvf.planning.flight.airspace import Airspace, Space, space_of
from uvf.planning.flight.clearance import ClearanceMargins, Configuration, are_clear
from uvf.planning.flight.planner import FlightLimits

Floats = NDArray[np.float64]

SPACING = 1.0
"""[m] between heights, and half of that between places on a circle, that are looked at."""
WIDENED = (1.0, 1.25, 1.5)
"""Of the radius that is asked for: those that are tried."""


@dataclass(frozen=True)
class LoiterPattern:
    """A helix that begins at ``begin`` (x, y, height [m], course [rad]) and ends at ``height`` [m].

    ``radius`` [m] is positive where it turns from x towards y. ``slope``: height over distance [m/m], of the climb or sink.
    """

    begin: Configuration
    height: float
    radius: float
    slope: float

    @property
    def centre(self) -> tuple[float, float]:
        """x, y [m] of the middle."""
        x, y, _, course = self.begin
        return x - self.radius * sin(course), y + self.radius * cos(course)

    @property
    def length(self) -> float:
        """Distance [m] over ground until the height is reached; 0 where it is that of the beginning."""
        return abs(self.height - self.begin[2]) / self.slope

    @property
    def turns(self) -> float:
        """Turns until the height is reached."""
        return self.length / (tau * abs(self.radius))

    def sampled(self, spacing: float) -> Floats:
        """Configurations (n, 4): x, y, height [m], course [rad], not wrapped, at most ``spacing`` [m] apart over ground."""
        if not (spacing > 0 and isfinite(spacing)):
            raise ValueError(f"a spacing of {spacing:g} m; it must be positive and finite")
        part = np.linspace(0.0, 1.0, int(np.ceil(self.length / spacing)) + 1)
        course = self.begin[3] + part * self.length / self.radius
        x, y = self.centre
        heights = self.begin[2] + part * (self.height - self.begin[2])
        return np.column_stack((x + self.radius * np.sin(course), y - self.radius * np.cos(course), heights, course))


def plan_loiter(airspace: Airspace, limits: FlightLimits, begin: Configuration, height: float, radius: float) -> LoiterPattern | None:
    """The circle that an aircraft at ``begin`` enters by turning now, up or down to ``height`` [m]; None where there is room for none.

    Left and right are tried with ``radius`` [m], then with wider circles. Raises ValueError for what is not finite, and for a radius that
    is smaller than the aircraft's.
    """
    if not all(isfinite(value) for value in (*begin, height)):
        raise ValueError(f"a loiter pattern from {begin} to {height} m; it takes finite numbers: x, y, height [m], course [rad]")
    if not limits.radius <= radius < np.inf:
        raise ValueError(f"a loiter radius of {radius:g} m; the aircraft turns with {limits.radius:g} m or more")
    slope = tan(limits.climb if height >= begin[2] else limits.sink)
    space, margins = space_of(airspace), ClearanceMargins(float(limits.aside), float(limits.above))
    for widened in WIDENED:
        for side in (1.0, -1.0):
            found = LoiterPattern(begin, height, side * widened * radius, slope)
            if is_clear_circle(space, margins, found):
                return found
    return None


def is_clear_circle(space: Space, margins: ClearanceMargins, pattern: LoiterPattern) -> bool:
    """Whether the whole circle is clear at every height of the pattern."""
    radius, (x, y) = abs(pattern.radius), pattern.centre
    low, high = sorted((pattern.begin[2], pattern.height))
    heights = np.linspace(low, high, int(np.ceil((high - low) / SPACING)) + 1)
    angles = np.linspace(-pi, pi, int(np.ceil(tau * radius / (SPACING / 2))) + 1)
    ring = np.column_stack((x + radius * np.cos(angles), y + radius * np.sin(angles)))
    return all(are_clear(space, margins, np.column_stack((ring, np.full(len(ring), at)))) for at in heights.tolist())


def exits(pattern: LoiterPattern, count: int) -> list[Configuration]:
    """So many places, evenly round the circle, at which it may be left at its final height."""
    courses = [pattern.begin[3] + k * tau / count for k in range(count)]
    x, y = pattern.centre
    return [(x + pattern.radius * sin(c), y - pattern.radius * cos(c), pattern.height, c) for c in courses]
