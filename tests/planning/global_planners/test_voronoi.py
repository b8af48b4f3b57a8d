"""The skeleton is thin, joined as free ground is, and in the middle; paths over it keep away from walls."""

import numpy as np
import pytest
from scipy import ndimage

from tests.planning.global_planners.worlds import WORLDS, world
from uvf.planning.global_planners.planner import PathQuery
from uvf.planning.global_planners.planners import make_global_planner
from uvf.planning.global_planners.thinning import skeleton

EIGHT = np.ones((3, 3))


@pytest.mark.parametrize("seed", range(8))
def test_it_is_joined_as_free_ground_is(seed):
    free = np.random.default_rng(seed).random((40, 60)) >= 0.05 + 0.06 * seed
    left = skeleton(free)
    assert not (left & ~free).any()
    parts, count = ndimage.label(free)
    of_left, count_left = ndimage.label(left)
    assert count == count_left
    assert all(len(np.unique(of_left[left & (parts == k)])) == 1 for k in range(1, count + 1))
    # As many obstacles are ringed: a hole in the one is a hole in the other.
    beyond = [ndimage.label(np.pad(~mask, 1, constant_values=True), EIGHT)[1] for mask in (free, left)]
    assert beyond[0] == beyond[1]


def test_it_is_the_middle_of_a_corridor():
    for width in (5, 6):
        free = np.zeros((20, 80), dtype=bool)
        free[4 : 4 + width, 2:-2] = True
        rows, columns = np.nonzero(skeleton(free))
        middle = (columns > 10) & (columns < 70)
        assert (np.abs(rows[middle] - (4 + (width - 1) / 2)) <= 0.5).all()
        assert set(columns[middle]) == set(range(11, 70)) and middle.sum() <= 2 * 59


def test_it_is_thin():
    costs, _, _ = world("rooms")
    left = skeleton(costs.passable)
    blocks = left[1:, 1:] & left[:-1, 1:] & left[1:, :-1] & left[:-1, :-1]
    assert 0 < left.sum() < 0.06 * costs.passable.sum() and blocks.sum() < 0.05 * left.sum()


@pytest.mark.parametrize("where", [name for name in WORLDS if name != "open"])
def test_paths_keep_away(where):
    costs, start, goal = world(where)
    room = {}
    for name in ("voronoi", "visibility_graph"):
        path = make_global_planner(name, costs).plan(PathQuery(start, goal)).path
        room[name] = np.mean([costs.clearance_at(costs.cell(x, y)) for x, y, _ in path])
    assert room["voronoi"] > 1.3 * room["visibility_graph"]
