"""What is to be covered, and how: the field, the tool's width, where to begin and to end."""

import math
from dataclasses import dataclass
from typing import Literal

from uvf.planning.coverage.field import CoverageField

LEAST_WIDTH, MOST_WIDTH = 1e-3, 1e6  # m


@dataclass(frozen=True)
class End:
    """A place [m, east and north] where the path begins or ends; ``course`` [rad, from east to north], None: any."""

    x: float
    y: float
    course: float | None = None

    def __post_init__(self) -> None:
        """Raises ValueError for numbers that are not finite."""
        if not all(math.isfinite(value) for value in (self.x, self.y, self.course or 0.0)):
            raise ValueError(f"an end of the path at ({self.x:g}, {self.y:g}) m, course {self.course}; give finite numbers")


@dataclass(frozen=True)
class CoverageTask:
    """Cover ``field`` with a tool ``width`` [m] wide.

    share: of the area that must be covered at least; 1: every corner, at the price of longer swaths at slanted borders (a camera sees
    more than ``width``, so that nothing is missed). overshoot: [m], by which each swath is longer at both ends. direction: [rad] of the
    swaths, None: the best. start, end: of the path, None: anywhere. least: what is made small: the time of the whole path, or the length
    of the swaths, whatever their turns take. seed: of the search for the order.
    """

    field: CoverageField
    width: float
    share: float = 0.996
    overshoot: float = 0.0
    direction: float | None = None
    start: End | None = None
    end: End | None = None
    least: Literal["time", "swaths"] = "time"
    seed: int = 0

    def __post_init__(self) -> None:
        """Raises ValueError for numbers that make no sense."""
        if not LEAST_WIDTH <= self.width <= MOST_WIDTH:
            raise ValueError(f"a spacing of {self.width:g} m between swaths; give {LEAST_WIDTH:g} to {MOST_WIDTH:g} m")
        if not 0.0 < self.share <= 1.0:
            raise ValueError(f"a share of {self.share:g} of the field to cover; give more than 0, and 1 for all of it")
        if not 0.0 <= self.overshoot < math.inf:
            raise ValueError(f"an overshoot of {self.overshoot:g} m; give 0 or more")
        if self.direction is not None and not math.isfinite(self.direction):
            raise ValueError(f"a swath direction of {self.direction:g} rad; give a finite angle")
