"""RRT-Connect: two trees grow towards each other (Kuffner & LaValle, ICRA 2000).

The tree of the goal grows among configurations that look the other way, so that its curves, driven back, lead to the goal.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import Triple, end_of
from uvf.planning.sampling.clearance import free_length
from uvf.planning.sampling.growing import NOTHING, WORTH, GrowthBuffers, closest, draw, extend
from uvf.planning.sampling.problem import SamplingProblem
from uvf.planning.sampling.spaces import connect, cut, leaving, turned
from uvf.planning.sampling.tree import CurveTree, add, is_full, node

Floats = NDArray[np.float64]


@compiled
def _reach(problem: SamplingProblem, tree: CurveTree, target: Triple, facing: float, buffers: GrowthBuffers) -> int:
    """Leads from the tree as far towards ``target`` as is free, a node each step; the node at the target, or -1."""
    count = closest(problem, tree, target, buffers)
    i = int(buffers.near.ids[np.argmin(buffers.costs[:count])])
    while not is_full(tree):
        here = node(tree, i)
        length = connect(problem.space, here, target, buffers.curve)
        wanted = cut(buffers.curve, problem.step) if length > problem.step else length
        begin = leaving(problem.space, here, target)
        free = free_length(problem.field, problem.body, begin, buffers.curve, facing)
        if free < wanted and free < WORTH * wanted:
            return -1
        if free < wanted:
            cut(buffers.curve, free)
            add(tree, i, end_of(begin, buffers.curve), buffers.curve, tree.costs[i] + free)
            return -1
        at = target if wanted == length else end_of(begin, buffers.curve)
        i = add(tree, i, at, buffers.curve, tree.costs[i] + wanted)
        if wanted == length:
            return i
    return -1


@compiled
def grow_rrt_connect(
    problem: SamplingProblem, trees: tuple[CurveTree, CurveTree], draws: Floats, buffers: GrowthBuffers, turn: int
) -> tuple[int, tuple[int, int]]:
    """Grows both trees, each in its turn, until they meet or one is full: iterations done, and the nodes (-1: none) where they met.

    trees: from the start, and from the goal, turned. draws: (n, 5); turn: number of the first iteration, even ones are the start's.
    """
    if turn == 0 and draws.shape[0] > 0:
        met = _reach(problem, trees[1], turned(problem.space, problem.start), -1.0, buffers)
        if met >= 0:
            return 1, (0, met)
    for k in range(draws.shape[0]):
        if is_full(trees[0]) or is_full(trees[1]):
            return k, (-1, -1)
        here, there, facing = (trees[0], trees[1], 1.0) if (turn + k) % 2 == 0 else (trees[1], trees[0], -1.0)
        target = draw(problem, here, draws[k], buffers)
        if facing < 0.0 and target == problem.goal:
            target = turned(problem.space, problem.start)
        i, at, length = extend(problem, here, target, facing, buffers)
        if i < 0 or length < NOTHING:
            continue
        new = add(here, i, at, buffers.curve, here.costs[i] + length)
        met = _reach(problem, there, turned(problem.space, at), -facing, buffers)
        if met >= 0:
            return k + 1, ((new, met) if facing > 0.0 else (met, new))
    return draws.shape[0], (-1, -1)
