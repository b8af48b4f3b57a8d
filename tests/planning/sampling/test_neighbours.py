"""Nearest neighbours against a search through all."""

import numpy as np
import pytest

from uvf.planning.sampling.neighbours import buckets, found, insert, nearest


@pytest.mark.parametrize("weight", [0.0, 0.7])
@pytest.mark.parametrize("size", [1, 3, 50, 3000])
def test_the_nearest_are_those_of_a_search_through_all(weight, size):
    rng = np.random.default_rng(size)
    nodes = np.column_stack((rng.uniform(0, 30, size), rng.normal(10, 2, size), rng.uniform(-9, 9, size)))
    made, out = buckets(size, (0.0, 0.0), (30.0, 20.0)), found()
    for i in range(size):
        insert(made, nodes, i)
    for at in rng.uniform((-3, -3, -9), (33, 23, 9), (60, 3)):
        for most in (1, 7, 20):
            turn = np.mod(nodes[:, 2] - at[2] + np.pi, 2 * np.pi) - np.pi
            keys = np.sort(((nodes[:, :2] - at[:2]) ** 2).sum(axis=1) + (weight * turn) ** 2)[:most]
            count = nearest(made, nodes, tuple(at.tolist()), weight, most, out)
            assert count == min(most, size)
            assert out.keys[:count] == pytest.approx(keys)
            assert len(set(out.ids[:count].tolist())) == count


def test_nodes_that_were_left_out_are_never_found():
    nodes = np.column_stack((np.arange(500.0), np.zeros(500), np.zeros(500)))
    made, out = buckets(500, (0.0, 0.0), (500.0, 3.0)), found()
    for i in range(0, 500, 2):
        insert(made, nodes, i)
    for x in range(0, 500, 7):
        count = nearest(made, nodes, (float(x), 0.0, 0.0), 0.0, 5, out)
        assert (out.ids[:count] % 2 == 0).all()
