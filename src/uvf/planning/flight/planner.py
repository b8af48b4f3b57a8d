"""Ways for aircraft past obstacles, by RRT or RRT*: Dubins curves that climb."""

import itertools
from dataclasses import dataclass
from math import hypot, inf, isfinite, pi, tan

import numpy as np
from numpy.typing import NDArray

from uvf.maths.curves.segments import end_of, moved
from uvf.planning.flight.airspace import Airspace, Space, space_of
from uvf.planning.flight.clearance import STEP, ClearanceMargins, Configuration, outside, room
from uvf.planning.flight.edges import PIECES, Agility
from uvf.planning.flight.growing import DRAWS, Flight, FlightBuffers, at, grow
from uvf.planning.sampling.neighbours import found
from uvf.planning.sampling.planners import Clock
from uvf.planning.sampling.problem import Budget
from uvf.planning.sampling.tree import GOAL, SIZE, CurveTree, tree, way_to

Floats = NDArray[np.float64]

CHUNK = 64  # iterations between looks at the clock
LARGEST = 100_000  # nodes
ABOUT = 8.0  # turning radii about everything, where no fence bounds what is sampled
TURNS, STRIDE = 6.0, 0.15  # turning radii, or part of the way from start to goal, of a step

NOT_FOUND = "no way was found within the budget; one may exist: give more iterations or seconds"


@dataclass(frozen=True)
class FlightLimits:
    """What the aircraft can and keeps: turning ``radius`` [m], ``climb`` and ``sink`` angles [rad], ``aside``, ``above`` [m] as margins.

    Raises ValueError for a radius or angle that is not positive, and a margin that is negative.
    """

    radius: float
    climb: float
    sink: float
    aside: float
    above: float

    def __post_init__(self) -> None:
        if not (0 < self.radius < inf):
            raise ValueError(f"a turning radius of {self.radius:g} m; it must be positive and finite")
        if not (0 < self.climb < pi / 2 and 0 < self.sink < pi / 2):
            raise ValueError(f"angles of {self.climb:g} rad to climb and {self.sink:g} rad to sink; both must be positive, below pi/2")
        if not (0 <= self.aside < inf and 0 <= self.above < inf):
            raise ValueError(f"margins of {self.aside:g} m aside and {self.above:g} m above; neither may be negative")


@dataclass(frozen=True)
class DubinsAirplanePath:
    """``pieces`` (n, 7): x, y, height [m], course [rad] where each begins, length over ground [m], curvature [1/m], climb [m/m].

    ``waypoints`` (k, 4): x, y, height [m], course [rad] of start, nodes and goal; Dubins curves lead from one to the next.
    """

    pieces: Floats
    waypoints: Floats

    @property
    def length(self) -> float:
        """Length over ground [m]."""
        return float(self.pieces[:, 4].sum())

    def sampled(self, spacing: float) -> Floats:
        """Configurations (n, 4): x, y, height [m], course [rad], not wrapped, at most ``spacing`` [m] apart over ground."""
        if not (spacing > 0 and isfinite(spacing)):
            raise ValueError(f"a spacing of {spacing:g} m; it must be positive and finite")
        rows = []
        for x, y, height, course, length, curvature, climb in self.pieces.tolist():
            for s in np.linspace(0.0, length, int(np.ceil(length / spacing)) + 1).tolist():
                x1, y1, course1 = moved(x, y, course, curvature, s)
                rows.append((x1, y1, height + climb * s, course1))
        return np.array(rows) if rows else self.waypoints[:1].copy()


@dataclass(frozen=True)
class FlightPlan:
    """A planner's answer: the ``path``, or None and the ``reason``."""

    path: DubinsAirplanePath | None
    reason: str
    nodes: int
    iterations: int

    @property
    def cost(self) -> float:
        """Length over ground [m], inf without a path."""
        return self.path.length if self.path else inf


def rrt_flight(
    airspace: Airspace, limits: FlightLimits, query: tuple[Configuration, Configuration], budget: Budget, seed: int
) -> FlightPlan:
    """The first way found from start to goal (x, y, height [m], course [rad]) that stays clear; the same for the same ``seed``.

    LaValle's RRT with Dubins airplane edges. Raises ValueError for a query that is not finite, or a budget that makes no sense.
    """
    return _planned(airspace, limits, query, (budget, False), seed)


def rrt_star_flight(
    airspace: Airspace, limits: FlightLimits, query: tuple[Configuration, Configuration], budget: Budget, seed: int
) -> FlightPlan:
    """The shortest way that RRT* finds within the whole budget. Else as ``rrt_flight``."""
    return _planned(airspace, limits, query, (budget, True), seed)


def _planned(
    airspace: Airspace, limits: FlightLimits, query: tuple[Configuration, Configuration], how: tuple[Budget, bool], seed: int
) -> FlightPlan:
    clock, flight = Clock(how[0]), _flight(airspace, limits, query)
    for what, place in (("start", flight.start), ("goal", flight.goal)):
        if why := fault(flight.space, flight.margins, place):
            return FlightPlan(None, f"the {what} {why}", 0, 0)
    capacity = min(how[0].iterations + 4, LARGEST)
    x, y, height, course = flight.start
    grown = tree((x, y, course), capacity, (flight.low[0], flight.low[1]), (flight.high[0], flight.high[1]))
    near = found()
    buffers = FlightBuffers(np.empty(capacity), near, np.empty(near.ids.size), np.zeros((PIECES, 2)), np.zeros((PIECES, 2)))
    buffers.heights[0] = height
    rng, done = np.random.default_rng(seed), 0
    while done < clock.iterations and clock.is_running:
        draws = rng.random((min(CHUNK, clock.iterations - done), DRAWS))
        spent = grow(flight, grown, draws, buffers, how[1])
        done += spent
        if spent < len(draws) or (grown.state[GOAL] >= 0 and not how[1]):
            break
    goal, nodes = int(grown.state[GOAL]), int(grown.state[SIZE])
    if goal < 0:
        return FlightPlan(None, NOT_FOUND, nodes, done)
    return FlightPlan(_path(grown, buffers, goal), "", nodes, done)


def fault(space: Space, margins: ClearanceMargins, place: Configuration) -> str:
    """Why an aircraft may not be at a place; empty if it may."""
    x, y, height, _ = place
    if room(space, margins, (x, y, height), 1.0) >= 0.0:
        return ""
    low, high = space.heights
    if not low + margins.above + STEP / 2 <= height <= high - margins.above - STEP / 2:
        return f"is at {height:g} m; with the margin, heights from {low + margins.above:g} to {high - margins.above:g} m may be flown"
    areas = space.obstacles
    for i in range(len(areas.groups)):
        upright = max(areas.heights[i, 0] - height, height - areas.heights[i, 1])
        gap = outside(areas, i, x, y, inf)
        if upright < margins.above + STEP / 2 and gap < margins.aside + STEP / 2:
            what = "lies within" if upright < 0 and gap < 0 else "is too near to"
            return f"{what} obstacle or excluded zone {i}: margins are {margins.aside:g} m aside and {margins.above:g} m above"
    return f"lies outside of the fence, or is nearer than {margins.aside:g} m to its edge"


def _flight(airspace: Airspace, limits: FlightLimits, query: tuple[Configuration, Configuration]) -> Flight:
    ends = []
    for what, place in zip(("start", "goal"), query, strict=True):
        if len(place) != 4 or not all(isfinite(value) for value in place):
            raise ValueError(f"{what}: {place}; it takes four finite numbers: x, y, height [m], course [rad]")
        ends.append((float(place[0]), float(place[1]), float(place[2]), float(place[3])))
    space, radius = space_of(airspace), limits.radius
    low, high = _sampled_box(space, limits, np.array(ends))
    line = hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1])
    step = max(TURNS * radius, STRIDE * line)
    agility = Agility(float(radius), tan(limits.climb), tan(limits.sink))
    return Flight(space, ClearanceMargins(float(limits.aside), float(limits.above)), agility, ends[0], ends[1], low, high, step)


def _sampled_box(space: Space, limits: FlightLimits, ends: Floats) -> tuple[Floats, Floats]:
    """Lower and upper corner (3,) of where a way may lead: within the fence, or about all that is there; over the highest obstacle."""
    areas = space.fence if len(space.fence.groups) else space.obstacles
    pad = 0.0 if len(space.fence.groups) else ABOUT * limits.radius
    circles = areas.discs
    low = np.vstack((ends[:, :2], circles[:, :2] - circles[:, 2:])).min(axis=0) - pad
    high = np.vstack((ends[:, :2], circles[:, :2] + circles[:, 2:])).max(axis=0) + pad
    heights = space.obstacles.heights[np.isfinite(space.obstacles.heights)]
    margin = limits.above + STEP
    lowest = max(min(float(ends[:, 2].min()), *(heights - margin).tolist(), inf) - limits.radius, space.heights[0] + margin)
    highest = min(max(float(ends[:, 2].max()), *(heights + margin).tolist(), -inf) + limits.radius, space.heights[1] - margin)
    return np.array((*low, min(lowest, highest))), np.array((*high, max(lowest, highest)))


def _path(grown: CurveTree, buffers: FlightBuffers, goal: int) -> DubinsAirplanePath:
    nodes, rows = way_to(grown, goal), []
    for before, after in itertools.pairwise(nodes):
        x, y, height, course = at(grown, buffers, before)
        curve = grown.curves[after]
        climb = (buffers.heights[after] - height) / max(curve[:, 0].sum(), 1e-9)
        for k in np.flatnonzero(curve[:, 0] > 0.0):
            length, curvature = curve[k].tolist()
            rows.append((x, y, height, course, length, curvature, climb))
            x, y, course = end_of((x, y, course), curve[k : k + 1])
            height += climb * length
    waypoints = np.array([at(grown, buffers, i) for i in nodes])
    return DubinsAirplanePath(np.array(rows).reshape(-1, 7), waypoints)
