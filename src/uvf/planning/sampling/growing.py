"""How a tree grows: samples, the curve towards one, the attempt to reach the goal. RRT is nothing more (LaValle 1998)."""

from math import atan2, cos, floor, hypot, inf, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import MOST, Triple, end_of
from uvf.planning.sampling.clearance import free_length, is_free_way
from uvf.planning.sampling.neighbours import NearestNodes, found, nearest
from uvf.planning.sampling.problem import SamplingProblem
from uvf.planning.sampling.spaces import PLANE, connect, cut, distance, leaving
from uvf.planning.sampling.tree import GOAL, PARENT, SIZE, CurveTree, add, is_full, lead_anew, node, put

Floats = NDArray[np.float64]

DRAWS = 5
"""Random numbers that an iteration takes: 0..1."""
GOAL_BIAS = 0.05
GUIDED = 0.4
"""Share of the samples beside the guide, as long as there is no way (Palmieri, Koenig, Arras 2016)."""
ALIGNED = 0.5
"""Share of the samples that look the way on which the tree comes to them: a random heading mostly takes a loop to reach."""
LOCAL = 0.3
"""Share of the samples beside the way known (local biasing, Akgun & Stilman 2011), once there is one."""
CANDIDATES = 10
"""Near nodes whose curves are measured; with a turning radius the nearest in the plane is seldom the nearest."""
WORTH = 0.3
"""Of a curve: as much must be free for its free part to be worth a node."""
NOTHING = 1e-6  # m


class GrowthBuffers(NamedTuple):
    """Room for one iteration: near nodes, costs of the ways over each [m] (MOST + 1,), and two curves (5, 2)."""

    near: NearestNodes
    costs: Floats
    curve: Floats
    other: Floats


def buffers() -> GrowthBuffers:
    """Room for the iterations of one planner."""
    near = found()
    return GrowthBuffers(near, np.empty(near.ids.size + 1), np.zeros((MOST, 2)), np.zeros((MOST, 2)))


@compiled
def _somewhere(problem: SamplingProblem, row: Floats) -> Triple:
    """On one of the cells that may be on a way, each as likely."""
    columns = problem.field.values.shape[1]
    part = row[0] * problem.cells.size
    i = min(int(part), problem.cells.size - 1)
    cell = problem.cells[i]
    x = problem.field.x + (cell % columns + part - i) * problem.field.resolution
    y = problem.field.y + (cell // columns + row[1]) * problem.field.resolution
    return x, y, (row[2] - 0.5) * 2.0 * pi


@compiled
def _in_ellipse(problem: SamplingProblem, row: Floats, best: float, least: float) -> Triple:
    """In the ellipse about start and goal over which a way may be shorter than ``best`` [m] (Gammell, Srinivasa, Barfoot 2014)."""
    start, goal = problem.start, problem.goal
    size, angle = sqrt(row[0]), 2.0 * pi * row[1]
    along = 0.5 * best * size * cos(angle)
    aside = 0.5 * sqrt(best * best - least * least) * size * sin(angle)
    c, s = (1.0, 0.0) if least == 0.0 else ((goal[0] - start[0]) / least, (goal[1] - start[1]) / least)
    x, y = 0.5 * (start[0] + goal[0]) + along * c - aside * s, 0.5 * (start[1] + goal[1]) + along * s + aside * c
    return x, y, (row[2] - 0.5) * 2.0 * pi


@compiled
def _beside(problem: SamplingProblem, at: Triple, row: Floats) -> Triple:
    """Within half a step of a configuration, and half a radian."""
    away, angle = 0.5 * problem.step * row[0], 2.0 * pi * row[1]
    return at[0] + away * cos(angle), at[1] + away * sin(angle), at[2] + (row[2] - 0.5)


@compiled
def _beside_way(problem: SamplingProblem, tree: CurveTree, row: Floats) -> Triple:
    """Beside one of the nodes on the way known."""
    count, i = 0, tree.state[GOAL]
    while i >= 0:
        count, i = count + 1, tree.links[i, PARENT]
    i = tree.state[GOAL]
    for _ in range(int(row[4] * count)):
        i = tree.links[i, PARENT]
    return _beside(problem, node(tree, i), row)


@compiled
def draw(problem: SamplingProblem, tree: CurveTree, row: Floats, buffers: GrowthBuffers) -> Triple:
    """A sample from the random numbers ``row`` (5,), in a tree that may know a way to the goal."""
    if tree.state[GOAL] < 0:
        if row[3] < GOAL_BIAS:
            return problem.goal
        if row[3] < GOAL_BIAS + GUIDED and len(problem.guide) > 0:
            at = problem.guide[int(row[4] * len(problem.guide))]
            return _beside(problem, (at[0], at[1], at[2]), row)
        at = _somewhere(problem, row)
    else:
        if row[3] < LOCAL:
            return _beside_way(problem, tree, row)
        best = tree.costs[tree.state[GOAL]]
        least = hypot(problem.goal[0] - problem.start[0], problem.goal[1] - problem.start[1])
        area = pi / 4.0 * best * sqrt(max(best * best - least * least, 0.0))
        is_small = best > least and area < problem.cells.size * problem.field.resolution**2
        at = _in_ellipse(problem, row, best, least) if is_small else _somewhere(problem, row)
    if problem.space.kind != PLANE and row[4] < ALIGNED:
        nearest(tree.buckets, tree.nodes, at, 0.0, 1, buffers.near)
        x, y, _ = node(tree, buffers.near.ids[0])
        at = (at[0], at[1], atan2(at[1] - y, at[0] - x))
    return at


@compiled
def can_be_on_way(problem: SamplingProblem, at: Triple, best: float) -> bool:
    """Whether the way over a place, were nothing in between, is shorter than ``best`` [m], and its cell is not known to be useless."""
    row, column = (at[1] - problem.field.y) / problem.field.resolution, (at[0] - problem.field.x) / problem.field.resolution
    rows, columns = problem.field.values.shape
    if not (0.0 <= row < rows and 0.0 <= column < columns) or problem.field.values[floor(row), floor(column)] < 0.0:
        return False
    if best == inf:
        return True
    return distance(problem.space, problem.start, at) + distance(problem.space, at, problem.goal) < best


@compiled
def closest(problem: SamplingProblem, tree: CurveTree, target: Triple, buffers: GrowthBuffers) -> int:
    """How many near nodes there are; ``buffers.costs`` are the lengths [m] of the curves from them to ``target``."""
    most = 1 if problem.space.kind == PLANE else CANDIDATES
    count = nearest(tree.buckets, tree.nodes, target, problem.weight, most, buffers.near)
    for k in range(count):
        buffers.costs[k] = distance(problem.space, node(tree, buffers.near.ids[k]), target)
    return count


@compiled
def extend(problem: SamplingProblem, tree: CurveTree, target: Triple, facing: float, buffers: GrowthBuffers) -> tuple[int, Triple, float]:
    """A new node on the way from the tree to ``target``: the node that it follows (-1: there is none), its place, and the curve's length.

    The curve, [m] and [1/m], is in ``buffers.curve``; at most a step long, and free. From the near nodes, the one from which the curve is
    shortest first, until one is: where a vehicle has to turn between obstacles, the first one's curve is blocked time and again. Once
    a way is known, only that one: to get anywhere at all is no aim then.
    """
    count = closest(problem, tree, target, buffers)
    for _ in range(count if tree.state[GOAL] < 0 else 1):
        k = np.argmin(buffers.costs[:count])
        buffers.costs[k] = inf
        i = buffers.near.ids[k]
        here = node(tree, i)
        length = connect(problem.space, here, target, buffers.curve)
        if length < NOTHING:
            break
        wanted = cut(buffers.curve, problem.step) if length > problem.step else length
        begin = leaving(problem.space, here, target)
        free = free_length(problem.field, problem.body, begin, buffers.curve, facing)
        if free >= WORTH * wanted:
            if free < wanted:
                wanted = cut(buffers.curve, free)
            return int(i), end_of(begin, buffers.curve), wanted
    return -1, target, 0.0


@compiled
def try_goal(problem: SamplingProblem, tree: CurveTree, i: int, way: float, buffers: GrowthBuffers) -> bool:
    """Leads from node ``i`` to the goal, over ``way`` [m], if that is free and no way known is shorter."""
    known = tree.state[GOAL]
    cost = tree.costs[i] + way
    if known >= 0 and cost >= tree.costs[known]:
        return False
    connect(problem.space, node(tree, i), problem.goal, buffers.other)
    if not is_free_way(problem.field, problem.body, leaving(problem.space, node(tree, i), problem.goal), buffers.other, 1.0):
        return False
    if known < 0:
        tree.state[GOAL] = put(tree, i, problem.goal, buffers.other, cost)
    else:
        lead_anew(tree, known, i, buffers.other, cost)
    return True


@compiled
def grow_rrt(problem: SamplingProblem, tree: CurveTree, draws: Floats, buffers: GrowthBuffers) -> int:
    """Grows a tree by an iteration for each row of ``draws`` (n, 5) until it reaches the goal or is full; iterations done."""
    for k in range(draws.shape[0]):
        if tree.state[GOAL] >= 0 or is_full(tree):
            return k
        if tree.state[SIZE] == 1 and try_goal(problem, tree, 0, distance(problem.space, problem.start, problem.goal), buffers):
            return k + 1
        target = draw(problem, tree, draws[k], buffers)
        i, at, length = extend(problem, tree, target, 1.0, buffers)
        if i >= 0:
            new = add(tree, i, at, buffers.curve, tree.costs[i] + length)
            try_goal(problem, tree, new, distance(problem.space, at, problem.goal), buffers)
    return len(draws)
