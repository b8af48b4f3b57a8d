"""Dijkstra, A*, jump points and Theta* against scipy's Dijkstra on the same graph, and lines against sampling."""

import resource
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from uvf.planning.costmap.inflation import LETHAL, cost_factors
from uvf.planning.search.grid_search import GridSearch

FACTORS = cost_factors(4.0)
UNIFORM = cost_factors(0.0)


def reference(values, factors, start):
    """Cost of the way from the start to every cell."""
    cost = factors[values]
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
    i, j = zip(*edges, strict=True)
    graph = coo_array((list(edges.values()), (i, j)), shape=(cost.size, cost.size))
    return dijkstra(graph, directed=False, indices=start[0] * columns + start[1]).reshape(cost.shape)


def random_values(seed, shape=(25, 31), share=0.3):
    rng = np.random.default_rng(seed)
    values = rng.integers(0, 253, shape).astype(np.uint8)
    values[rng.random(shape) < share] = LETHAL
    values[0] = values[0] % 253  # a row that leads everywhere
    return values


def cost_along(values, factors, path):
    """Of the steps of a path from cell to cell; infinite if it cuts a corner or leaves free ground."""
    total = 0.0
    for (r, c), (nr, nc) in pairwise(path):
        assert max(abs(nr - r), abs(nc - c)) == 1
        prices = factors[values[r, c]], factors[values[nr, nc]]
        sides = factors[values[r, nc]], factors[values[nr, c]]
        assert min(prices) >= 0 and min(sides) >= 0
        total += np.hypot(nr - r, nc - c) * sum(prices) / 2
    return total


@pytest.mark.parametrize("seed", range(5))
def test_costs_to_everywhere_are_the_reference(seed):
    values = random_values(seed)
    np.testing.assert_allclose(GridSearch(values, FACTORS).cost_to_go((0, 0)).cost, reference(values, FACTORS, (0, 0)))


@pytest.mark.parametrize("method", ["astar", "dijkstra", "jump_points"])
@pytest.mark.parametrize("seed", range(5))
def test_every_search_finds_the_cheapest_path(seed, method):
    values, factors = random_values(seed), UNIFORM if method == "jump_points" else FACTORS
    expected, search = reference(values, factors, (0, 0)), GridSearch(values, factors)
    met = 0
    for goal in map(tuple, np.argwhere(values < LETHAL)[::7]):
        found = getattr(search, method)((0, 0), goal)
        assert (found is None) == np.isinf(expected[goal])
        if found is not None:
            assert found.cost == pytest.approx(expected[goal], rel=1e-6)
            assert cost_along(values, factors, found.cells) == pytest.approx(found.cost)
            assert tuple(found.cells[0]) == (0, 0) and tuple(found.cells[-1]) == goal
            met += 1
    assert met > 20


@pytest.mark.parametrize("share", [0.1, 0.45])
def test_jump_points_on_open_and_on_narrow_ground_between_any_two_places(share):
    values = random_values(11, (40, 37), share)
    search, free = GridSearch(values, UNIFORM), np.argwhere(values < LETHAL)
    rng = np.random.default_rng(2)
    for _ in range(12):
        start = tuple(rng.choice(free))
        expected = reference(values, UNIFORM, start)
        for goal in map(tuple, rng.choice(free, 40)):
            found = search.jump_points(start, goal)
            assert (found.cost if found else np.inf) == pytest.approx(expected[goal], rel=1e-6)


def sampled_cost(values, factors, corners):
    """Of a polyline through cells' centres, by many points on it."""
    total = 0.0
    for a, b in pairwise(corners):
        at = a + (b - a) * ((np.arange(4000) + 0.5) / 4000)[:, None]
        cells = np.floor(at + 0.5).astype(int)
        prices = factors[values[cells[:, 0], cells[:, 1]]]
        assert (prices >= 0).all()
        total += np.hypot(*(b - a)) * prices.mean()
    return total


@pytest.mark.parametrize("factors", [FACTORS, UNIFORM], ids=["costs", "uniform"])
@pytest.mark.parametrize("seed", range(4))
def test_any_angle_paths_cost_no_more_than_those_of_eight_directions_and_are_in_sight(seed, factors):
    values = random_values(seed, (40, 50), 0.12)
    search, better = GridSearch(values, factors), 0
    for goal in map(tuple, np.argwhere(values < LETHAL)[::151]):
        straight, found = search.astar((0, 0), goal), search.theta_star((0, 0), goal)
        assert (straight is None) == (found is None)
        if found is not None and straight is not None:
            assert sampled_cost(values, factors, found.cells) == pytest.approx(found.cost, rel=2e-3, abs=1e-6)
            assert found.cost <= straight.cost * (1.03 if factors is FACTORS else 1.0 + 1e-9)
            better += found.cost < straight.cost
    assert better > 3


def test_a_line_of_sight_does_not_squeeze_between_two_corners():
    values = np.zeros((6, 6), dtype=np.uint8)
    values[2, 3] = values[3, 2] = LETHAL
    found = GridSearch(values, UNIFORM).theta_star((0, 0), (5, 5))
    assert found is not None and found.cost > np.hypot(5, 5) + 0.1


def test_any_angle_in_the_open_is_a_straight_line():
    found = GridSearch(np.zeros((60, 90), dtype=np.uint8), UNIFORM).theta_star((3, 5), (50, 77))
    assert found is not None
    assert found.cells.tolist() == [[3, 5], [50, 77]] and found.cost == pytest.approx(np.hypot(47, 72))


def test_costs_are_right_when_many_cells_wait_at_a_time():
    values = (255 * np.random.default_rng(0).random((400, 400)) ** 8).astype(np.uint8)
    factors = cost_factors(1000.0)
    np.testing.assert_allclose(GridSearch(values, factors).cost_to_go((200, 200)).cost, reference(values, factors, (200, 200)))


def test_one_query_does_not_see_another():
    values = random_values(8)
    kept, free = GridSearch(values, FACTORS), np.argwhere(values < LETHAL)
    rng = np.random.default_rng(1)
    for _ in range(60):
        start, goal = (tuple(p) for p in rng.choice(free, 2))
        for method in ("astar", "theta_star", "jump_points", "dijkstra"):
            again, fresh = getattr(kept, method)(start, goal), getattr(GridSearch(values, FACTORS), method)(start, goal)
            assert (again is None) == (fresh is None)
            assert again is None or again.cells.tolist() == fresh.cells.tolist()


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


def test_a_search_takes_few_bytes_a_cell():
    values = np.zeros((2500, 2500), dtype=np.uint8)
    GridSearch(values[:9, :9], UNIFORM).astar((0, 0), (8, 8))
    with at_most(24 * values.size):
        found = GridSearch(values, UNIFORM).astar((0, 0), (2499, 2499))
    assert found is not None and found.cost == pytest.approx(2499 * np.sqrt(2.0))


@pytest.mark.parametrize("method", ["astar", "jump_points", "theta_star"])
def test_corners_are_not_cut(method):
    values = np.array(((0, LETHAL), (0, 0)), dtype=np.uint8)
    found = getattr(GridSearch(values, UNIFORM), method)((0, 0), (1, 1))
    assert found is not None and found.cost == pytest.approx(2.0)


def test_a_start_in_an_obstacle_leads_nowhere():
    values = random_values(3)
    wall = tuple(np.argwhere(values == LETHAL)[0])
    search = GridSearch(values, FACTORS)
    assert search.astar(wall, (0, 0)) is None and search.theta_star((0, 0), wall) is None
    assert np.isinf(search.cost_to_go(wall).cost).all()


def test_a_path_to_one_place_can_be_read_off():
    values = random_values(3)
    ways = GridSearch(values, FACTORS).cost_to_go((0, 0))
    goal = tuple(np.argwhere(np.isfinite(ways.cost))[-1])
    assert cost_along(values, FACTORS, ways.to(goal)) == pytest.approx(ways.cost[goal])


@pytest.mark.parametrize("beyond", [(-1, 0), (0, 3), (2, 0), (10**9, -(10**9))])
def test_cells_outside_the_map_are_errors(beyond):
    search = GridSearch(np.zeros((2, 3), dtype=np.uint8), UNIFORM)
    with pytest.raises(ValueError, match="2 rows and 3 columns"):
        search.astar((0, 0), beyond)
    with pytest.raises(ValueError, match="outside the map"):
        search.theta_star(beyond, (0, 0))
    with pytest.raises(ValueError, match="outside the map"):
        search.cost_to_go(beyond)
    with pytest.raises(ValueError, match="outside the map"):
        search.cost_to_go((0, 0)).to(beyond)


def test_grids_and_factors_that_are_none_are_errors():
    good = np.zeros((3, 3), dtype=np.uint8)
    for values in (np.zeros((0, 3), dtype=np.uint8), np.zeros(9, dtype=np.uint8), np.zeros((3, 3))):
        with pytest.raises(ValueError, match="a grid"):
            GridSearch(values, UNIFORM)
    for factors in (np.ones(255), np.full(256, np.nan), np.full(256, 0.5)):
        with pytest.raises(ValueError, match="256 finite numbers"):
            GridSearch(good, factors)
    with pytest.raises(ValueError, match="must be impassable"):
        GridSearch(good, np.ones(256))
