"""Solids: their bounds hold every point of them, bad measures are refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.maths.scenes import random_directions, random_parts, turn
from uvf.maths.rotations import matrix
from uvf.maths.solids import box, cylinder, joined, mesh, sphere


@settings(deadline=None)
@given(st.integers(0, 10_000))
def test_bounds_hold_all_of_a_solid_and_no_more(seed):
    rng = np.random.default_rng(seed)
    orientation, position = turn(rng), rng.uniform(-3, 3, 3)
    circle = np.linspace(0, 2 * np.pi, 2000)
    ring = np.column_stack((0.4 * np.cos(circle), 0.4 * np.sin(circle), np.ones(2000)))
    edge = np.concatenate((ring, ring * (1, 1, -1))) @ matrix(orientation).T + position
    part = cylinder(0.4, 2.0, position, orientation)
    assert part.low[0] == pytest.approx(edge.min(axis=0), abs=1e-5)
    assert part.high[0] == pytest.approx(edge.max(axis=0), abs=1e-5)
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-0.5, 0.5) for z in (-0.1, 0.1)]) @ matrix(orientation).T + position
    part = box((2, 1, 0.2), position, orientation)
    assert part.low[0] == pytest.approx(corners.min(axis=0))
    assert part.high[0] == pytest.approx(corners.max(axis=0))


def test_the_row_of_a_solid_maps_its_surface_to_the_unit_solid():
    rng = np.random.default_rng(1)
    row = sphere(0.7, (1, 2, 3)).rows[0].reshape(3, 4)
    surface = np.array((1, 2, 3)) + 0.7 * random_directions(rng, 50)
    assert np.linalg.norm(surface @ row[:, :3].T + row[:, 3], axis=1) == pytest.approx(np.ones(50))


def test_joined_keeps_the_order_and_an_empty_list_is_an_empty_table():
    parts = random_parts(np.random.default_rng(2), each=1)
    table = joined(parts)
    assert table.kinds.tolist() == [k for part in parts for k in part.kinds]
    assert table.rows.shape == (len(table.kinds), 12)
    assert joined([]).rows.shape == (0, 12)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: box((1, 0, 1), (0, 0, 0)), "box size must be positive"),
        (lambda: cylinder(0.1, -1.0, (0, 0, 0)), "cylinder radius and height must be positive"),
        (lambda: sphere(float("inf"), (0, 0, 0)), "sphere radius must be positive and finite"),
        (lambda: sphere(1.0, (0, float("nan"), 0)), "pose of a solid must be finite"),
        (lambda: mesh(((0, 0, 0), (1, 0, 0), (0, 1, 0)), ((0, 1, 3),)), "a face names vertex 3"),
        (lambda: mesh(((0, 0, 0), (1, 0, 0), (0, float("nan"), 0)), ((0, 1, 2),)), "not finite"),
    ],
)
def test_measures_that_make_no_solid_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
