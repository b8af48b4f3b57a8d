"""Roadmaps asked more than once, and paths cut short."""

import numpy as np
import pytest

from tests.planning.sampling.grounds import blocks, check, wall
from uvf.planning.sampling import Budget, Roadmap, dubins, plane, reeds_shepp, rrt, shortened

SPACES = [plane(), dubins(0.5), reeds_shepp(0.5)]
QUERY = ((1.0, 1.0, 0.3), (19.0, 11.0, -0.5))


@pytest.mark.parametrize("space", SPACES)
def test_a_roadmap_answers_there_and_back(space):
    ground = blocks(1)
    roadmap = Roadmap(ground, space, 1500, 2)
    for start, goal in (QUERY, QUERY[::-1]):
        plan = roadmap.plan(start, goal)
        assert plan.path is not None, plan.reason
        check(ground, space, plan.path, start, goal)
    assert len(np.unique(roadmap.edges, axis=0)) == len(roadmap.edges)
    assert np.array_equal(roadmap.nodes, Roadmap(ground, space, 1500, 2).nodes)


def test_more_nodes_make_shorter_ways():
    ground = blocks(2)
    costs = [Roadmap(ground, plane(), n, 0).plan(*QUERY).cost for n in (300, 3000)]
    assert costs[1] < costs[0]


def test_a_fixed_number_of_neighbours_makes_fewer_edges():
    ground = blocks(2)
    assert len(Roadmap(ground, plane(), 500, 0, 4).edges) < len(Roadmap(ground, plane(), 500, 0).edges)


def test_no_roadmap_no_way():
    roadmap = Roadmap(wall(slice(0, 0)), plane(), 200, 0)
    assert roadmap.plan((2.0, 5.0, 0.0), (8.0, 5.0, 0.0)).reason.startswith("no way leads to the goal")
    assert Roadmap(wall(slice(48, 53)), plane(), 1, 0).plan((2.0, 8.0, 0.0), (8.0, 8.0, 0.0)).reason.startswith("the roadmap does not join")
    assert roadmap.plan((2.0, 5.0, 0.0), (2.0, 5.0, 0.0)).cost == 0.0
    with pytest.raises(ValueError, match="a roadmap of 0 nodes"):
        Roadmap(wall(slice(0, 0)), plane(), 0, 0)


@pytest.mark.parametrize("space", SPACES)
def test_cut_short_it_is_shorter_and_still_holds(space):
    for seed in (1, 2, 3):
        ground = blocks(seed)
        found = rrt(ground, space, QUERY, Budget(30_000), seed).path
        short = shortened(ground, space, found, 200, seed)
        assert short.length < found.length
        check(ground, space, short, *QUERY)
        assert shortened(ground, space, found, 0, seed).length == pytest.approx(found.length)
        assert shortened(ground, space, short, 200, seed + 1).length <= short.length + 1e-9
