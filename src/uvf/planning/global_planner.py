"""From a place to go to, to a path that leads there; and why there is none."""

from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from uvf.planning.costmap.costmap import Costmap, Frame, make_costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import INSCRIBED, Inflation
from uvf.planning.costmap.own_ground import (
    WAY_OUT,
    ground_below,
    leads_away,
    leaving_factors,
    standing_radius,
    widened,
    with_own_ground,
    with_way_out,
)
from uvf.planning.global_planners.planner import GlobalPlannerSettings, PathQuery, Refusal
from uvf.planning.global_planners.planners import make_global_planner
from uvf.planning.navigation.failures import Failure
from uvf.planning.search.grid_search import Cell, CostToGo, GridSearch
from uvf.planning.smoothing import SPACING, length, resample, smoothed

Floats = NDArray[np.float64]
Point = tuple[float, float]

UNKNOWN_COST = 3.0
"""Factor on the cost of unknown ground for goals that may lie behind it."""

SECONDS = 1.0  # wall time that sampling planners may take for a path
FAILURES = {
    Refusal.START_OUTSIDE_MAP: Failure.START_OUTSIDE_MAP,
    Refusal.GOAL_OUTSIDE_MAP: Failure.GOAL_OUTSIDE_MAP,
    Refusal.START_OCCUPIED: Failure.START_OCCUPIED,
    Refusal.GOAL_OCCUPIED: Failure.GOAL_OCCUPIED,
    Refusal.TIMED_OUT: Failure.TIMED_OUT,
}
MOST_CELLS = 8_000_000
"""Of a map, 140 x 140 m in cells of 5 cm: a step that plans over it takes seconds, and one of 6 s is ended."""
MOST_POINTS = 100_000
"""Of a path, as many as a message of it may hold."""
FARTHEST = (MOST_POINTS - 2) * SPACING  # m of way
TOO_LARGE = "the map is too large to plan on"
OUTSIDE = "the vehicle is outside its map: its pose or the map is wrong"
UNMAPPED = "the vehicle stands on ground that is not mapped, and no way leads from there to mapped ground; drive it there by hand"
NO_WAY = "no way leads to the goal"
NOWHERE = "the {} is not a place: its coordinates must be finite"
NO_PLACE = NOWHERE.format("goal")


@dataclass(frozen=True)
class PlannedPath:
    """A path (n, 2) [m, map frame], or None and the reason."""

    path: Floats | None
    reason: str = ""
    failure: Failure = Failure.NONE


@dataclass(frozen=True)
class PlannedBody:
    """The vehicle that paths are planned for, and how they are kept from obstacles."""

    footprint: RobotFootprint
    inflation: Inflation
    cost_travel_multiplier: float = 2.0
    """How much longer a path may be, 1 + this times, to stay out of the highest cost (Nav2's Smac planners)."""
    sensor_offset: float = 0.0  # m from the centre to the lidar that draws the map
    planner: str = "astar"
    """By its name in ``global_planners.planners.PLANNERS``; the hybrid ones need headings and are not for this."""


class GlobalPlanner:
    """Plans on the newest map; all points are (x, y) [m, map frame]."""

    def __init__(self, body: PlannedBody) -> None:
        self._body = body
        self._cells: NDArray[np.int8] | None = None
        self._ways: tuple[Cell, CostToGo] | None = None
        self.costs: Costmap | None = None
        self.missing = "there is no map yet"
        """Why there are no costs, and no ways, while there are none."""

    @property
    def body(self) -> PlannedBody:
        """What paths are planned for."""
        return self._body

    def fit(self, body: PlannedBody) -> bool:
        """Plans for another body from now on; whether that changes anything."""
        if body == self._body:
            return False
        self._body = body
        if self._cells is not None and self.costs is not None:
            self.see(self._cells, self.costs.frame)
        return True

    def see(self, cells: NDArray[np.int8], frame: Frame) -> None:
        """Takes a new map, (rows, columns) of -1 unknown, 0..100 per cent, and computes its costs.

        ``frame``: resolution [m] and origin [m]. On a map of more than ``MOST_CELLS`` cells nothing is planned.
        """
        self._ways = None
        if cells.size > MOST_CELLS:
            self._cells, self.costs = None, None
            self.missing = f"{TOO_LARGE}: {cells.size} cells, {MOST_CELLS} at most"
            return
        self._cells = cells
        self.costs = make_costmap(cells, frame, self._body.footprint, self._body.inflation)

    def stand(self, here: Point) -> bool:
        """Widens the map by unknown ground where the vehicle at ``here`` [m] stands across its edge; whether that was so."""
        costs = self.costs
        if self._cells is None or costs is None or costs.holds(costs.cell(*here)):
            return False
        wider = widened(self._cells, costs.frame, self._standing(costs), here)
        if wider is None:
            return False
        self.see(*wider)
        return True

    def shut_in(self, start: Point) -> str:
        """Why the vehicle at ``start`` cannot drive anywhere; "" if it can."""
        costs, ways = self.costs, self.ways(start)
        if costs is None:
            return self.missing
        if ways is None:
            return OUTSIDE
        cell = costs.cell(*start)
        window, covered = ground_below(costs, cell, self._standing(costs))
        reached = np.isfinite(ways.cost) & costs.passable
        reached[window] &= ~covered
        if reached.any():
            return ""
        if costs.unknown[cell]:
            return UNMAPPED
        if costs.values[cell] < INSCRIBED:
            return "no way leads away from where the vehicle stands; drive it out by hand"
        room = max(costs.clearance_at(cell), 0.0)
        return f"the vehicle is {room:.2f} m from an obstacle, {self._needed:.2f} m are needed; drive it out by hand"

    def ways(self, start: Point) -> CostToGo | None:
        """Cost to go from ``start``, computed once per cell and map; None without a map or outside it."""
        if self.costs is None or not self.costs.holds(self.costs.cell(*start)):
            return None
        cell = self.costs.cell(*start)
        if self._ways is None or self._ways[0] != cell:
            self._ways = cell, GridSearch(self._leaving(self.costs, cell).values, self._factors(False)).cost_to_go(cell)
        return self._ways[1]

    def misplaced(self, point: Point, name: str = "goal") -> str:
        """Why the vehicle cannot stand at ``point`` on known ground; empty if it can. name: what the point is called."""
        costs = self.costs
        if costs is None:
            return self.missing
        if not _is_place(point):
            return NOWHERE.format(name)
        cell = costs.cell(*point)
        if not costs.holds(cell):
            return f"the {name} lies outside the map"
        if costs.unknown[cell]:
            return f"the {name} lies on ground not seen yet"
        if not costs.free[cell]:
            return f"the {name} lies in an obstacle"
        if costs.values[cell] >= INSCRIBED:
            return f"the {name} is {costs.clearance_at(cell):.2f} m from an obstacle, {self._needed:.2f} m are needed"
        return ""

    def refusal(self, start: Point, goal: Point) -> str:
        """Why no path leads from ``start`` to ``goal`` over known ground; empty if one does."""
        if reason := self.misplaced(goal):
            return reason
        costs, ways = self.costs, self.ways(start)
        if costs is None or ways is None:
            return OUTSIDE
        cell = costs.cell(*goal)
        if not np.isfinite(ways.cost[cell]):
            return self.shut_in(start) or NO_WAY
        if ways.cost[cell] * costs.resolution <= FARTHEST:  # a way costs no less than its length
            return ""
        return _too_far(costs.points(ways.to(cell)))

    def plan(self, start: Point, goal: Point, allow_unknown: bool = False) -> PlannedPath:
        """The smoothed path from ``start`` to ``goal``, or the reason why there is none.

        allow_unknown: unknown ground may be crossed, and the goal may lie beyond the map: its nearest cell is taken.
        """
        known = self.costs
        if known is None:
            return PlannedPath(None, self.missing, Failure.NO_MAP)
        if not _is_place(goal):
            return PlannedPath(None, NO_PLACE, Failure.GOAL_OUTSIDE_MAP)
        here = known.cell(*start)
        if not known.holds(here):
            return PlannedPath(None, OUTSIDE, Failure.START_OUTSIDE_MAP)
        there = known.cell(*goal)
        if not known.holds(there) and not allow_unknown:
            return PlannedPath(None, "the goal lies outside the map", Failure.GOAL_OUTSIDE_MAP)
        rows, columns = known.values.shape
        there = (min(max(there[0], 0), rows - 1), min(max(there[1], 0), columns - 1))
        if self._body.planner != "astar":
            return self._otherwise(known, start, there, allow_unknown)
        found = GridSearch(self._leaving(known, here).values, self._factors(allow_unknown)).astar(here, there)
        if found is None:
            return self._no_way(known, start, there)
        points = known.points(found.cells)
        points[0] = start
        if known.holds(known.cell(*goal)):
            points = np.vstack((points[:-1], goal)) if len(points) > 1 else np.array((start, goal))
        too_far = _too_far(points)
        return PlannedPath(None, too_far, Failure.GOAL_TOO_FAR) if too_far else PlannedPath(smoothed(points, known, self._needed))

    def _otherwise(self, known: Costmap, start: Point, there: Cell, allow_unknown: bool) -> PlannedPath:
        """By the planner that was chosen, which makes its own path; from the start to the middle of a cell."""
        x, y = known.points(np.array((there,)))[0].tolist()
        usual = GlobalPlannerSettings(self._body.cost_travel_multiplier, UNKNOWN_COST if allow_unknown else -1.0)
        planner = make_global_planner(self._body.planner, self._leaving(known, known.cell(*start)), usual)
        found = planner.plan(PathQuery((*start, 0.0), (x, y, 0.0), seconds=SECONDS))
        if found.path is not None:
            too_far = _too_far(found.path[:, :2])
            return PlannedPath(None, too_far, Failure.GOAL_TOO_FAR) if too_far else PlannedPath(resample(found.path[:, :2]))
        failure = FAILURES.get(found.refusal, Failure.NO_VALID_PATH) if found.refusal is not None else Failure.NO_VALID_PATH
        return PlannedPath(None, f"{self._body.planner}: {found.reason or failure.value}", failure)

    def _no_way(self, known: Costmap, start: Point, goal: Cell) -> PlannedPath:
        """Why none was found: by where the vehicle stands, by the goal, or by what lies between."""
        if shut_in := self.shut_in(start):
            return PlannedPath(None, shut_in, Failure.START_OCCUPIED)
        if known.values[goal] >= INSCRIBED and not known.unknown[goal]:
            return PlannedPath(None, Failure.GOAL_OCCUPIED.value, Failure.GOAL_OCCUPIED)
        return PlannedPath(None, NO_WAY, Failure.NO_VALID_PATH)

    def _leaving(self, costs: Costmap, start: Cell) -> Costmap:
        """The vehicle may leave a place that is too near to an obstacle, and drive off over unseen ground that it covers itself."""
        opened, radius = with_way_out(costs, start, WAY_OUT), self._standing(costs)
        if leads_away(opened, start, radius):
            return opened
        return with_way_out(with_own_ground(costs, start, radius, self._body.inflation), start, WAY_OUT)

    @property
    def _needed(self) -> float:
        """Distance [m] that the centre keeps from every obstacle."""
        return self._body.footprint.inscribed_radius

    def _standing(self, costs: Costmap) -> float:
        return standing_radius(self._body.footprint.circumscribed_radius, self._body.sensor_offset, costs.resolution)

    def _factors(self, allow_unknown: bool) -> Floats:
        return leaving_factors(self._body.cost_travel_multiplier, UNKNOWN_COST if allow_unknown else -1.0)


def _too_far(points: Floats) -> str:
    """Why a way is not driven for its length; "" if it is."""
    way = length(points)
    return f"the goal is too far to plan: {way / 1000:.1f} km of way, {FARTHEST / 1000:.1f} km at most" if way > FARTHEST else ""


def _is_place(point: Point) -> bool:
    return isfinite(point[0]) and isfinite(point[1])
