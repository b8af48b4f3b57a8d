"""Hybrid-A*: paths that a vehicle with a turning radius can drive, with its whole outline free on each of their poses."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.curves.segments import MOST, Triple, checked_configuration, moved
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.costmap.headings import HEADINGS, STEP
from uvf.planning.search.curve_table import curve_table
from uvf.planning.search.goal_field import begin, coarse_index, goal_field
from uvf.planning.search.goal_room import ENOUGH, states_before
from uvf.planning.search.hybrid_expansion import Knowledge, Question, curve_to_goal, search, way_to
from uvf.planning.search.hybrid_nodes import MOVE, make_nodes
from uvf.planning.search.hybrid_pieces import cut_short, sampled
from uvf.planning.search.motion_primitives import Moves, SteeredVehicle, motion_primitives, shapes
from uvf.planning.search.open_list import make_heap
from uvf.planning.search.pose_check import HALF_CELL, PoseCheck, pose_check, price_at

Floats = NDArray[np.float64]

MOST_EXPANDED = 1_000_000
"""Nodes (Smac: ``max_iterations``)."""
APPROACH = 1_000
"""Nodes expanded after the first way was found, to find a better one (Smac: ``max_on_approach_iterations``)."""
TOLERANCE = 0.05
"""Share of the cheapest way's cost by which a way may cost more; far fewer nodes are expanded so."""
LAST_NUMBER = 2**31 - 2 * MOST_EXPANDED * 6
"""Of a node at a query's begin; the table is cleared after it."""

MOST_CRAMPED = 5_000
"""The same where there is hardly any room to come to the goal."""

TOUCHES = "the vehicle's outline touches an obstacle at the {}"
NO_WAY = "no way leads to the goal: the vehicle does not fit through, or finds no room to turn"
CRAMPED = "no way leads to the goal: driving forwards, the vehicle has no room to come to it in that heading"
GIVEN_UP = f"no way was found with {MOST_EXPANDED} nodes; one may exist"


@dataclass(frozen=True)
class HybridPlan:
    """An answer: ``path`` (n, 3) x, y [m, map frame], yaw [rad], and ``direction`` (n,) of travel, 1 or -1, to each pose;
    or None and the ``reason``. ``cost`` [m] with penalties; ``expanded`` nodes."""

    path: Floats | None
    direction: Floats
    cost: float
    expanded: int
    reason: str = ""


class HybridAStar:
    """Answers queries on one costmap for one vehicle; not for several threads at once, queries share one record.

    factors: (256,) cost factor [-] of each value, 1 or more, negative = impassable.
    """

    def __init__(self, costs: Costmap, factors: Floats, vehicle: SteeredVehicle) -> None:
        if factors.shape != (256,) or not np.isfinite(factors).all() or ((factors >= 0.0) & (factors < 1.0)).any():
            raise ValueError("factors: 256 finite numbers are needed, each 1 or more, or negative for an impassable value")
        if costs.values.size * HEADINGS >= 2**31:
            raise ValueError(f"costs: a map of {costs.values.size} cells; Hybrid-A* takes {2**31 // HEADINGS - 1} at most")
        self._costs, self._vehicle = costs, vehicle
        self._check = pose_check(costs, np.ascontiguousarray(factors, dtype=np.float64))
        self._moves = motion_primitives(vehicle, costs.resolution)
        self._field, self._fringe = goal_field(self._check.factors[costs.values])
        self._nodes, self._heap = make_nodes(), make_heap()
        self._slots, self._next = np.zeros(costs.values.size * HEADINGS, dtype=np.int32), 1
        self._queue = np.empty((ENOUGH, 3))

    def plan(self, start: Triple, goal: Triple) -> HybridPlan:
        """The path from ``start`` to ``goal``, x, y [m, map frame], yaw [rad]. Raises ValueError for what is not finite.

        It ends at the goal, or within its cell and heading bin where there is no room for a curve that leads to it exactly.
        """
        ends = [self._in_cells(what, at) for what, at in (("start", start), ("goal", goal))]
        # Half a cell is kept from obstacles, unless the vehicle already stands nearer or is to stand there.
        for margin in (HALF_CELL, 0.0):
            found = [fault(self._check, what, at, margin) for what, at in zip(("start", "goal"), ends, strict=True)]
            if not any(found):
                return self._search(ends[0], ends[1], margin)
        return HybridPlan(None, np.empty(0), np.inf, 0, found[0] or found[1])

    def _in_cells(self, what: str, at: Triple) -> Triple:
        x, y, yaw = checked_configuration(what, at)
        (x0, y0), resolution = self._costs.origin, self._costs.resolution
        return (x - x0) / resolution, (y - y0) / resolution, yaw

    def _search(self, start: Triple, goal: Triple, margin: float) -> HybridPlan:
        penalties = (self._vehicle.reverse_penalty, self._vehicle.change_penalty, self._vehicle.non_straight_penalty)
        radius = max(self._vehicle.minimum_turning_radius / self._costs.resolution, 1.0)
        ask = Question(start, goal, radius, self._vehicle.reverses, penalties, margin, TOLERANCE, APPROACH, MOST_EXPANDED)
        if self._next > LAST_NUMBER:
            self._slots[:] = 0
            self._next = 1
        cramped = not self._vehicle.reverses and self._is_cramped(ask)
        if cramped:
            ask = ask._replace(most=MOST_CRAMPED)
        know = Knowledge(self._check, _from(self._moves, start[2]), curve_table(self._vehicle.reverses), self._field)
        columns = self._field.columns
        begin(self._field, self._fringe, coarse_index(columns, goal[0], goal[1]), coarse_index(columns, start[0], start[1]))
        heaps, slots = (self._heap, self._fringe), (self._slots, self._next)
        node, cost, by_curve, count, expanded, self._nodes, self._heap, self._fringe = search(know, ask, self._nodes, heaps, slots)
        self._next += count
        if node < 0:
            why = CRAMPED if cramped else GIVEN_UP if expanded >= MOST_EXPANDED else NO_WAY
            return HybridPlan(None, np.empty(0), np.inf, expanded, why)
        pieces, end = self._pieces(ask, node, by_curve)
        pieces, saved = cut_short(self._check, ask, pieces, end)
        path = sampled(pieces, start)
        if by_curve:
            path[-1, :2] = goal[:2]
        path[:, :2] = path[:, :2] * self._costs.resolution + self._costs.origin
        cost = (cost - saved) * self._costs.resolution
        return HybridPlan(np.ascontiguousarray(path[:, :3]), path[:, 3].copy(), cost, expanded)

    def _is_cramped(self, ask: Question) -> bool:
        back = self._moves._replace(length=-self._moves.length, turn=-self._moves.turn)
        states = states_before(self._check, ask, _from(back, ask.goal[2]), (self._slots, self._next), self._queue)
        self._next += 1
        return states < ENOUGH

    def _pieces(self, ask: Question, node: int, by_curve: bool) -> tuple[Floats, Triple]:
        """The way (n, 5) to a node and on to the goal, in pieces, and the pose where it ends; in cells."""
        way, moves = way_to(self._nodes, node), self._moves
        move, here = self._nodes.links[way[1:], MOVE], self._pose(int(way[-1]))
        pieces = [np.column_stack((self._nodes.poses[way[:-1], :3], moves.length[move], moves.curvature[move]))]
        if by_curve:
            curve = np.zeros((MOST, 2))
            curve_to_goal(ask, here, curve)
            for length, curvature in curve[curve[:, 0] != 0.0]:
                pieces.append(np.array([(*here, length, curvature)]))
                here = moved(*here, curvature, length)
        return np.ascontiguousarray(np.vstack(pieces)), here

    def _pose(self, i: int) -> Triple:
        x, y, yaw = self._nodes.poses[i, :3].tolist()
        return x, y, yaw


def _from(moves: Moves, yaw: float) -> Moves:
    """The primitives from each bin's heading turned by as much as ``yaw`` [rad] is off its own."""
    residual = float(np.mod(yaw + STEP / 2, STEP)) - STEP / 2
    return moves._replace(shape=shapes(moves.length, moves.curvature, residual))


def fault(check: PoseCheck, what: str, at: Triple, margin: float) -> str:
    """Why the vehicle cannot be at a pose ``at`` (x, y [cells], yaw [rad]); "" if it can."""
    rows, columns = check.values.shape
    if not (0 <= at[0] < columns and 0 <= at[1] < rows):
        return f"the {what} lies outside the map"
    if check.factors[check.values[int(at[1]), int(at[0])]] < 0.0:
        return f"the {what} lies in an obstacle or too near to one"
    if price_at(check, *at, margin) < 0.0:
        return TOUCHES.format(what)
    return ""
