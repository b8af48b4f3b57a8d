"""Lines of sight against many points on them; the shortest path against the whole visibility graph that shapely makes."""

import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from shapely import box, unary_union
from shapely.geometry import LineString

from tests.planning.global_planners.worlds import SMALL, check, pose, scattered
from tests.planning.search.driving import SIDE, costmap
from uvf.maths.grids import distance_field
from uvf.planning.global_planners.lines import is_line_free
from uvf.planning.global_planners.planner import PathQuery
from uvf.planning.global_planners.planners import make_global_planner
from uvf.planning.global_planners.visibility_graph import corners

HAIR = 1e-5


def field(free):
    return np.ascontiguousarray(distance_field(np.pad(~free, 1, constant_values=True))[1:-1, 1:-1])


@given(seed=st.integers(0, 10**6), share=st.floats(0.0, 0.4), size=st.integers(1, 40))
@settings(max_examples=150, deadline=None, derandomize=True)
def test_a_line_is_free_where_all_its_points_are(seed, share, size):
    rng = np.random.default_rng(seed)
    free = rng.random((size, 30)) >= share
    distance = field(free)
    for _ in range(20):
        a, b = rng.uniform((-0.5, -0.5), (30.5, size + 0.5), (2, 2))
        points = a + np.linspace(0.0, 1.0, 4001)[:, None] * (b - a)
        columns, rows = np.floor(points).astype(int).T
        inside = (columns >= 0) & (columns < 30) & (rows >= 0) & (rows < size)
        expected = bool(inside.all() and free[rows, columns].all())
        found = is_line_free(distance, tuple(a), tuple(b))
        if found != expected:  # it clips a corner between two points
            assert expected and not found
            cut = [np.abs(points - corner).sum(axis=1).min() for corner in np.argwhere(~free)[:, ::-1] + 0.5]
            assert min(cut) < 1.02


def test_a_line_does_not_pass_between_two_cells_that_touch():
    free = np.ones((4, 4), dtype=bool)
    free[1, 2] = free[2, 1] = False
    assert not is_line_free(field(free), (0.5, 0.5), (3.5, 3.5))
    free[2, 1] = True
    assert not is_line_free(field(free), (0.5, 0.5), (3.5, 3.5))  # nor touch a corner
    assert is_line_free(field(free), (0.5, 0.6), (3.4, 3.5))


def test_corners_are_those_of_the_obstacles():
    free = np.ones((6, 7), dtype=bool)
    free[2:4, 3:5] = False
    points, inward = corners(free)
    assert sorted(map(tuple, np.round(points, 2).tolist())) == [(3.0, 2.0), (3.0, 4.0), (5.0, 2.0), (5.0, 4.0)]
    assert (np.sign(np.array((4.0, 3.0)) - points) == inward).all()


def shortest(free, start, goal):
    """Length [cells] of the shortest path between two centres, by the graph of all corners that see each other."""
    blocked = unary_union([box(c, r, c + 1, r + 1) for r, c in np.argwhere(~free)])
    grown, shut = blocked.buffer(HAIR, join_style="mitre"), blocked.buffer(0.9 * HAIR, join_style="mitre")
    parts = getattr(grown, "geoms", [grown])
    rings = [ring for part in parts for ring in (part.exterior, *part.interiors)]
    inside = [(x, y) for ring in rings for x, y in ring.coords[:-1] if 0 < x < free.shape[1] and 0 < y < free.shape[0]]
    nodes = [(start[1] + 0.5, start[0] + 0.5), (goal[1] + 0.5, goal[0] + 0.5), *inside]
    edges = [(i, j, math.dist(a, b)) for (i, a), (j, b) in combinations(enumerate(nodes), 2) if not LineString((a, b)).intersects(shut)]
    if not edges:
        return math.inf
    i, j, length = map(np.array, zip(*edges, strict=True))
    return dijkstra(coo_array((length, (i, j)), shape=(len(nodes),) * 2), directed=False, indices=0)[1]


@pytest.mark.parametrize("seed", range(14))
def test_paths_are_the_shortest(seed):
    costs, cells = scattered(seed, (9, 12), 0.15 + 0.02 * seed)
    planner, rng = make_global_planner("visibility_graph", costs), np.random.default_rng(seed)
    for start, goal in rng.choice(cells, (2, 2)):
        query = PathQuery(pose(start), pose(goal))
        found = planner.plan(query)
        assert found.length / SIDE == pytest.approx(shortest(costs.passable, start, goal), rel=1e-3, abs=1e-9)
        if found.path is not None:
            check(costs, found.path, query.start, query.goal)


def test_ends_lie_anywhere_in_their_cells():
    cells = np.zeros((40, 60), dtype=np.int8)
    cells[:25, 28:32] = 100
    start, goal = (2.013, 0.587, 0.0), (4.099, 0.501, 0.0)
    found = make_global_planner("visibility_graph", costmap(cells, SMALL)).plan(PathQuery(start, goal))
    over = (2.8, 2.5), (3.2, 2.5)
    assert found.length == pytest.approx(math.dist(start[:2], over[0]) + 0.4 + math.dist(over[1], goal[:2]), abs=1e-4)
