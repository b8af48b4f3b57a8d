"""Descent of an artificial potential: the goal attracts, obstacles repel (Khatib, "Real-time obstacle avoidance", IJRR 5 (1986)).

The repulsion fades near the goal, so that it can be reached beside an obstacle (Ge & Cui, IEEE Trans. Robotics and Automation 16 (2000)).
A field of this kind has minima elsewhere; the descent that ends in one says so.
"""

from math import cos, floor, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.global_planners.grid_planners import over_points
from uvf.planning.global_planners.lines import is_line_free
from uvf.planning.global_planners.planner import GlobalPath, GlobalPlannerSettings, PathQuery, Refusal
from uvf.planning.global_planners.planning_grid import PlanningGrid

Floats = NDArray[np.float64]
Point = tuple[float, float]

INFLUENCE = 1.0  # m from what is impassable, beyond which it does not repel
LEAST_INFLUENCE = 4.0  # cells
NEAREST = 0.25  # cells; nearer obstacles repel as those do
BALANCE = 0.25
"""Share of the influence at which a wall repels as strongly as the goal attracts."""
DIRECTIONS = 32
SMALLEST = 1.0 / 16.0
"""Cells: the shortest step; when none of it leads down, the place is a minimum."""
STUCK = "the descent ends in a local minimum at ({:.2f}, {:.2f}) m, {:.2f} m from the goal; take another planner"


class PotentialField(NamedTuple):
    """``distance`` (rows, columns) [cells] to what is impassable; ``goal`` x, y [cells]; ``influence`` [cells];
    ``gain`` of the repulsion."""

    distance: Floats
    goal: Point
    influence: float
    gain: float


@compiled
def _clearance(distance: Floats, x: float, y: float) -> float:
    """Bilinear, at x, y [cells]; beyond the map 0."""
    rows, columns = distance.shape
    u, v = x - 0.5, y - 0.5
    c, r = floor(u), floor(v)
    s, t = u - c, v - r
    total = 0.0
    for dr in range(2):
        for dc in range(2):
            if 0 <= r + dr < rows and 0 <= c + dc < columns:
                total += (t if dr == 1 else 1.0 - t) * (s if dc == 1 else 1.0 - s) * distance[r + dr, c + dc]
    return total


@compiled
def potential(field: PotentialField, x: float, y: float) -> float:
    """Of a place x, y [cells]: distance to the goal [cells] and repulsion."""
    away = sqrt((x - field.goal[0]) ** 2 + (y - field.goal[1]) ** 2)
    room = max(_clearance(field.distance, x, y) - 0.5, NEAREST)
    if room >= field.influence:
        return away
    fading = min(away / field.influence, 1.0)
    return away + fading * fading * 0.5 * field.gain * (1.0 / room - 1.0 / field.influence) ** 2


@compiled
def descend(field: PotentialField, start: Point, out: Floats) -> tuple[int, bool]:
    """Writes the places of the descent x, y [cells] into ``out`` (n, 2): how many there are, and whether the goal is in reach of the last.

    Steps are a cell long, or shorter where none of that length leads down.
    """
    x, y = start
    here, step, n = potential(field, x, y), 1.0, 1
    out[0, 0], out[0, 1] = x, y
    while n < out.shape[0]:
        away = sqrt((x - field.goal[0]) ** 2 + (y - field.goal[1]) ** 2)
        if away <= 1.5 and is_line_free(field.distance, (x, y), field.goal):
            return n, True
        best, best_x, best_y = here, x, y
        for k in range(DIRECTIONS):
            nx, ny = x + step * cos(k * 2.0 * pi / DIRECTIONS), y + step * sin(k * 2.0 * pi / DIRECTIONS)
            value = potential(field, nx, ny)
            if value < best and is_line_free(field.distance, (x, y), (nx, ny)):
                best, best_x, best_y = value, nx, ny
        if best < here - 1e-3 * step:
            x, y, here = best_x, best_y, best
            out[n, 0], out[n, 1] = x, y
            n += 1
            step = min(2.0 * step, 1.0)
        elif step > SMALLEST:
            step *= 0.5
        else:
            return n, False
    return n, False


class PotentialFieldPlanner:
    """Quick where obstacles are few and convex; elsewhere it often ends in a local minimum, which it tells."""

    def __init__(self, costs: Costmap, settings: GlobalPlannerSettings) -> None:
        """Raises ValueError for a costmap without cells."""
        self._grid = PlanningGrid(costs, settings)

    def plan(self, query: PathQuery) -> GlobalPath:
        """The descent from start to goal."""
        ends = self._grid.ends(query)
        if isinstance(ends, GlobalPath):
            return ends
        start, goal = (self._grid.in_cells(end) for end in ends)
        influence = max(INFLUENCE / self._grid.costs.resolution, LEAST_INFLUENCE)
        near = BALANCE * influence
        gain = near**2 / (1.0 / near - 1.0 / influence)  # the repulsion's slope is gain (1/d - 1/influence) / d^2, the goal's is 1
        room = np.empty((8 * sum(self._grid.free.shape) + 64, 2))
        count, reached = descend(PotentialField(self._grid.distance, goal, influence, gain), start, room)
        if not reached:
            x, y = self._grid.in_metres(room[count - 1 : count])[0].tolist()
            left = float(np.hypot(x - ends[1][0], y - ends[1][1]))
            return GlobalPath(None, Refusal.LOCAL_MINIMUM, STUCK.format(x, y, left))
        return over_points(self._grid, ends, room[1:count])
