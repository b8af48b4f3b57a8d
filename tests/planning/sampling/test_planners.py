"""RRT, RRT* and RRT-Connect: ways that hold, none where there is none, better ones with time, the same for a seed."""

import math

import numpy as np
import pytest

from tests.planning.sampling.grounds import blocks, check, wall
from uvf.planning.sampling import Budget, Ground, clearance_field, disc, dubins, plane, rectangle, reeds_shepp, rrt, rrt_connect, rrt_star

PLANNERS = [rrt, rrt_star, rrt_connect]
SPACES = [plane(), dubins(0.5), reeds_shepp(0.5)]
QUERY = ((1.0, 1.0, 0.3), (19.0, 11.0, -0.5))


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("space", SPACES)
def test_every_way_holds(planner, space):
    for world in (1, 2, 3, 4):
        ground = blocks(world)
        plan = planner(ground, space, QUERY, Budget(20_000 if planner is not rrt_star else 6000), 1)
        assert plan.path is not None, plan.reason
        check(ground, space, plan.path, *QUERY)
        assert plan.cost >= math.dist(QUERY[0][:2], QUERY[1][:2])


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("space", SPACES[1:])
def test_a_long_body_turns_where_it_has_room(planner, space):
    ground = wall(slice(40, 60), rectangle(0.5, 0.3, 0.4, 3))
    query = ((2.0, 2.0, math.pi / 2), (8.0, 8.0, math.pi / 2))
    plan = planner(ground, space, query, Budget(8000), 3)
    assert plan.path is not None, plan.reason
    check(ground, space, plan.path, *query)


@pytest.mark.parametrize("planner", PLANNERS)
def test_the_same_seed_the_same_way(planner):
    one, same, other = (planner(blocks(1), dubins(0.5), QUERY, Budget(2500), seed) for seed in (4, 4, 5))
    assert np.array_equal(one.path.pieces, same.path.pieces) and one.nodes == same.nodes
    assert not np.array_equal(one.path.pieces, other.path.pieces)


def test_in_the_plane_rrt_star_comes_near_to_the_shortest_way():
    ground, query = wall(slice(0, 20)), ((2.5, 8.0, 0.0), (7.5, 8.0, 0.0))
    # About the wall's end, by the body's radius and at most a cell.
    shortest = 2 * math.dist((2.5, 8.0), (4.9, 1.85)) + 0.2
    costs = [rrt_star(ground, plane(), query, Budget(n), 0).cost for n in (500, 2000, 8000)]
    assert costs[0] >= costs[1] >= costs[2]
    assert shortest * 0.995 < costs[2] < shortest * 1.02


def test_more_iterations_are_never_worse():
    ground = blocks(2)
    costs = [rrt_star(ground, dubins(0.5), QUERY, Budget(n), 7).cost for n in (1000, 2000, 4000, 8000)]
    assert costs == sorted(costs, reverse=True)
    assert costs[-1] < rrt(ground, dubins(0.5), QUERY, Budget(8000), 7).cost


def test_reeds_shepp_backs_out_of_a_dead_end_that_dubins_cannot_leave():
    occupied = np.ones((60, 100), dtype=bool)
    occupied[10:50, 50:95] = occupied[27:33, 5:50] = False
    ground = Ground(clearance_field(occupied, 0.1), disc(0.1))
    query = ((1.0, 3.0, math.pi), (8.0, 3.0, 0.0))
    backs = rrt_connect(ground, reeds_shepp(0.5), query, Budget(4000), 0)
    assert backs.path is not None and (backs.path.pieces[:, 3] < 0).any()
    check(ground, reeds_shepp(0.5), backs.path, *query)
    stuck = rrt_connect(ground, dubins(0.5), query, Budget(1000), 0)
    assert stuck.path is None and "one may exist" in stuck.reason


@pytest.mark.parametrize("planner", PLANNERS)
def test_why_there_is_no_way(planner):
    ground, budget = wall(slice(0, 0)), Budget(500)
    there = (8.0, 5.0, 0.0)
    assert planner(ground, plane(), ((2.0, 5.0, 0.0), there), budget, 0).reason.startswith("no way leads to the goal")
    assert planner(ground, plane(), ((5.0, 5.0, 0.0), there), budget, 0).reason.startswith("the start is not free: the clearance")
    assert planner(ground, plane(), ((2.0, 5.0, 0.0), (-1.0, 5.0, 0.0)), budget, 0).reason == "the goal lies outside the map"
    narrow = wall(slice(50, 52))
    assert planner(narrow, plane(), ((2.0, 5.0, 0.0), there), budget, 0).path is None
    assert planner(wall(slice(40, 60)), plane(), ((2.0, 5.0, 0.0), there), Budget(0), 0).path is None


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("space", SPACES)
def test_who_is_there_stays(planner, space):
    here = (2.0, 5.0, 1.0)
    plan = planner(wall(slice(0, 0)), space, (here, here), Budget(50), 0)
    assert plan.cost == 0.0
    assert plan.path.sampled(0.1).shape[1] == 4


def test_time_runs_out():
    plan = rrt_star(blocks(1), dubins(0.5), QUERY, Budget(10**9, 0.05), 0)
    assert 0 < plan.iterations < 10**6


@pytest.mark.parametrize(
    ("call", "why"),
    [
        (lambda: rrt(blocks(1), plane(), ((math.nan, 0, 0), QUERY[1]), Budget(1), 0), "start: .* is no configuration"),
        (lambda: rrt(blocks(1), plane(), QUERY, Budget(-1), 0), "a budget of -1 iterations"),
        (lambda: rrt(blocks(1), plane(), QUERY, Budget(1, math.nan), 0), "nan s"),
        (lambda: rrt(blocks(1, rectangle(1, 1, 1, 2)), plane(), QUERY, Budget(1), 0), "a body of one disc"),
        (lambda: dubins(0.0), "turning radius of 0 m"),
    ],
)
def test_what_makes_no_sense_is_refused(call, why):
    with pytest.raises(ValueError, match=why):
        call()
