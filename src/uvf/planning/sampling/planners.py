"""RRT, RRT*, RRT-Connect: ways over ground with obstacles, for points, cars and what only drives forwards."""

import time
from collections.abc import Callable
from math import isnan

import numpy as np
from numpy.typing import NDArray

from uvf.maths.curves.segments import Triple
from uvf.planning.sampling.connecting import grow_rrt_connect
from uvf.planning.sampling.growing import DRAWS, buffers, grow_rrt
from uvf.planning.sampling.optimal import grow_rrt_star
from uvf.planning.sampling.pieces import joined, pieces_back, pieces_there
from uvf.planning.sampling.problem import Budget, Ground, SamplingPlan, SamplingProblem, problem
from uvf.planning.sampling.spaces import SteeringSpace, turned
from uvf.planning.sampling.tree import GOAL, SIZE, CurveTree, tree, way_to

Floats = NDArray[np.float64]
Query = tuple[Triple, Triple]
"""Start and goal: x, y [m, map frame], heading [rad]."""

CHUNK = 128
"""Iterations between looks at the clock."""
LARGEST = 200_000  # nodes of a tree

NOT_FOUND = "no way was found within the budget; one may exist: give more iterations or seconds"
FULL = f"no way was found before the tree was full with {LARGEST} nodes; one may exist"


def rrt(ground: Ground, space: SteeringSpace, query: Query, budget: Budget, seed: int) -> SamplingPlan:
    """The first way that a rapidly-exploring random tree finds (LaValle 1998). The same for the same ``seed``, unless time runs out.

    Raises ValueError for a query or budget that is not finite (``seconds`` may be inf), and a field or body that makes no sense.
    """
    clock, asked = Clock(budget), problem(ground, space, *query)
    if isinstance(asked, str):
        return SamplingPlan(None, asked, 0, 0)
    grown, room = _tree(asked, asked.start, budget), buffers()
    done = _spend(clock, seed, lambda draws, _: (grow_rrt(asked, grown, draws, room), grown.state[GOAL] >= 0))
    return _plan(grown, asked, done)


def rrt_star(ground: Ground, space: SteeringSpace, query: Query, budget: Budget, seed: int) -> SamplingPlan:
    """The shortest way that RRT* finds within the whole budget (Karaman & Frazzoli 2011, informed). Else as ``rrt``."""
    clock, asked = Clock(budget), problem(ground, space, *query)
    if isinstance(asked, str):
        return SamplingPlan(None, asked, 0, 0)
    grown, room = _tree(asked, asked.start, budget), buffers()
    done = _spend(clock, seed, lambda draws, _: (grow_rrt_star(asked, grown, draws, room), False))
    return _plan(grown, asked, done)


def rrt_connect(ground: Ground, space: SteeringSpace, query: Query, budget: Budget, seed: int) -> SamplingPlan:
    """The first way on which trees from both ends meet: mostly far quicker than ``rrt`` (Kuffner & LaValle 2000). Else as ``rrt``."""
    clock, asked = Clock(budget), problem(ground, space, *query)
    if isinstance(asked, str):
        return SamplingPlan(None, asked, 0, 0)
    trees, room = (_tree(asked, asked.start, budget), _tree(asked, turned(space, asked.goal), budget)), buffers()
    met = [(-1, -1)]

    def grow(draws: Floats, turn: int) -> tuple[int, bool]:
        done, met[0] = grow_rrt_connect(asked, trees, draws, room, turn)
        return done, met[0][0] >= 0

    done = _spend(clock, seed, grow)
    nodes = int(trees[0].state[SIZE] + trees[1].state[SIZE])
    here, there = met[0]
    if here < 0:
        return SamplingPlan(None, FULL if nodes > LARGEST else NOT_FOUND, nodes, done)
    pieces = (pieces_there(trees[0], way_to(trees[0], here), space), pieces_back(trees[1], way_to(trees[1], there), space))
    return SamplingPlan(joined(pieces, asked.goal), "", nodes, done)


def _tree(asked: SamplingProblem, root: Triple, budget: Budget) -> CurveTree:
    (rows, columns), side = asked.field.values.shape, asked.field.resolution
    low = (asked.field.x, asked.field.y)
    # Of RRT-Connect an iteration may add as many nodes as there are steps on the longest curve.
    return tree(root, min(8 * budget.iterations + 64, LARGEST), low, (low[0] + columns * side, low[1] + rows * side))


class Clock:
    """When a budget is spent; the time runs from when it is made."""

    def __init__(self, budget: Budget) -> None:
        """Raises ValueError for a negative number of iterations, and for seconds that are NaN."""
        if budget.iterations < 0 or isnan(budget.seconds):
            raise ValueError(f"a budget of {budget.iterations} iterations and {budget.seconds} s; neither may be negative or NaN")
        self.iterations, self._until = budget.iterations, time.perf_counter() + budget.seconds

    @property
    def is_running(self) -> bool:
        """Whether there is time left."""
        return time.perf_counter() < self._until


def _spend(clock: Clock, seed: int, grow: Callable[[Floats, int], tuple[int, bool]]) -> int:
    """Lets a tree grow, by chunks of random numbers, until it says that it is done or the budget is spent; iterations done."""
    rng, done = np.random.default_rng(seed), 0
    while done < clock.iterations and clock.is_running:
        draws = rng.random((min(CHUNK, clock.iterations - done), DRAWS))
        spent, is_done = grow(draws, done)
        done += spent
        if is_done or spent < len(draws):
            break
    return done


def _plan(grown: CurveTree, asked: SamplingProblem, done: int) -> SamplingPlan:
    goal, nodes = int(grown.state[GOAL]), int(grown.state[SIZE])
    if goal < 0:
        return SamplingPlan(None, FULL if nodes >= LARGEST - 2 else NOT_FOUND, nodes, done)
    return SamplingPlan(joined((pieces_there(grown, way_to(grown, goal), asked.space),), asked.goal), "", nodes, done)
