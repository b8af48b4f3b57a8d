"""Lengths of the shortest Dubins and Reeds-Shepp curves by relative configuration: the estimate of Hybrid-A* that knows no obstacles.

Curves scale with the turning radius, so that one table of each kind serves all: it is made at the first query and kept.
"""

from functools import lru_cache
from math import cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.dubins_words import dubins_length
from uvf.maths.curves.reeds_shepp_words import reeds_shepp_length
from uvf.maths.curves.segments import Triple
from uvf.planning.costmap.headings import HEADINGS, STEP, heading_bin

Table = NDArray[np.float32]

PER_RADIUS = 8
"""Entries on a turning radius."""
SPAN = 7
"""Turning radii from the goal up to which the table reaches; farther away the straight line is the estimate."""


@compiled
def _fill(table: Table, reverses: bool) -> None:
    half = table.shape[0] // 2
    for i in range(table.shape[0]):
        for j in range(table.shape[1]):
            for k in range(HEADINGS):
                here = ((i - half) / PER_RADIUS, j / PER_RADIUS, k * STEP)
                table[i, j, k] = reeds_shepp_length(here, (0.0, 0.0, 0.0), 1.0) if reverses else dubins_length(here, (0.0, 0.0, 0.0), 1.0)


@lru_cache(maxsize=2)
def curve_table(reverses: bool) -> Table:
    """(x, y, heading) lengths over the radius to the origin: x from -SPAN to SPAN, y from 0 to SPAN (the right is mirrored)."""
    half = SPAN * PER_RADIUS
    table = np.empty((2 * half + 1, half + 1, HEADINGS), dtype=np.float32)
    _fill(table, reverses)
    return table


@compiled
def curve_length(table: Table, here: Triple, goal: Triple, radius: float) -> float:
    """About the length of the shortest curve from ``here`` to ``goal`` (x, y [any unit], yaw [rad]), ``radius`` in the same unit."""
    dx, dy = here[0] - goal[0], here[1] - goal[1]
    c, s = cos(goal[2]), sin(goal[2])
    scale = PER_RADIUS / radius
    x, y, turn = (c * dx + s * dy) * scale, (c * dy - s * dx) * scale, here[2] - goal[2]
    if y < 0.0:
        y, turn = -y, -turn
    i, j = int(np.floor(x + 0.5)) + table.shape[0] // 2, int(np.floor(y + 0.5))
    if 0 <= i < table.shape[0] and j < table.shape[1]:
        found: float = table[i, j, heading_bin(turn)] * radius
        return found
    return sqrt(dx * dx + dy * dy)
