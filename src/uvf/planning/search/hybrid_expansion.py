"""The kernel of Hybrid-A*: best-first over (row, column, heading bin), each node with the pose that its way leads to.

Dolgov, Thrun, Montemerlo, Diebel, "Path planning for autonomous vehicles in unknown semi-structured environments", IJRR 29 (2010);
costs and analytic expansion as Nav2's Smac planner has them (Macenski et al., "Open-source, cost-aware kinematically feasible planning").
"""

from math import ceil, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.dubins_words import dubins_segments
from uvf.maths.curves.reeds_shepp_words import reeds_shepp_segments
from uvf.maths.curves.segments import MOST, Triple, moved
from uvf.planning.costmap.headings import HEADINGS, heading_bin
from uvf.planning.search.curve_table import Table, curve_length
from uvf.planning.search.goal_field import GoalField, coarse_index, cost_to_goal
from uvf.planning.search.hybrid_nodes import CLOSED, COST, MOVE, PARENT, STATE, YAW, Nodes, X, Y, put, with_nodes
from uvf.planning.search.motion_primitives import SPACING, Moves
from uvf.planning.search.open_list import Heap, pop, push, with_room
from uvf.planning.search.pose_check import PoseCheck, price_at

Floats = NDArray[np.float64]
Slots = NDArray[np.int32]

EXPANSION_RATIO = 3.5
"""Cells of the estimate for which an analytic expansion waits one node (Smac: ``analytic_expansion_ratio``)."""


class Question(NamedTuple):
    """What is asked: poses [cells, rad], ``radius`` [cells], penalties, ``margin`` [cells] round the outline, and when to stop.

    ``tolerance``: the search ends when no open node promises a way cheaper than the best one by this share; ``approach``: most nodes
    expanded after the first way; ``most``: of all.
    """

    start: Triple
    goal: Triple
    radius: float
    reverses: bool
    penalties: tuple[float, float, float]
    margin: float
    tolerance: float
    approach: int
    most: int


class Knowledge(NamedTuple):
    """What a query works with and does not change but for the field: the ground, primitives, and both estimates."""

    check: PoseCheck
    moves: Moves
    table: Table
    field: GoalField


@compiled
def curve_cost(check: PoseCheck, ask: Question, here: Triple, segments: Floats) -> float:
    """Cost [cells] of driving segments (k, 2) from ``here``; inf where the outline touches an obstacle."""
    reverse, non_straight = ask.penalties[0], ask.penalties[2]
    total = 0.0
    for k in range(segments.shape[0]):
        length, curvature = segments[k, 0], segments[k, 1]
        if length == 0.0:
            continue
        n = ceil(abs(length) / SPACING)
        summed = 0.0
        for i in range(1, n + 1):
            x, y, yaw = moved(here[0], here[1], here[2], curvature, length * i / n)
            price = price_at(check, x, y, yaw, ask.margin)
            if price < 0.0:
                return inf
            summed += price
        here = moved(here[0], here[1], here[2], curvature, length)
        factor = (non_straight if curvature != 0.0 else 1.0) * (reverse if length < 0.0 else 1.0)
        total += summed / n * abs(length) * factor
    return total


@compiled
def curve_to_goal(ask: Question, here: Triple, out: Floats) -> float:
    """Writes the shortest curve to the goal into ``out`` (5, 2) [cells, 1/cell]; its length."""
    if ask.reverses:
        return reeds_shepp_segments(here, ask.goal, ask.radius, out)
    return dubins_segments(here, ask.goal, ask.radius, out)


@compiled
def _estimate(know: Knowledge, ask: Question, heap: Heap, at: Triple) -> tuple[float, Heap]:
    """At least what is left to the goal [cells]; inf where the goal cannot be reached."""
    field = know.field
    i = coarse_index(field.columns, at[0], at[1])
    if field.record.stamp[i] == np.uint32(2 * field.state[2] + 1):
        over_ground = field.record.g[i]
    else:
        over_ground, heap = cost_to_goal(field, heap, i)
    return max(over_ground, curve_length(know.table, at, ask.goal, ask.radius)), heap


@compiled
def _priced(know: Knowledge, ask: Question, here: Triple, move: int) -> float:
    """Mean factor along a primitive from ``here``, negative where it is blocked."""
    shape, total = know.moves.shape, 0.0
    k, n = heading_bin(here[2]), know.moves.shape.shape[2]
    for i in range(n):
        price = price_at(know.check, here[0] + shape[k, move, i, 0], here[1] + shape[k, move, i, 1], shape[k, move, i, 2], ask.margin)
        if price < 0.0:
            return -1.0
        total += price
    mean: float = total / n
    return mean


@compiled
def _way_by(know: Knowledge, ask: Question, at: tuple[Triple, float], moves: tuple[int, int]) -> float:
    """Cost [cells] of the way on by a primitive from a pose that has its cost, after the primitive before (-1: none); inf where blocked."""
    (here, cost), (move, before), made = at, moves, know.moves
    price = _priced(know, ask, here, move)
    if price < 0.0:
        return inf
    factor = made.price[move]
    if before >= 0 and made.curvature[move] * made.curvature[before] < 0.0:
        factor += ask.penalties[1]
    way: float = cost + abs(made.length[move]) * price * factor
    return way


@compiled
def _end_of(know: Knowledge, here: Triple, move: int) -> tuple[Triple, int]:
    """Pose [cells, rad] to which a primitive leads, and its state; -1 outside of the map."""
    shape, (rows, columns) = know.moves.shape, know.check.values.shape
    k, last = heading_bin(here[2]), know.moves.shape.shape[2] - 1
    x, y = here[0] + shape[k, move, last, 0], here[1] + shape[k, move, last, 1]
    state = (int(y) * columns + int(x)) * HEADINGS + ((k + know.moves.turn[move]) & (HEADINGS - 1))
    return (x, y, shape[k, move, last, 2]), state if 0.0 <= x < columns and 0.0 <= y < rows else -1


@compiled
def _state_of(know: Knowledge, at: Triple) -> int:
    """Number of the cell and heading bin of a pose on the map."""
    state: int = (int(at[1]) * know.check.values.shape[1] + int(at[0])) * HEADINGS + heading_bin(at[2])
    return state


@compiled
def search(
    know: Knowledge, ask: Question, nodes: Nodes, heaps: tuple[Heap, Heap], slots: tuple[Slots, int]
) -> tuple[int, float, bool, int, int, Nodes, Heap, Heap]:
    """The node at which the best way leaves the tree (-1: none), its cost [cells], whether a curve leads on from there to the goal, how
    many nodes were made and expanded, the pool and both heaps.

    heaps: open list and that of the field; slots: table of states, and the number that this query's first node has in it.
    """
    (heap, fringe), (slot, base), moves = heaps, slots, know.moves
    p, curve = moves.length.size, np.zeros((MOST, 2))
    at_goal, state = _state_of(know, ask.goal), _state_of(know, ask.start)
    put(nodes, 0, (ask.start[0], ask.start[1], ask.start[2], 0.0), (-1, state, -1))
    slot[state] = base
    key, fringe = _estimate(know, ask, fringe, ask.start)
    count, expanded, wait, limit = 1, 0, 0, ask.most
    best, best_node, by_curve = inf, -1, False
    size = push(heap, 0, key, 0) if key < inf else 0
    while size > 0 and expanded < limit and heap.keys[0] * (1.0 + ask.tolerance) < best:
        key, top = heap.keys[0], int(heap.items[0])
        size = pop(heap, size)
        if nodes.links[top, CLOSED] == 1:
            continue
        nodes.links[top, CLOSED] = 1
        expanded += 1
        here = (nodes.poses[top, X], nodes.poses[top, Y], nodes.poses[top, YAW])
        cost, before = nodes.poses[top, COST], nodes.links[top, MOVE]
        wait -= 1
        if wait <= 0:
            wait = int((key - cost) / EXPANSION_RATIO)
            if cost + curve_to_goal(ask, here, curve) < best:
                total = cost + curve_cost(know.check, ask, here, curve)
                if total < best:
                    limit = min(limit, expanded + ask.approach) if best_node < 0 else limit
                    best, best_node, by_curve = total, top, True
        if nodes.links[top, STATE] == at_goal and cost < best:
            best, best_node, by_curve = cost, top, False
        heap, nodes = with_room(heap, size, p), with_nodes(nodes, count, p)
        for move in range(p):
            to, state = _end_of(know, here, move)
            if state < 0:
                continue
            known, least = slot[state] - base, cost + abs(moves.length[move]) * moves.price[move]
            if known >= 0 and (nodes.links[known, CLOSED] == 1 or nodes.poses[known, COST] <= least):
                continue
            way = _way_by(know, ask, (here, cost), (move, before))
            if way >= best or (known >= 0 and nodes.poses[known, COST] <= way):
                continue
            left, fringe = _estimate(know, ask, fringe, to)
            if way + left >= best:
                continue
            if known < 0:
                known = count
                slot[state] = base + count
                count += 1
            put(nodes, known, (to[0], to[1], to[2], way), (top, state, move))
            size = push(heap, size, way + left, known)
    return best_node, best, by_curve, count, expanded, nodes, heap, fringe


@compiled
def way_to(nodes: Nodes, node: int) -> NDArray[np.int64]:
    """(n,) nodes from the start to ``node``."""
    n, i = 0, node
    while i >= 0:
        n += 1
        i = int(nodes.links[i, PARENT])
    way, i = np.empty(n, dtype=np.int64), node
    while n > 0:
        n -= 1
        way[n] = i
        i = int(nodes.links[i, PARENT])
    return way
