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

    ``tolerance``: the estimate counts for more by this share, and so much may the way found cost more than the cheapest one (weighted A*,
    Pohl 1970); ``approach``: most nodes expanded after the first way; ``most``: of all.
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
def _state(x: float, y: float, heading: int, columns: int) -> int:
    """Number of the state of a place [cells] and a heading bin."""
    return (int(y) * columns + int(x)) * HEADINGS + heading


@compiled
def _root(ask: Question, nodes: Nodes, slots: tuple[Slots, int], columns: int) -> int:
    """Puts the start's node, and tells the state of the goal."""
    state = _state(ask.start[0], ask.start[1], heading_bin(ask.start[2]), columns)
    put(nodes, 0, (ask.start[0], ask.start[1], ask.start[2], 0.0), (-1, state, -1))
    slots[0][state] = slots[1]
    return _state(ask.goal[0], ask.goal[1], heading_bin(ask.goal[2]), columns)


@compiled
def _over_curve(know: Knowledge, ask: Question, here: Triple, curve: Floats, costs: tuple[float, float]) -> float:
    """Cost [cells] of the way by ``here`` and the shortest curve to the goal; inf where that is blocked or not below the second of
    ``costs``, the first being that of the way to ``here``. ``curve`` (5, 2) is room for it."""
    if costs[0] + curve_to_goal(ask, here, curve) >= costs[1]:
        return inf
    return costs[0] + curve_cost(know.check, ask, here, curve)


@compiled
def _over_move(know: Knowledge, ask: Question, here: Triple, moves: tuple[int, int], costs: tuple[float, float]) -> float:
    """Cost [cells] of the way by ``here`` and the second of ``moves``, the first (-1: none) having led to ``here``.

    inf where the primitive is blocked, or the way costs no less than the second of ``costs``; the first is that of the way to ``here``.
    """
    (before, move), known = moves, know.moves
    length, factor = abs(known.length[move]), known.price[move]
    if costs[0] + length * factor >= costs[1]:
        return inf
    price = _priced(know, ask, here, move)
    if price < 0.0:
        return inf
    if before >= 0 and known.curvature[move] * known.curvature[before] < 0.0:
        factor += ask.penalties[1]
    way: float = costs[0] + length * price * factor
    return way if way < costs[1] else inf


@compiled
def search(
    know: Knowledge, ask: Question, nodes: Nodes, heaps: tuple[Heap, Heap], slots: tuple[Slots, int]
) -> tuple[int, float, bool, int, int, Nodes, Heap, Heap]:
    """The node at which the best way leaves the tree (-1: none), its cost [cells], whether a curve leads on from there to the goal, how
    many nodes were made and expanded, the pool and both heaps.

    heaps: open list and that of the field; slots: table of states, and the number that this query's first node has in it.
    """
    (heap, fringe), (slot, base), moves = heaps, slots, know.moves
    columns, last, p = know.check.values.shape[1], know.moves.shape.shape[2] - 1, know.moves.length.size
    curve, at_goal = np.zeros((MOST, 2)), _root(ask, nodes, slots, columns)
    key, fringe = _estimate(know, ask, fringe, ask.start)
    count, expanded, wait, limit = 1, 0, 0, ask.most
    best, best_node, near, near_node = inf, -1, inf, -1
    size = push(heap, 0, key, 0) if key < inf else 0
    while size > 0 and expanded < limit and heap.keys[0] < best:
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
            total = _over_curve(know, ask, here, curve, (cost, best))
            if total < best:
                limit = min(limit, expanded + ask.approach) if best_node < 0 else limit
                best, best_node = total, top
        if nodes.links[top, STATE] == at_goal and near_node < 0:
            near, near_node = cost, top
            limit = min(limit, expanded + ask.approach)
        heap, nodes = with_room(heap, size, p), with_nodes(nodes, count, p)
        k = heading_bin(here[2])
        for move in range(p):
            x, y = here[0] + moves.shape[k, move, last, 0], here[1] + moves.shape[k, move, last, 1]
            if not (0.0 <= x < columns and 0.0 <= y < know.check.values.shape[0]):
                continue
            state = _state(x, y, (k + moves.turn[move]) & (HEADINGS - 1), columns)
            known = slot[state] - base
            if known >= 0 and nodes.links[known, CLOSED] == 1:
                continue
            way = _over_move(know, ask, here, (before, move), (cost, nodes.poses[known, COST] if known >= 0 else inf))
            if way >= best:
                continue
            yaw = moves.shape[k, move, last, 2]
            left, fringe = _estimate(know, ask, fringe, (x, y, yaw))
            if way + left >= best:
                continue
            if known < 0:
                known = count
                slot[state] = base + count
                count += 1
            put(nodes, known, (x, y, yaw, way), (top, state, move))
            size = push(heap, size, way + (1.0 + ask.tolerance) * left, known)
    if best_node < 0:  # no curve leads to the very goal: its cell has to do
        return near_node, near, False, count, expanded, nodes, heap, fringe
    return best_node, best, True, count, expanded, nodes, heap, fringe


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
