"""The tree: every primitive in one leaf, every box round what is below it, a depth that stays small."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.maths.scenes import random_parts, torus
from uvf.maths.bvh import LARGEST_LEAF, build
from uvf.maths.solids import joined, mesh, sphere


def leaves(tree, node=0, above=None):
    """(first, count) of each leaf below a node; checks on the way that boxes hold boxes."""
    bounds = tree.bounds[node]
    if above is not None:
        assert (bounds[:3] >= above[:3]).all()
        assert (bounds[3:] <= above[3:]).all()
    link, count = tree.links[node]
    if count:
        return [(link, count, bounds)]
    return leaves(tree, link, bounds) + leaves(tree, link + 1, bounds)


@settings(deadline=None)
@given(st.integers(0, 10_000), st.integers(0, 10))
def test_every_primitive_lies_in_one_leaf_inside_its_box(seed, each):
    table = joined(random_parts(np.random.default_rng(seed), each))
    tree = build(table)
    place = {row.tobytes(): i for i, row in enumerate(table.rows)}
    seen = []
    for first, count, bounds in leaves(tree):
        for i in range(first, first + count):
            seen.append(place[tree.rows[i].tobytes()])
            assert (table.low[seen[-1]] > bounds[:3]).all()
            assert (table.high[seen[-1]] < bounds[3:]).all()
    assert sorted(seen) == list(range(len(table.kinds)))


def test_a_tree_of_many_triangles_is_shallow_and_has_small_leaves():
    tree = build(mesh(*torus(100, 50)))
    assert len(tree.kinds) == 10_000
    assert tree.depth < 3 * np.log2(10_000)
    assert max(count for _, count, _ in leaves(tree)) <= LARGEST_LEAF


def test_a_hundred_solids_in_one_place_still_make_a_tree():
    tree = build(joined([sphere(1.0, (0, 0, 0))] * 100))
    assert sum(count for _, count, _ in leaves(tree)) == 100
    assert tree.depth < 10


def test_of_nothing_comes_an_empty_tree_and_no_tree_can_be_written_to():
    assert build(joined([])).bounds.shape == (0, 6)
    with pytest.raises(ValueError, match="read-only"):
        build(sphere(1.0, (0, 0, 0))).rows[0, 0] = 2.0
