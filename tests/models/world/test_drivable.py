"""Ramps are driven on, steps are not: what the floor plan makes of surfaces above the floor."""

import numpy as np
import pytest
import trimesh

from tests.models.world.test_geometry import world_of
from uvf.models.world.file import Box, Cylinder, Mesh, Sphere
from uvf.models.world.footing import Footing
from uvf.models.world.geometry import floor_plan, floor_segments, reachable_floor

RISE = 0.3  # m, height of the platform


def ramp(degrees, width=1.0):
    """A box whose upper face rises from the floor at x = 1 to the platform's edge; sunk so that its foot has no step."""
    angle = np.radians(degrees)
    length = RISE / np.sin(angle)
    thickness = 0.2
    top = np.array((1.0 + length / 2 * np.cos(angle), RISE / 2))
    centre = top - thickness / 2 * np.array((-np.sin(angle), np.cos(angle)))
    return Box("ramp", (centre[0], 1.0, centre[1]), (length, width, thickness), (0.0, -angle, 0.0))


def platform(degrees):
    x = 1.0 + RISE / np.tan(np.radians(degrees))
    return Box("platform", ((x + 4.0) / 2, 1.0, RISE / 2), (4.0 - x, 2.0, RISE))


def reaches(world, there, radius=0.1):
    plan = floor_plan(world, 0.05)
    return reachable_floor(plan, 0.4, 1.0, radius)[plan.cell(*there)]


def test_a_gentle_ramp_leads_onto_the_platform():
    world = world_of(boxes=[ramp(10), platform(10)])
    assert reaches(world, (2.0, 1.0))
    assert reaches(world, (3.5, 1.5))


def test_a_steep_ramp_is_an_obstacle():
    assert not reaches(world_of(boxes=[ramp(20), platform(20)]), (3.5, 1.0))


def test_a_platform_without_a_ramp_is_an_obstacle_and_a_threshold_is_none():
    assert not reaches(world_of(boxes=[platform(10)]), (3.5, 1.0))
    assert reaches(world_of(boxes=[Box("sill", (2.0, 1.0, 0.004), (0.1, 2.0, 0.008))]), (3.5, 1.0))
    assert not reaches(world_of(boxes=[Box("kerb", (2.0, 1.0, 0.02), (0.1, 2.0, 0.04))]), (3.5, 1.0))


def test_the_sides_of_a_ramp_are_cliffs():
    plan = floor_plan(world_of(boxes=[ramp(8), platform(8)]), 0.05)
    assert plan.cells[plan.cell(2.5, 1.5)]
    assert not plan.cells[plan.cell(2.5, 1.0)]


def test_what_stands_on_a_platform_is_bumped_into_and_what_hangs_above_is_not():
    on = Box("crate", (3.5, 1.0, RISE + 0.1), (0.2, 0.2, 0.2))
    above = Box("lamp", (3.5, 1.5, RISE + 0.5), (0.2, 0.2, 0.2))
    plan = floor_plan(world_of(boxes=[ramp(10), platform(10), on, above]), 0.05)
    assert plan.cells[plan.cell(3.5, 1.0)]
    assert not plan.cells[plan.cell(3.5, 1.5)]


def test_a_ramp_of_triangles_is_as_one_of_a_box(tmp_path):
    """The wedge's side faces are obstacles, its slope is none."""
    corners = [(1, 0.5, 0), (3, 0.5, 0), (3, 0.5, RISE), (1, 1.5, 0), (3, 1.5, 0), (3, 1.5, RISE)]
    faces = [(0, 1, 2), (3, 5, 4), (0, 2, 5), (0, 5, 3), (1, 4, 5), (1, 5, 2), (0, 3, 4), (0, 4, 1)]
    wedge = trimesh.Trimesh(corners, faces)
    for name, shape in (("coarse", wedge), ("fine", wedge.subdivide_to_size(0.06))):  # the fine one's triangles miss most cells' centres
        shape.export(tmp_path / f"{name}.stl")
        world = world_of(meshes=[Mesh("wedge", str(tmp_path / f"{name}.stl"))])
        assert reaches(world, (2.5, 1.0)), name
        assert not reaches(world, (2.5, 0.51)), name


def test_spheres_and_leaning_posts_count_at_the_height_they_are_bumped_into():
    ball = Sphere("ball", (2.0, 1.0, 0.5), 0.5)
    plan = floor_plan(world_of(spheres=[ball]), 0.02, height=0.1)
    widest = np.sqrt(0.5**2 - 0.4**2)
    assert plan.cells.sum() * plan.resolution**2 == pytest.approx(np.pi * widest**2, rel=0.1)
    post = Cylinder("post", (2.0, 1.0, 0.0), 0.05, 1.0, rpy=(0.0, np.pi / 4, 0.0))
    assert Footing(world_of(cylinders=[post])).room(2.5, 1.0, (0.5, 0.6)) == 0.0
    assert Footing(world_of(cylinders=[post])).at(2.5, 1.0).room > 0.2


def test_what_moves_by_script_is_not_in_the_plan():
    door = Box("door", (2.0, 1.0, 1.0), (0.1, 2.0, 2.0), path=[(0.0, 2.0, 1.0, 0.0), (5.0, 2.0, 1.0, 0.0)])
    assert not floor_plan(world_of(boxes=[door]), 0.05).cells.any()
    assert Footing(world_of(boxes=[door])).at(1.5, 1.0).room == pytest.approx(0.45)


def test_segments_outline_what_a_lidar_at_that_height_meets():
    table = Box("table", (2.0, 1.0, 0.7), (1.0, 0.6, 0.1))
    sides = floor_segments(world_of(boxes=[table]), 0.7)
    assert np.linalg.norm(sides[:, 1] - sides[:, 0], axis=1).sum() == pytest.approx(3.2)
    assert len(floor_segments(world_of(boxes=[table]), 0.2)) == 0
