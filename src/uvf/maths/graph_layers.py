"""Layers of a directed graph for drawing data flow: edges lead to later layers, but for those that close cycles."""

from collections.abc import Mapping, Sequence

Edges = Mapping[tuple[str, str], float]
"""(from, to) -> weight; an edge from a node to itself counts for nothing."""
SWEEPS = 4


def flow_order(nodes: Sequence[str], edges: Edges) -> list[str]:
    """The nodes in an order in which few edges, by weight, lead backwards: the heuristic of Eades, Lin and Smyth (1993).

    Sinks go last, sources first, and where there is neither, the node whose edges lead outwards most.
    """
    left = dict.fromkeys(nodes)
    out = dict.fromkeys(nodes, 0.0)
    into = dict.fromkeys(nodes, 0.0)
    neighbours: dict[str, list[tuple[str, bool, float]]] = {node: [] for node in nodes}
    for (a, b), weight in edges.items():
        if a != b:
            out[a] += weight
            into[b] += weight
            neighbours[a].append((b, True, weight))
            neighbours[b].append((a, False, weight))
    first: list[str] = []
    last: list[str] = []
    while left:
        sink = next((node for node in left if out[node] <= 0.0 < into[node]), None)
        taken = sink or next((node for node in left if into[node] <= 0.0), None) or max(left, key=lambda node: out[node] - into[node])
        (last if sink else first).append(taken)
        del left[taken]
        for other, leads_there, weight in neighbours[taken]:
            (into if leads_there else out)[other] -= weight
    return first + last[::-1]


def layers(nodes: Sequence[str], edges: Edges) -> dict[str, int]:
    """Layer of each node, from 0: the longest path to it over the edges that lead forwards in ``flow_order``."""
    order = flow_order(nodes, edges)
    place = {node: i for i, node in enumerate(order)}
    forward: dict[str, list[str]] = {node: [] for node in order}
    for a, b in edges:
        if place[a] < place[b]:
            forward[a].append(b)
    layer = dict.fromkeys(order, 0)
    for node in order:
        for after in forward[node]:
            layer[after] = max(layer[after], layer[node] + 1)
    return layer


def arranged(layer: Mapping[str, int], edges: Edges) -> list[list[str]]:
    """The nodes of each layer in an order that crosses few edges: each near the middle of its neighbours (barycentre sweeps)."""
    rows: list[list[str]] = [[] for _ in range(max(layer.values(), default=-1) + 1)]
    for node in sorted(layer):
        rows[layer[node]].append(node)
    beside: dict[str, list[str]] = {node: [] for node in layer}
    for a, b in edges:
        beside[a].append(b)
        beside[b].append(a)
    place = _places(rows)
    for sweep in range(SWEEPS):
        for row in rows if sweep % 2 == 0 else rows[::-1]:
            middle = {n: sum(place[m] for m in beside[n]) / len(beside[n]) if beside[n] else place[n] for n in row}
            row.sort(key=lambda n: (middle[n], n))
            place |= _places([row])
    return rows


def _places(rows: Sequence[Sequence[str]]) -> dict[str, float]:
    """Place of each node within its row, 0..1."""
    return {node: (i + 0.5) / len(row) for row in rows for i, node in enumerate(row)}
