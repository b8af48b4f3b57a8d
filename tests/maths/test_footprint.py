"""Footprints against points drawn inside the solids, against shadows known by hand, and as meshes."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.maths.scenes import turn
from uvf.maths.bvh import build
from uvf.maths.footprint import covered, footprint, segments
from uvf.maths.rotations import from_euler, matrix
from uvf.maths.solids import box, cylinder, joined, mesh, sphere

CELL = 0.1  # m
SIZE = (60, 60)
CORNER = (-3.0, -3.0)


def grid(part, low, high):
    return covered(footprint(part, low, high), CORNER, CELL, SIZE)


def cell_of(points):
    return ((points[:, 1] - CORNER[1]) / CELL).astype(int), ((points[:, 0] - CORNER[0]) / CELL).astype(int)


def points_inside(part, n=100_000):
    """Points drawn evenly from the inside of a box, cylinder or sphere, by its definition."""
    points = np.random.default_rng(0).uniform(part.low[0], part.high[0], (n, 3))
    u = np.abs(points @ part.rows[0].reshape(3, 4)[:, :3].T + part.rows[0].reshape(3, 4)[:, 3])
    reach = (u.max(axis=1), np.maximum(np.hypot(u[:, 0], u[:, 1]), u[:, 2]), np.linalg.norm(u, axis=1))[part.kinds[0]]
    return points[reach < 1]


def test_a_box_covers_its_cells_and_not_those_that_it_touches():
    cells = grid(box((2.0, 1.0, 1.0), (0, 0, 0.5)), 0.1, 0.4)
    expected = np.zeros(SIZE, dtype=bool)
    expected[25:35, 20:40] = True
    assert np.array_equal(cells, expected)


def test_what_is_above_below_or_only_touches_the_heights_leaves_no_shadow():
    table = joined([box((1, 1, 1), (0, 0, 0.5)), cylinder(0.5, 1.0, (0, 0, 0.5)), sphere(0.5, (0, 0, 0.5))])
    assert not grid(table, 1.0, 2.0).any()
    assert not grid(table, -1.0, 0.0).any()
    assert grid(table, 0.9, 2.0).any()


def test_a_sphere_cut_off_its_middle_leaves_the_smaller_disc():
    assert footprint(sphere(0.5, (1, 2, 0)), 0.3, 0.8).discs == pytest.approx(np.array([[1, 2, 0.4]]))
    assert footprint(sphere(0.5, (1, 2, 0)), -0.1, 0.8).discs == pytest.approx(np.array([[1, 2, 0.5]]))


def test_a_ramp_leaves_the_part_between_the_heights():
    ramp = mesh(((0, 0, 0), (2, 0, 1), (2, 1, 1), (0, 1, 0)), ((0, 1, 2), (0, 2, 3)))
    corners = np.concatenate(footprint(ramp, 0.25, 0.5).outlines)
    assert (corners.min(axis=0), corners.max(axis=0)) == (pytest.approx((0.5, 0)), pytest.approx((1.0, 1.0)))


def test_an_upright_sheet_covers_both_sides_of_the_border_that_it_lies_in():
    wall = mesh(((0.05, -0.5, 0), (0.05, 0.5, 0), (0.05, 0.5, 1), (0.0, -0.5, 0), (0.0, 0.5, 0), (0.0, 0.5, 1)), ((0, 1, 2),))
    assert set(np.nonzero(grid(wall, 0.2, 0.3))[1]) == {30}
    border = mesh(((0.0, -0.5, 0), (0.0, 0.5, 0), (0.0, 0.5, 1)), ((0, 1, 2),))
    assert set(np.nonzero(grid(border, 0.2, 0.3))[1]) == {29, 30}


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10_000), st.sampled_from(["box", "cylinder", "sphere"]))
def test_cells_are_those_in_which_points_of_the_solid_lie(seed, kind):
    rng = np.random.default_rng(seed)
    pose = (rng.uniform(-1, 1, 3), turn(rng))
    make = {
        "box": lambda: box(rng.uniform(0.3, 1.5, 3), *pose),
        "cylinder": lambda: cylinder(rng.uniform(0.2, 0.7), rng.uniform(0.3, 1.5), *pose),
        "sphere": lambda: sphere(rng.uniform(0.3, 0.8), pose[0]),
    }
    part, low = make[kind](), rng.uniform(-1, 0.5)
    points = points_inside(part)
    points = points[(points[:, 2] > low) & (points[:, 2] < low + 0.3)]
    cells = grid(part, low, low + 0.3)
    drawn = np.zeros(SIZE, dtype=bool)
    drawn[cell_of(points)] = True
    assert not (drawn & ~cells).any()
    by_a_corner_only = 0.25 * cells.sum() + 12
    assert (cells & ~drawn).sum() <= by_a_corner_only


def test_a_box_and_its_mesh_have_the_same_outer_cells():
    cube, orientation = trimesh.creation.box((1.5, 0.8, 1.0)), from_euler(0.3, 0.2, 0.5)
    solid = grid(box((1.5, 0.8, 1.0), (0.03, 0.02, 0.5), orientation), 0.2, 0.4)
    shell = grid(mesh(cube.vertices, cube.faces, (0.03, 0.02, 0.5), orientation), 0.2, 0.4)
    assert not (shell & ~solid).any()
    inner = solid.copy()
    inner[1:-1, 1:-1] = solid[:-2, 1:-1] & solid[2:, 1:-1] & solid[1:-1, :-2] & solid[1:-1, 2:] & solid[1:-1, 1:-1]
    assert (shell | inner)[solid].all()


def test_segments_are_the_sides_of_the_shadows():
    turned = footprint(joined([box((2, 1, 1), (1, 1, 0.5), from_euler(0, 0, 0.3)), cylinder(0.5, 1, (3, 3, 0.5))]), 0.2, 0.3)
    sides = segments(turned)
    lengths = np.linalg.norm(sides[:, 1] - sides[:, 0], axis=1)
    assert sorted(lengths[:4]) == pytest.approx([1, 1, 2, 2])
    assert lengths[4:].sum() == pytest.approx(2 * np.pi * 0.5, rel=1e-3)
    corner = matrix(from_euler(0, 0, 0.3))[:2, :2] @ (1.0, 0.5) + 1.0
    assert np.isclose(sides[:4, 0], corner).all(axis=1).any()


def test_a_tree_has_the_footprint_of_its_table():
    table = joined([box((1, 1, 1), (0, 0, 0.5)), sphere(0.4, (2, 0, 0.2)), cylinder(0.2, 1, (0, 2, 0.5), from_euler(0.5, 0, 0))])
    assert np.array_equal(grid(table, 0.1, 0.3), grid(build(table), 0.1, 0.3))
    assert segments(footprint(joined([]), 0, 1)).shape == (0, 2, 2)


def test_upright_triangles_leave_no_gap_however_they_are_turned():
    """What rounding makes of them must not be a sliver that is beside all cells."""
    rng = np.random.default_rng(3)
    corners = np.array([(-1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 0.0, 1.0), (-1.0, 0.0, 1.0)])
    for yaw in rng.uniform(-np.pi, np.pi, 300):
        at, top = rng.uniform(-1.0, 1.0, 3) * (1.0, 1.0, 0.0), rng.uniform(0.3, 1.0)
        sheet = mesh(corners * (1.0, 1.0, top), np.array([(0, 1, 2), (0, 2, 3)]), at, from_euler(0.0, 0.0, yaw))
        shadows = footprint(sheet, 0.0011, 0.2)
        assert {len(outline) for outline in shadows.outlines} == {2}
        along = at[:2] + np.outer(np.linspace(-0.999, 0.999, 2001), (np.cos(yaw), np.sin(yaw)))
        assert covered(shadows, CORNER, CELL, SIZE)[cell_of(along)].all()
