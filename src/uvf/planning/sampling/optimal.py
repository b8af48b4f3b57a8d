"""RRT*: each new node takes the cheapest way to it from its neighbours and offers them one over itself.

Karaman & Frazzoli, "Sampling-based algorithms for optimal motion planning", IJRR 30 (2011), with the k nearest neighbours of k-RRT*;
samples from the informed set once there is a solution (Gammell, Srinivasa, Barfoot, "Informed RRT*", IROS 2014).
"""

from math import ceil, e, inf, log

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import Triple
from uvf.planning.sampling.clearance import is_free_way
from uvf.planning.sampling.growing import NOTHING, GrowthBuffers, can_be_on_way, draw, extend, try_goal
from uvf.planning.sampling.neighbours import nearest
from uvf.planning.sampling.problem import SamplingProblem
from uvf.planning.sampling.spaces import PLANE, connect, distance, leaving
from uvf.planning.sampling.tree import GOAL, PARENT, SIZE, CurveTree, add, is_full, lead_anew, node

Floats = NDArray[np.float64]


@compiled
def neighbour_count(problem: SamplingProblem, size: int, most: int) -> int:
    """Neighbours of k-RRT*: e (1 + 1/d) log n, at most ``most``."""
    dimensions = 2.0 if problem.space.kind == PLANE else 3.0
    return int(min(ceil(e * (1.0 + 1.0 / dimensions) * log(size + 1.0)), most))


@compiled
def _cheapest_way(
    problem: SamplingProblem, tree: CurveTree, at: Triple, limit: float, count: int, buffers: GrowthBuffers
) -> tuple[int, float]:
    """(node, cost [m] of the way over it) of the neighbour that leads to ``at`` at the least cost below ``limit``, -1: none.

    The curve is in ``buffers.curve``, left as it was if there is none. Curves are looked at from the cheapest on until one is free.
    """
    for k in range(count):
        i = buffers.near.ids[k]
        buffers.costs[k] = tree.costs[i] + distance(problem.space, node(tree, i), at)
    while True:
        best, least = -1, limit
        for k in range(count):
            if buffers.costs[k] < least:
                best, least = k, buffers.costs[k]
        if best < 0:
            return -1, inf
        buffers.costs[best] = inf
        here = node(tree, buffers.near.ids[best])
        connect(problem.space, here, at, buffers.other)
        if is_free_way(problem.field, problem.body, leaving(problem.space, here, at), buffers.other, 1.0):
            buffers.curve[:, :] = buffers.other
            return int(buffers.near.ids[best]), least


@compiled
def _rewire(problem: SamplingProblem, tree: CurveTree, new: int, count: int, buffers: GrowthBuffers) -> None:
    """Leads to neighbours over the new node where that costs less."""
    at = node(tree, new)
    for k in range(count):
        i = buffers.near.ids[k]
        if i == tree.links[new, PARENT]:
            continue
        cost = tree.costs[new] + distance(problem.space, at, node(tree, i))
        if cost >= tree.costs[i] - NOTHING:
            continue
        connect(problem.space, at, node(tree, i), buffers.other)
        if is_free_way(problem.field, problem.body, leaving(problem.space, at, node(tree, i)), buffers.other, 1.0):
            lead_anew(tree, i, new, buffers.other, cost)


@compiled
def grow_rrt_star(problem: SamplingProblem, tree: CurveTree, draws: Floats, buffers: GrowthBuffers) -> int:
    """Grows a tree by an iteration for each row of ``draws`` (n, 5) until it is full, or no way can be shorter; iterations done."""
    straight = distance(problem.space, problem.start, problem.goal)
    if tree.state[SIZE] == 1 and draws.shape[0] > 0:
        try_goal(problem, tree, 0, straight, buffers)
    for k in range(draws.shape[0]):
        best = tree.costs[tree.state[GOAL]] if tree.state[GOAL] >= 0 else inf
        if is_full(tree) or best <= straight + NOTHING:
            return k
        target = draw(problem, tree, draws[k], buffers)
        if not can_be_on_way(problem, target, best):
            continue
        parent, at, length = extend(problem, tree, target, 1.0, buffers)
        if parent < 0:
            continue
        to_goal = distance(problem.space, at, problem.goal)
        if distance(problem.space, problem.start, at) + to_goal >= best:
            continue
        cost = tree.costs[parent] + length
        count = neighbour_count(problem, tree.state[SIZE], buffers.near.ids.size)
        count = nearest(tree.buckets, tree.nodes, at, problem.weight, count, buffers.near)
        cheaper, least = _cheapest_way(problem, tree, at, cost - NOTHING, count, buffers)
        if cheaper >= 0:
            parent, cost = cheaper, least
        if cost + to_goal >= best:
            continue
        new = add(tree, parent, at, buffers.curve, cost)
        try_goal(problem, tree, new, to_goal, buffers)
        _rewire(problem, tree, new, count, buffers)
    return len(draws)
