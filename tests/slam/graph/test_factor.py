"""The sparse factorisation against the dense one."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvf.slam.pose_graph.cholesky import factorise, solve
from uvf.slam.pose_graph.fronts import plan, structure
from uvf.slam.pose_graph.linearise import Normal
from uvf.slam.pose_graph.selected import diagonal_of_inverse

PAIRS = st.lists(st.tuples(st.integers(0, 19), st.integers(0, 19)).filter(lambda p: p[0] != p[1]), max_size=60)


def system(n, pairs, fixed, rng):
    """A tree, the blocks of a positive definite matrix on it, and that matrix."""
    found = structure(n, np.array(pairs, dtype=np.int64).reshape(-1, 2), fixed)
    tree = plan(found)
    normal = Normal(np.zeros((n, 3, 3)), np.zeros((len(found.neighbours) // 2, 3, 3)), np.zeros((n, 3)))
    h = np.zeros((n, 3, n, 3))
    for (i, j), slot in zip(pairs, found.slots, strict=True):
        if slot >= 0:
            first, second = (i, j) if tree.place[i] < tree.place[j] else (j, i)
            normal.between[slot] = rng.normal(size=(3, 3))
            h[first, :, second, :] = normal.between[slot]
            h[second, :, first, :] = normal.between[slot].T
    for i in range(n):
        normal.diagonal[i] = 100.0 * np.eye(3)
        h[i, :, i, :] = normal.diagonal[i]
    return tree, normal, h.reshape(3 * n, 3 * n)


def factor(tree, normal, damping=0.0):
    panels, updates = np.empty(tree.panels[-1]), np.empty(tree.updates[-1])
    return factorise(tree, normal, damping, panels, updates), panels


@settings(max_examples=40, deadline=None)
@given(PAIRS, st.integers(0, 19), st.integers(0, 1000))
def test_any_graph_is_solved_as_the_dense_matrix_is(pairs, fixed, seed):
    rng = np.random.default_rng(seed)
    tree, normal, h = system(20, pairs, fixed, rng)
    ok, panels = factor(tree, normal, 0.5)
    assert ok
    right = rng.normal(size=(2, 20, 3))
    expected = np.linalg.solve(h + 0.5 * np.eye(60), right.reshape(2, 60).T).T.reshape(2, 20, 3)
    np.testing.assert_allclose(solve(tree, panels, right), expected, rtol=1e-9, atol=1e-12)


@settings(max_examples=40, deadline=None)
@given(PAIRS)
def test_each_pose_is_eliminated_once_and_pairs_are_told_apart(pairs):
    found = structure(20, np.array(pairs, dtype=np.int64).reshape(-1, 2), 0)
    tree = plan(found)
    assert sorted(tree.pivots) == list(range(20))
    assert sorted(tree.sequence) == list(range(len(tree.sequence)))
    free = [frozenset(p) for p in pairs if 0 not in p]
    assert len(set(free)) == len(found.neighbours) // 2
    assert {(p, s) for p, s in zip(map(frozenset, pairs), found.slots, strict=True) if s >= 0} == {
        (p, s) for p, s in zip(free, [s for s in found.slots if s >= 0], strict=True)
    }


def test_a_chain_stays_as_sparse_as_it_is():
    tree = plan(structure(500, np.array([(k, k + 1) for k in range(499)]), 0))
    assert len(tree.rows) <= 498


def test_a_grid_fills_in_no_more_than_nested_dissection_would_allow():
    side = 30
    across = [(side * r + c, side * r + c + 1) for r in range(side) for c in range(side - 1)]
    down = [(side * r + c, side * (r + 1) + c) for r in range(side - 1) for c in range(side)]
    tree = plan(structure(side * side, np.array(across + down), 0))
    pivots = np.diff(tree.starts)
    blocks = (pivots * (pivots - 1) // 2 + pivots * np.diff(tree.row_starts)).sum()
    assert blocks < 31 / 4 * side**2 * np.log2(side)


def test_a_large_front_is_eliminated_in_panels():
    n = 40
    pairs = [(i, j) for i in range(n) for j in range(i)]
    rng = np.random.default_rng(1)
    tree, normal, h = system(n, pairs, 0, rng)
    ok, panels = factor(tree, normal)
    assert ok
    right = rng.normal(size=(1, n, 3))
    np.testing.assert_allclose(solve(tree, panels, right).ravel(), np.linalg.solve(h, right.ravel()), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("bad", [-1.0, np.nan])
def test_a_matrix_that_is_not_positive_definite_is_told(bad):
    tree, normal, _ = system(5, [(1, 2), (2, 3), (3, 4)], 0, np.random.default_rng(2))
    normal.diagonal[3, 1, 1] = bad
    assert not factor(tree, normal)[0]


@settings(max_examples=40, deadline=None)
@given(PAIRS, st.integers(0, 1000))
def test_the_diagonal_of_the_inverse_is_that_of_the_dense_one(pairs, seed):
    tree, normal, h = system(20, pairs, 0, np.random.default_rng(seed))
    _, panels = factor(tree, normal)
    inverse = np.linalg.inv(h).reshape(20, 3, 20, 3)
    expected = np.array([inverse[k, :, k, :] for k in range(20)])
    np.testing.assert_allclose(diagonal_of_inverse(tree, panels), expected, rtol=1e-9, atol=1e-12)
