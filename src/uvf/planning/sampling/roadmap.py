"""PRM and PRM*: a roadmap of free configurations, made once and asked many times.

Kavraki, Svestka, Latombe, Overmars, "Probabilistic roadmaps for path planning in high-dimensional configuration spaces" (1996), with a
fixed number of neighbours; PRM* takes e (1 + 1/d) log n (Karaman & Frazzoli 2011), so that its paths tend to the shortest.
"""

import itertools
from math import ceil, e, log

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import MOST, Triple
from uvf.planning.sampling import neighbours
from uvf.planning.sampling.clearance import Body, ClearanceField, is_clear, is_free_way
from uvf.planning.sampling.neighbours import Buckets, buckets, insert, nearest
from uvf.planning.sampling.pieces import joined, pieces_of
from uvf.planning.sampling.problem import Ground, SamplingPlan, problem
from uvf.planning.sampling.spaces import SteeringSpace, connect, leaving

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

LEAST = 1e-9  # m: an edge of no length would be none
NOT_CONNECTED = "the roadmap does not join start and goal; a way may exist: make it of more nodes or with more neighbours"


class Roadmap:
    """``nodes`` (n, 3) and the free curves between them."""

    def __init__(self, ground: Ground, space: SteeringSpace, size: int, seed: int, count: int | None = None) -> None:
        """A roadmap of ``size`` nodes, each joined with ``count`` neighbours; None: as many as PRM* takes.

        The same for the same ``seed``. Raises ValueError for a size that is not positive, and ground without a free cell.
        """
        if size < 1:
            raise ValueError(f"a roadmap of {size} nodes; it takes at least one")
        self._ground, self._space = ground, space
        dimensions = space.dimensions
        wanted = count if count is not None else ceil(e * (1.0 + 1.0 / dimensions) * log(size + 1))
        self._count = min(max(wanted, 1), neighbours.MOST - 1)
        self.nodes = _free_nodes(ground, size, np.random.default_rng(seed))
        field = ground.field
        rows, columns = field.values.shape
        high = (field.x + columns * field.resolution, field.y + rows * field.resolution)
        self._buckets = buckets(len(self.nodes), (field.x, field.y), high)
        for i in range(len(self.nodes)):
            insert(self._buckets, self.nodes, i)
        edges, lengths = _joined(ground, space, self.nodes, self._buckets, self._count)
        self._edges, once = np.unique(edges, axis=0, return_index=True)
        self._lengths = lengths[once]

    @property
    def edges(self) -> Ints:
        """Pairs (m, 2) of nodes that a curve leads from and to."""
        found: Ints = self._edges
        return found

    def plan(self, start: Triple, goal: Triple) -> SamplingPlan:
        """The shortest way over the roadmap from ``start`` to ``goal`` (x, y [m], heading [rad]), or the reason why there is none."""
        asked = problem(self._ground, self._space, start, goal)
        if isinstance(asked, str):
            return SamplingPlan(None, asked, len(self.nodes), 0)
        n = len(self.nodes)
        nodes = np.vstack((self.nodes, asked.start, asked.goal))
        found = _ends(self._ground, self._space, nodes, self._buckets, self._count)
        edges, lengths = np.vstack((self._edges, found[0])), np.concatenate((self._lengths, found[1]))
        graph = csr_array((lengths, (edges[:, 0], edges[:, 1])), shape=(n + 2, n + 2))
        cost, before = dijkstra(graph, indices=n, return_predecessors=True)
        if not np.isfinite(cost[n + 1]):
            return SamplingPlan(None, NOT_CONNECTED, n, 0)
        way = [n + 1]
        while way[-1] != n:
            way.append(int(before[way[-1]]))
        configurations = [(float(x), float(y), float(heading)) for x, y, heading in nodes[way[::-1]]]
        parts = []
        for a, b in itertools.pairwise(configurations):
            curve = np.zeros((MOST, 2))
            connect(self._space, a, b, curve)
            parts.append(pieces_of(leaving(self._space, a, b), curve))
        return SamplingPlan(joined(parts, asked.goal), "", n, 0)


def _free_nodes(ground: Ground, size: int, rng: np.random.Generator) -> Floats:
    """(n, 3), on free cells; n is ``size``, or less where hardly any heading is free."""
    field, body = ground.field, ground.body
    cells = np.flatnonzero(field.values >= body.radii.min())
    if not len(cells):
        raise ValueError(f"no cell of the field has a clearance of {body.radii.min():g} m, which the body's discs need")
    columns = field.values.shape[1]
    chosen, inner = cells[rng.integers(len(cells), size=8 * size)], rng.random((8 * size, 3))
    nodes = np.column_stack((chosen % columns, chosen // columns, np.zeros(8 * size))) + inner
    nodes[:, :2] = nodes[:, :2] * field.resolution + (field.x, field.y)
    nodes[:, 2] = (inner[:, 2] - 0.5) * 2.0 * np.pi
    free: Floats = nodes[_clear(field, body, nodes)][:size].copy()
    return free


@compiled
def _clear(field: ClearanceField, body: Body, nodes: Floats) -> NDArray[np.bool_]:
    out = np.empty(nodes.shape[0], dtype=np.bool_)
    for i in range(nodes.shape[0]):
        out[i] = is_clear(field, body, (nodes[i, 0], nodes[i, 1], nodes[i, 2]), 1.0)
    return out


@compiled
def _edge(ground: Ground, space: SteeringSpace, nodes: Floats, pair: tuple[int, int], curve: Floats) -> float:
    """Length [m] of the curve from the one node to the other, at least ``LEAST``; 0 where it is not free."""
    a, b = pair
    start, end = (nodes[a, 0], nodes[a, 1], nodes[a, 2]), (nodes[b, 0], nodes[b, 1], nodes[b, 2])
    length = connect(space, start, end, curve)
    return max(length, LEAST) if is_free_way(ground.field, ground.body, leaving(space, start, end), curve, 1.0) else 0.0


@compiled
def _joined(ground: Ground, space: SteeringSpace, nodes: Floats, near: Buckets, count: int) -> tuple[Ints, Floats]:
    """Free curves from each node to its neighbours and back: pairs (m, 2), lengths (m,) [m]."""
    n = nodes.shape[0]
    edges, lengths = np.empty((2 * n * count, 2), dtype=np.int64), np.empty(2 * n * count)
    out, curve = neighbours.found(), np.zeros((MOST, 2))
    m = 0
    for i in range(n):
        found = nearest(near, nodes, (nodes[i, 0], nodes[i, 1], nodes[i, 2]), space.radius, count + 1, out)
        for k in range(found):
            j = int(out.ids[k])
            if j == i:
                continue
            for back in range(2):
                pair = (i, j) if back == 0 else (j, i)
                length = _edge(ground, space, nodes, pair, curve)
                if length > 0.0:
                    edges[m, 0], edges[m, 1], lengths[m] = pair[0], pair[1], length
                    m += 1
    return edges[:m], lengths[:m]


@compiled
def _ends(ground: Ground, space: SteeringSpace, nodes: Floats, near: Buckets, count: int) -> tuple[Ints, Floats]:
    """Free curves from the last node but one to its neighbours, from the neighbours of the last one to it, and between both."""
    n = nodes.shape[0] - 2
    edges, lengths = np.empty((2 * count + 1, 2), dtype=np.int64), np.empty(2 * count + 1)
    out, curve = neighbours.found(), np.zeros((MOST, 2))
    m = 0
    for i in (n, n + 1):
        found = nearest(near, nodes, (nodes[i, 0], nodes[i, 1], nodes[i, 2]), space.radius, count, out)
        for k in range(found):
            j = int(out.ids[k])
            pair = (i, j) if i == n else (j, i)
            length = _edge(ground, space, nodes, pair, curve)
            if length > 0.0:
                edges[m, 0], edges[m, 1], lengths[m] = pair[0], pair[1], length
                m += 1
    length = _edge(ground, space, nodes, (n, n + 1), curve)
    if length > 0.0:
        edges[m, 0], edges[m, 1], lengths[m] = n, n + 1, length
        m += 1
    return edges[:m], lengths[:m]
