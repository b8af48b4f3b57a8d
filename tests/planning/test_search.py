"""A* and Dijkstra against scipy's Dijkstra on the same graph."""

import resource
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from uvf.planning.search import CostToGo, astar


def reference(cost, start):
    """Costs of the ways by another route: the graph written out edge by edge."""
    rows, columns = cost.shape
    edges = {}
    for r, c in np.argwhere(cost >= 0):
        for dr, dc in ((0, 1), (1, 0), (1, 1), (1, -1)):
            nr, nc = r + dr, c + dc
            if not (0 <= nr < rows and 0 <= nc < columns) or cost[nr, nc] < 0:
                continue
            if dr and dc and (cost[r, nc] < 0 or cost[nr, c] < 0):
                continue
            edges[r * columns + c, nr * columns + nc] = np.hypot(dr, dc) * (cost[r, c] + cost[nr, nc]) / 2
    i, j = np.array(list(edges)).T
    graph = coo_array((list(edges.values()), (i, j)), shape=(cost.size, cost.size))
    return dijkstra(graph, directed=False, indices=start[0] * columns + start[1]).reshape(cost.shape)


def random_costs(seed):
    rng = np.random.default_rng(seed)
    cost = 1.0 + 4.0 * rng.random((25, 31))
    cost[rng.random(cost.shape) < 0.3] = -1.0
    cost[0, 0] = 1.0
    return cost


def cost_along(cost, path):
    steps = np.hypot(*np.diff(path, axis=0).T)
    values = cost[path[:, 0], path[:, 1]]
    return float((steps * (values[1:] + values[:-1]) / 2).sum())


@pytest.mark.parametrize("seed", range(8))
def test_ways_cost_what_dijkstra_says(seed):
    cost = random_costs(seed)
    np.testing.assert_allclose(CostToGo(cost, (0, 0)).cost, reference(cost, (0, 0)))


@pytest.mark.parametrize("seed", range(8))
def test_astar_is_optimal_and_its_path_costs_what_it_says(seed):
    cost = random_costs(seed)
    expected = reference(cost, (0, 0))
    for goal in np.argwhere(cost >= 0)[::17]:
        goal = (int(goal[0]), int(goal[1]))
        found = astar(cost, (0, 0), goal)
        assert (found is not None) == np.isfinite(expected[goal])
        if found is not None:
            path, total = found
            assert total == pytest.approx(expected[goal])
            assert cost_along(cost, path) == pytest.approx(total)
            assert tuple(path[0]) == (0, 0)
            assert tuple(path[-1]) == goal
            assert np.abs(np.diff(path, axis=0)).max(initial=0) <= 1


def test_ways_are_right_when_many_cells_wait_at_a_time():
    cost = 1.0 + 1000.0 * np.random.default_rng(0).random((400, 400)) ** 8
    np.testing.assert_allclose(CostToGo(cost, (200, 200)).cost, reference(cost, (200, 200)))


@contextmanager
def at_most(more):
    """No more memory than this beyond what the process has."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    has = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (has + more, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def test_a_search_takes_little_more_room_than_its_grid():
    cost = np.ones((2500, 2500))
    astar(cost[:9, :9], (0, 0), (8, 8))
    with at_most(5 * cost.nbytes):
        assert astar(cost, (0, 0), (2499, 2499))[1] == pytest.approx(2499 * np.sqrt(2.0))


def test_corners_are_not_cut():
    cost = np.array(((1.0, -1.0), (1.0, 1.0)))
    assert len(astar(cost, (0, 0), (1, 1))[0]) == 3


def test_an_impassable_goal_has_no_way():
    assert astar(np.array(((1.0, -1.0),)), (0, 0), (0, 1)) is None


def test_the_way_to_a_cell_is_the_cheapest_one():
    cost = random_costs(3)
    ways = CostToGo(cost, (0, 0))
    reachable = np.argwhere(np.isfinite(ways.cost))
    goal = tuple(int(i) for i in reachable[-1])
    assert cost_along(cost, ways.to(goal)) == pytest.approx(ways.cost[goal])


@pytest.mark.parametrize("beyond", [(0, 3), (2, 0), (-1, 0), (0, -1)])
def test_a_cell_outside_the_map_is_refused(beyond):
    cost = np.ones((2, 3))
    where = rf"cell \(row {beyond[0]}, column {beyond[1]}\) is outside the map of 2 rows and 3 columns; check its frame"
    with pytest.raises(ValueError, match=f"goal: {where}"):
        astar(cost, (0, 0), beyond)
    with pytest.raises(ValueError, match=f"start: {where}"):
        astar(cost, beyond, (0, 0))
    with pytest.raises(ValueError, match=f"start: {where}"):
        CostToGo(cost, beyond)
    with pytest.raises(ValueError, match=f"goal: {where}"):
        CostToGo(cost, (0, 0)).to(beyond)
