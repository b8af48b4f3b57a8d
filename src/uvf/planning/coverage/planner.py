"""Coverage of a field by parallel swaths: the direction, the strips, the order and the way between them.

Each direction is judged by the time of its swaths and turns, the best of them by a whole tour. The boustrophedon cells give the tours
that the search begins with.
"""

import itertools
import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from uvf.planning.coverage.cells import decompose, visiting_order
from uvf.planning.coverage.connections import AirConnections, Connections, GroundConnections, straights
from uvf.planning.coverage.directions import Candidate, best_apart, candidates
from uvf.planning.coverage.field import CoverageField
from uvf.planning.coverage.ground_speed import GroundSpeed
from uvf.planning.coverage.inside import border_passes
from uvf.planning.coverage.leftovers import cut_off, leftover_swaths
from uvf.planning.coverage.ordering import best_tour, rule_orders, tour_cost
from uvf.planning.coverage.plan import HEADLAND, SWATH, TRANSIT, CoveragePlan, swept_along
from uvf.planning.coverage.strips import StripRules, rotated
from uvf.planning.coverage.task import CoverageTask, End
from uvf.planning.coverage.vehicles import GroundVehicle, SurveyAircraft

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

GAP = 0.25  # of the width: an aircraft flies on over shorter gaps without a break
TOURED, TOURED_SHORTEST, REFINED = 8, 6, 3  # directions
SLOWER, MORE = 1.25, 1.5  # times the best by rule of thumb: what takes longer, or has more swaths, gets no tour
MOST_SWATHS = 1_200  # of a tour


def plan_coverage(task: CoverageTask, vehicle: SurveyAircraft | GroundVehicle) -> CoveragePlan:
    """Covers the task's field. Raises ValueError where that cannot be done, or only by more than 1 200 swaths."""
    if isinstance(vehicle, SurveyAircraft):
        return _Aerial(task, vehicle).plan()
    return _Driven(task, vehicle).plan()


@dataclass(frozen=True)
class _Tour:
    """Oriented swaths in order, of ``swaths`` (n, 4) [m], with their connections, and the time [s] that all takes."""

    direction: float
    swaths: Floats
    order: Ints
    connections: Connections
    time: float


def _promising(edges: Floats, speed: GroundSpeed, rules: StripRules, task: CoverageTask) -> list[Candidate]:
    """Candidates worth a tour: those with the shortest swaths, and for the least time those that are the quickest by a rule of thumb."""
    rules = replace(rules, share=task.share)
    shortest = candidates(edges, speed, replace(rules, each=0.0), task.direction)
    if task.least == "swaths":
        return shortest[:1]
    quickest = best_apart(candidates(edges, speed, rules, task.direction), TOURED)
    few = MORE * len(quickest[0].swaths)
    likely = [each for each in quickest if each.time <= SLOWER * quickest[0].time]
    return likely + [each for each in best_apart(shortest, TOURED_SHORTEST) if len(each.swaths) <= few]


def _toured(candidate: Candidate, connections: Connections, task: CoverageTask, edges: Floats) -> _Tour:
    """A tour without restarts, from the back-and-forth orders of the cells."""
    _check_count(candidate, task.width)
    groups = _groups(candidate, edges)
    radius = max(1, len(candidate.swaths) // 2)
    firsts = rule_orders(groups, [skip for skip in range(1, 9) if skip <= radius])
    cost = _costs(connections, task)
    order = best_tour(cost, firsts, task.seed, restarts=False)
    return _Tour(candidate.direction, candidate.swaths, order, connections, tour_cost(order, cost))


def _refined(tour: _Tour, task: CoverageTask) -> _Tour:
    cost = _costs(tour.connections, task)
    order = best_tour(cost, [tour.order], task.seed)
    return _Tour(tour.direction, tour.swaths, order, tour.connections, tour_cost(order, cost))


def _best(tours: list[_Tour], task: CoverageTask) -> _Tour:
    """The quickest of the tours, refined."""
    likely = sorted(tours, key=lambda tour: tour.time)[:REFINED]
    return min((_refined(tour, task) for tour in likely), key=lambda tour: tour.time)


def _check_count(candidate: Candidate, width: float) -> None:
    count = len(candidate.swaths)
    if count > MOST_SWATHS:
        raise ValueError(f"{count} swaths {width:g} m apart would be needed, {MOST_SWATHS} at most; widen the spacing or divide the field")


def _costs(connections: Connections, task: CoverageTask) -> Floats:
    """(2 n + 1, 2 n + 1) s, as ``tour_cost`` wants it."""
    along = connections.along()
    n = len(along)
    cost = np.zeros((n + 1, n + 1))
    cost[:n, :n] = connections.between() + along
    cost[n, :n] = along if task.start is None else connections.from_start(task.start) + along
    if task.end is not None:
        cost[:n, n] = connections.to_end(task.end)
    return cost


def _groups(candidate: Candidate, edges: Floats) -> list[Ints]:
    """Swaths by the cell that they lie in most, cells in the order of a visit."""
    cells = decompose(edges, candidate.direction)
    lines = rotated(candidate.swaths, -candidate.direction)
    owners = np.zeros(len(lines), dtype=np.int64)
    for k, (begin, level, end, _) in enumerate(lines.tolist()):
        shared = [0.0 if (span := cell.span(level)) is None else min(end, span[1]) - max(begin, span[0]) for cell in cells]
        owners[k] = int(np.argmax(shared))
    return [np.flatnonzero(owners == cell) for cell in visiting_order(cells) if (owners == cell).any()]


class _Path:
    """Segments put one behind the other, with their kinds."""

    def __init__(self) -> None:
        self.segments: list[Floats] = [np.empty((0, 5))]
        self.kinds: list[int] = []

    def add(self, segments: Floats, kind: int) -> None:
        self.segments.append(segments)
        self.kinds += [kind] * len(segments)

    def add_tour(self, tour: _Tour, ends: tuple[End | None, End | None], leads: tuple[float, float] = (0.0, 0.0)) -> Floats:
        """The tour with the ways to, between and from its swaths; returns these (n, 4) [m] as they are gone along."""
        oriented = np.array([tour.swaths[each // 2][[2, 3, 0, 1] if each % 2 else [0, 1, 2, 3]] for each in tour.order]).reshape(-1, 4)
        ways, order = tour.connections, tour.order.tolist()
        on = [False, *(ways.straight_on(one, other) for one, other in itertools.pairwise(order)), False]
        for k, swath in enumerate(oriented):
            before = order[k - 1] if k > 0 else ends[0]
            if on[k]:
                self.add(straights(np.array((oriented[k - 1, 2:], swath[:2]))), TRANSIT)
            elif before is not None:
                self.add(ways.way(before, order[k]), TRANSIT)
            self._add_swath(swath, (0.0 if on[k] else leads[0], 0.0 if on[k + 1] else leads[1]))
        if order and ends[1] is not None:
            self.add(ways.way(order[-1], ends[1]), TRANSIT)
        return oriented

    def _add_swath(self, swath: Floats, leads: tuple[float, float]) -> None:
        away = swath[2:] - swath[:2]
        unit = away / np.hypot(*away)
        corners = np.array((swath[:2] - leads[0] * unit, swath[:2], swath[2:], swath[2:] + leads[1] * unit))
        for k, kind in enumerate((TRANSIT, SWATH, TRANSIT)):
            self.add(straights(corners[k : k + 2]), kind)

    def plan(self, task: CoverageTask, swaths: Floats, direction: float, speed: GroundSpeed) -> CoveragePlan:
        """The plan of what has been put together."""
        segments = np.concatenate(self.segments)
        time = sum(speed.time(course, curvature, length) for _, _, course, curvature, length in segments.tolist())
        cells = tuple(decompose(task.field.edges, direction))
        return CoveragePlan(
            task.field, task.width, direction % math.pi, swaths, segments, np.array(self.kinds, dtype=np.int64), time, cells
        )


def _lengthened(swaths: Floats, by: float) -> Floats:
    """Swaths (n, 4) longer by ``by`` [m] at both ends; those without a length of their own get a millimetre."""
    away = swaths[:, 2:] - swaths[:, :2]
    lengths = np.hypot(*away.T)[:, None]
    unit = away / np.maximum(lengths, 1e-12)
    more = unit * np.maximum(by, (1e-3 - lengths) / 2)
    return np.hstack((swaths[:, :2] - more, swaths[:, 2:] + more))


@dataclass(frozen=True)
class _Aerial:
    task: CoverageTask
    vehicle: SurveyAircraft

    def plan(self) -> CoveragePlan:
        edges = self.task.field.edges
        found = _promising(
            edges, self.vehicle.speed, StripRules(self.task.width, self.vehicle.turn_length, GAP * self.task.width), self.task
        )
        tours = [self._tour(each, edges) for each in found]
        best = _best(tours, self.task)
        path = _Path()
        swaths = path.add_tour(best, (self.task.start, self.task.end), (self.vehicle.lead_in, self.vehicle.lead_out))
        return path.plan(self.task, swaths, best.direction, self.vehicle.speed)

    def _tour(self, candidate: Candidate, edges: Floats) -> _Tour:
        swaths = _lengthened(candidate.swaths, self.task.overshoot)
        moved = Candidate(candidate.direction, swaths, candidate.time)
        return _toured(moved, AirConnections(swaths, self.vehicle), self.task, edges)


@dataclass(frozen=True)
class _Driven:
    task: CoverageTask
    vehicle: GroundVehicle

    @cached_property
    def _speed(self) -> GroundSpeed:
        return GroundSpeed(self.vehicle.speed)

    def plan(self) -> CoveragePlan:
        path, field, width = _Path(), self.task.field, self.task.width
        start = self.task.start
        here = next(field.rings)[0] if start is None else np.array((start.x, start.y))
        passes = border_passes(field, width, self.vehicle.headlands, here)
        inner = field.shrunk(self.vehicle.headlands * width) if passes else field
        for ring in passes:
            if start is not None:
                self._join(path, start, End(*ring[0].tolist()))
            path.add(straights(ring), HEADLAND)
            start = End(*ring[-1].tolist())
        tour = self._best_tour(inner, start, self._leftovers(path, inner))
        if tour is None:
            if start is not None and self.task.end is not None:
                self._join(path, start, self.task.end)
            return path.plan(self.task, np.empty((0, 4)), 0.0, self._speed)
        swaths = path.add_tour(tour, (start, self.task.end))
        return path.plan(self.task, swaths, tour.direction, self._speed)

    def _leftovers(self, path: _Path, inner: CoverageField | None) -> Floats:
        """Swaths (n, 4) [m] along what neither the passes along the borders nor swaths ``inner`` of them reach."""
        swept, border = swept_along(np.concatenate(path.segments), self.task.width), self.task.field.area
        if inner is not None:
            swept, border = swept.union(inner.shape.buffer(1e-6)), border - inner.area
        return leftover_swaths(self.task.field, swept, self.task.width, (1.0 - self.task.share) * border)

    def _join(self, path: _Path, start: End, end: End) -> None:
        path.add(GroundConnections(np.empty((0, 4)), self.vehicle, self.task.field, (start, end)).way(start, end), TRANSIT)

    def _best_tour(self, inner: CoverageField | None, start: End | None, leftovers: Floats) -> _Tour | None:
        """The best tour of swaths within ``inner`` and of ``leftovers`` (n, 4) [m]; None where there are none."""
        area = inner or self.task.field
        task = replace(self.task, field=area, start=start)
        rules = StripRules(task.width, task.width + math.pi * self.vehicle.radius)
        found = [Candidate(0.0, np.empty((0, 4)), 0.0)] if inner is None else _promising(area.edges, self._speed, rules, task)
        tours = []
        for each in found:
            swaths = np.concatenate((cut_off(_lengthened(each.swaths, self.task.overshoot), self.task.field), leftovers))
            if len(swaths):
                connections = GroundConnections(swaths, self.vehicle, self.task.field, (start, task.end))
                tours.append(_toured(Candidate(each.direction, swaths, each.time), connections, task, area.edges))
        return _best(tours, task) if tours else None
