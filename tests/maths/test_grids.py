"""The distance field against the definition, cell by cell."""

import numpy as np
from hypothesis import given, settings
from hypothesis.extra.numpy import array_shapes, arrays

from uvf.maths.grids import FAR, distance_field


def brute_force(occupied):
    rows, columns = np.indices(occupied.shape)
    marks = np.argwhere(occupied)
    squares = (rows[..., None] - marks[:, 0]) ** 2 + (columns[..., None] - marks[:, 1]) ** 2
    return np.sqrt(squares.min(axis=-1))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(arrays(np.bool_, array_shapes(min_dims=2, max_dims=2, min_side=1, max_side=14)))
def test_equals_the_distance_to_the_nearest_occupied_cell(occupied):
    if occupied.any():
        np.testing.assert_allclose(distance_field(occupied), brute_force(occupied), atol=1e-9)


def test_a_large_sparse_grid_is_exact_too():
    occupied = np.random.default_rng(3).random((120, 90)) < 0.002
    np.testing.assert_allclose(distance_field(occupied), brute_force(occupied), atol=1e-9)


def test_nothing_occupied_is_far_everywhere():
    assert (distance_field(np.zeros((4, 7), dtype=bool)) == FAR).all()
