"""RRT and RRT* of an aircraft among obstacles: kernels on a tree in the plane, with a height for each node."""

from math import cos, hypot, inf, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import end_of
from uvf.planning.flight.airspace import Space
from uvf.planning.flight.clearance import ClearanceMargins, Configuration, is_clear_way, room
from uvf.planning.flight.edges import PIECES, Agility, edge, needed, plane_length, straight_edge
from uvf.planning.sampling.neighbours import NearestNodes, nearest
from uvf.planning.sampling.tree import GOAL, PARENT, SIZE, CurveTree, add, is_full, lead_anew, put

Floats = NDArray[np.float64]

DRAWS = 7
"""Random numbers that an iteration takes: 0..1."""
GOAL_BIAS = 0.05
LOCAL = 0.3
"""Share of the samples beside the way known, once there is one."""
ALIGNED = 0.5
"""Share of the samples that look the way on which the tree comes to them."""
DIRECT = 0.5
"""Share of the samples at the height that lies between those of start and goal there."""
BETWEEN = 0.5
"""Share of the samples about start and goal, as long as there is no way, where the airspace is much larger."""
CANDIDATES = 8
NOTHING = 1e-6  # m


class Flight(NamedTuple):
    """What kernels need: the airspace, what the aircraft can, and where it goes; samples come from the box ``low`` to ``high`` (3,)."""

    space: Space
    margins: ClearanceMargins
    agility: Agility
    start: Configuration
    goal: Configuration
    low: Floats
    high: Floats
    step: float


class FlightBuffers(NamedTuple):
    """``heights`` (n,) [m] of the tree's nodes, and room for near nodes, costs of ways over them, and two curves (5, 2)."""

    heights: Floats
    near: NearestNodes
    costs: Floats
    curve: Floats
    other: Floats


@compiled
def at(tree: CurveTree, buffers: FlightBuffers, i: int) -> Configuration:
    """The configuration of a node."""
    return tree.nodes[i, 0], tree.nodes[i, 1], buffers.heights[i], tree.nodes[i, 2]


@compiled
def _place(flight: Flight, tree: CurveTree, row: Floats) -> tuple[float, float]:
    """x, y [m] of a sample: in the ellipse over which a way may be shorter than the one known (Gammell 2014), else in the box."""
    low, high, start, goal = flight.low, flight.high, flight.start, flight.goal
    line = hypot(goal[0] - start[0], goal[1] - start[1])
    if tree.state[GOAL] >= 0:
        best = tree.costs[tree.state[GOAL]]
        size, angle, along = sqrt(row[0]), 2.0 * pi * row[1], np.arctan2(goal[1] - start[1], goal[0] - start[0])
        u, v = 0.5 * best * size * cos(angle), 0.5 * sqrt(max(best * best - line * line, 0.0)) * size * sin(angle)
        x, y = 0.5 * (start[0] + goal[0]) + u * cos(along) - v * sin(along), 0.5 * (start[1] + goal[1]) + u * sin(along) + v * cos(along)
        return min(max(x, low[0]), high[0]), min(max(y, low[1]), high[1])
    if row[6] < BETWEEN:
        pad = 0.5 * line + flight.step
        x0, x1 = max(low[0], min(start[0], goal[0]) - pad), min(high[0], max(start[0], goal[0]) + pad)
        y0, y1 = max(low[1], min(start[1], goal[1]) - pad), min(high[1], max(start[1], goal[1]) + pad)
        return x0 + row[0] * (x1 - x0), y0 + row[1] * (y1 - y0)
    return low[0] + row[0] * (high[0] - low[0]), low[1] + row[1] * (high[1] - low[1])


@compiled
def _sample(flight: Flight, tree: CurveTree, row: Floats, buffers: FlightBuffers) -> Configuration:
    low, high, goal = flight.low, flight.high, flight.goal
    known = tree.state[GOAL]
    if known < 0 and row[4] < GOAL_BIAS:
        return goal
    if known >= 0 and row[4] < LOCAL:
        i = known
        steps = int(row[5] * 20.0)
        while steps > 0 and tree.links[i, PARENT] >= 0:
            i, steps = tree.links[i, PARENT], steps - 1
        x, y, height, course = at(tree, buffers, i)
        away, angle = 0.5 * flight.step * row[0], 2.0 * pi * row[1]
        rise = 0.2 * away * (2.0 * row[2] - 1.0)
        return x + away * cos(angle), y + away * sin(angle), min(max(height + rise, low[2]), high[2]), course + row[3] - 0.5
    x, y = _place(flight, tree, row)
    height = low[2] + row[2] * (high[2] - low[2])
    if row[5] < DIRECT:
        back, ahead = hypot(x - flight.start[0], y - flight.start[1]), hypot(x - goal[0], y - goal[1])
        height = flight.start[2] + (goal[2] - flight.start[2]) * back / max(back + ahead, NOTHING)
    course = (row[3] - 0.5) * 2.0 * pi
    if row[3] < ALIGNED:
        nearest(tree.buckets, tree.nodes, (x, y, 0.0), 0.0, 1, buffers.near)
        i = buffers.near.ids[0]
        course = np.arctan2(y - tree.nodes[i, 1], x - tree.nodes[i, 0]) + (row[3] / ALIGNED - 0.5)
    return x, y, height, course


@compiled
def _cut(flight: Flight, here: Configuration, target: Configuration, length: float, curve: Floats) -> tuple[Configuration, float]:
    """Where the curve of a length [m] to ``target`` is after a step and a climb that can be flown, and its length then."""
    wanted = min(length, flight.step)
    done = 0.0
    for k in range(PIECES):
        curve[k, 0] = min(curve[k, 0], wanted - done)
        done += curve[k, 0]
    rise = (target[2] - here[2]) * wanted / length
    if needed(flight.agility, rise) > wanted:
        rise = wanted * (flight.agility.climb if rise > 0.0 else -flight.agility.sink)
    x, y, course = (target[0], target[1], target[3]) if wanted == length else end_of((here[0], here[1], here[3]), curve)
    return (x, y, here[2] + rise, course), wanted


@compiled
def _extend(flight: Flight, tree: CurveTree, target: Configuration, buffers: FlightBuffers) -> tuple[int, Configuration, float]:
    """The node that a new one follows (-1: none), its place, and the length [m] of the curve, which is in ``buffers.curve``."""
    place = (target[0], target[1], target[3])
    count = nearest(tree.buckets, tree.nodes, place, flight.agility.radius, CANDIDATES, buffers.near)
    for k in range(count):
        here = at(tree, buffers, buffers.near.ids[k])
        buffers.costs[k] = max(plane_length(flight.agility, here, target), needed(flight.agility, target[2] - here[2]))
    for _ in range(count if tree.state[GOAL] < 0 else 1):
        k = int(np.argmin(buffers.costs[:count]))
        i, steep = int(buffers.near.ids[k]), buffers.costs[k]
        buffers.costs[k] = inf
        here = at(tree, buffers, i)
        straight_edge(flight.agility, here, target, buffers.curve)
        length: float = buffers.curve[:, 0].sum()
        if length < NOTHING:
            continue
        is_steep = steep > length
        new, length = _cut(flight, here, target, length, buffers.curve)
        if is_clear_way(flight.space, flight.margins, here, buffers.curve, (new[2] - here[2]) / length):
            return i, new, length
        if is_steep:
            # Straight on it comes in too high, or too low: with circles it does not.
            length = edge(flight.agility, here, target, buffers.curve)
            if is_clear_way(flight.space, flight.margins, here, buffers.curve, (target[2] - here[2]) / length):
                return i, target, length
    return -1, target, 0.0


@compiled
def _try_goal(flight: Flight, tree: CurveTree, i: int, buffers: FlightBuffers) -> None:
    """Leads from node ``i`` to the goal, with circles if it must, if that is clear and shorter than any way known."""
    known = tree.state[GOAL]
    best = tree.costs[known] if known >= 0 else inf
    here = at(tree, buffers, i)
    if tree.costs[i] + plane_length(flight.agility, here, flight.goal) >= best:
        return
    length = edge(flight.agility, here, flight.goal, buffers.other)
    cost = tree.costs[i] + length
    slope = (flight.goal[2] - here[2]) / max(length, NOTHING)
    if cost >= best or not is_clear_way(flight.space, flight.margins, here, buffers.other, slope):
        return
    if known < 0:
        new = put(tree, i, (flight.goal[0], flight.goal[1], flight.goal[3]), buffers.other, cost)
        buffers.heights[new], tree.state[GOAL] = flight.goal[2], new
    else:
        lead_anew(tree, known, i, buffers.other, cost)


@compiled
def _edge_cost(flight: Flight, a: Configuration, b: Configuration) -> float:
    """Length [m] of the Dubins path, inf where it would be too steep."""
    length = plane_length(flight.agility, a, b)
    return length if length >= needed(flight.agility, b[2] - a[2]) else inf


@compiled
def _cheapest(flight: Flight, tree: CurveTree, new: Configuration, limit: float, count: int, buffers: FlightBuffers) -> tuple[int, float]:
    """(node, cost [m]) of the neighbour over which the clear way to ``new`` costs least, below ``limit``; -1: none."""
    for k in range(count):
        i = buffers.near.ids[k]
        buffers.costs[k] = tree.costs[i] + _edge_cost(flight, at(tree, buffers, i), new)
    for _ in range(count):
        k = int(np.argmin(buffers.costs[:count]))
        cost, i = buffers.costs[k], int(buffers.near.ids[k])
        if cost >= limit:
            break
        buffers.costs[k] = inf
        here = at(tree, buffers, i)
        length = straight_edge(flight.agility, here, new, buffers.other)
        if is_clear_way(flight.space, flight.margins, here, buffers.other, (new[2] - here[2]) / max(length, NOTHING)):
            buffers.curve[:, :] = buffers.other
            return i, cost
    return -1, limit


@compiled
def _rewire(flight: Flight, tree: CurveTree, new: int, count: int, buffers: FlightBuffers) -> None:
    here = at(tree, buffers, new)
    for k in range(count):
        i = int(buffers.near.ids[k])
        there = at(tree, buffers, i)
        cost = tree.costs[new] + _edge_cost(flight, here, there)
        if i == tree.links[new, PARENT] or cost >= tree.costs[i] - NOTHING:
            continue
        length = straight_edge(flight.agility, here, there, buffers.other)
        if is_clear_way(flight.space, flight.margins, here, buffers.other, (there[2] - here[2]) / max(length, NOTHING)):
            lead_anew(tree, i, new, buffers.other, cost)


@compiled
def grow(flight: Flight, tree: CurveTree, draws: Floats, buffers: FlightBuffers, is_star: bool) -> int:
    """Grows a tree by an iteration for each row of ``draws`` (n, 7): RRT until it reaches the goal, RRT* all the way; iterations done."""
    if tree.state[SIZE] == 1 and draws.shape[0] > 0:
        _try_goal(flight, tree, 0, buffers)
    for k in range(draws.shape[0]):
        known = tree.state[GOAL]
        if is_full(tree) or (known >= 0 and not is_star):
            return k
        best = tree.costs[known] if known >= 0 else inf
        target = _sample(flight, tree, draws[k], buffers)
        if room(flight.space, flight.margins, (target[0], target[1], target[2]), 1.0) < 0.0:
            continue
        parent, new, length = _extend(flight, tree, target, buffers)
        if parent < 0:
            continue
        ahead = plane_length(flight.agility, new, flight.goal)
        cost, count = tree.costs[parent] + length, 0
        if plane_length(flight.agility, flight.start, new) + ahead >= best:
            continue
        if is_star:
            most = int(min(np.ceil(np.e * 4.0 / 3.0 * np.log(tree.state[SIZE] + 1.0)), buffers.near.ids.size))
            count = nearest(tree.buckets, tree.nodes, (new[0], new[1], new[3]), flight.agility.radius, most, buffers.near)
            other, least = _cheapest(flight, tree, new, cost - NOTHING, count, buffers)
            if other >= 0:
                parent, cost = other, least
            if cost + ahead >= best:
                continue
        i = add(tree, parent, (new[0], new[1], new[3]), buffers.curve, cost)
        buffers.heights[i] = new[2]
        _try_goal(flight, tree, i, buffers)
        if is_star:
            _rewire(flight, tree, i, count, buffers)
    return len(draws)
