"""Terrain: the picture's heights at every point, the same in every form that something reads."""

import numpy as np
import pytest
from PIL import Image

from uvf.maths.raycast import Rays, cast
from uvf.models.shapes.mesh import triangles
from uvf.models.shapes.scene import scene
from uvf.models.world.drivable import STEEPEST_GRADIENT
from uvf.models.world.file import Box, Origin, Terrain, WorldFile, load_world
from uvf.models.world.footing import Footing
from uvf.models.world.geometry import floor_plan, solids
from uvf.models.world.terrain import Relief, relief_of
from uvf.models.yaml_data import BadInput

STEPS = np.array(((0, 0, 0, 0), (0, 40, 80, 0), (0, 10, 200, 0), (0, 0, 0, 0)), dtype=np.uint8)  # row 0 in the north


def world_with(tmp_path, pixels=STEPS, size=(9.0, 6.0, 2.55), **parts):
    Image.fromarray(pixels).save(tmp_path / "h.png")
    terrain = Terrain(str(tmp_path / "h.png"), size)
    return WorldFile(about="test", origin=Origin(0.0, 0.0), floor=(-4.0, -2.5, 4.0, 2.5), terrain=terrain, **parts)


def test_white_is_the_full_height_north_is_up_and_the_outermost_pixels_lie_on_the_rim(tmp_path):
    relief = relief_of(world_with(tmp_path).terrain)
    assert (relief.x[0], relief.x[-1], relief.y[0], relief.y[-1]) == (-4.5, 4.5, -3.0, 3.0)
    heights, _ = relief.at(np.array((-1.5, 1.5, 1.5)), np.array((1.0, 1.0, -1.0)))
    assert heights == pytest.approx((0.40, 0.80, 2.00))


def test_sixteen_bits_are_finer(tmp_path):
    relief = relief_of(world_with(tmp_path, STEPS.astype(np.uint16) * 200, (9.0, 6.0, 65.535)).terrain)
    assert relief.heights.max() == pytest.approx(40.0)


def test_between_the_pixels_it_is_the_triangles_that_rays_meet(tmp_path):
    world = world_with(tmp_path)
    x, y = np.random.default_rng(3).uniform((-4.4, -2.9), (4.4, 2.9), (300, 2)).T
    heights, _ = relief_of(world.terrain).at(x, y)
    down = np.tile((0.0, 0.0, -1.0), (300, 1))
    fallen = cast(scene(solids(world)), [], Rays(np.column_stack((x, y, np.full(300, 10.0))), down), 20.0)
    assert 10.0 - fallen == pytest.approx(heights, abs=1e-5)


def test_slopes_are_the_change_of_height(tmp_path):
    relief = relief_of(world_with(tmp_path).terrain)
    x, y = np.random.default_rng(4).uniform((-4.3, -2.8), (4.3, 2.8), (200, 2)).T
    step = 1e-7
    here, slope = relief.at(x, y)
    east, north = (relief.at(x + step, y)[0] - here) / step, (relief.at(x, y + step)[0] - here) / step
    assert slope == pytest.approx(np.hypot(east, north), abs=1e-5)


def test_a_rim_that_is_not_low_has_walls_to_the_ground():
    relief = Relief(np.array((0.0, 1.0, 2.0)), np.array((0.0, 1.0)), np.full((2, 3), 0.5))
    vertices, faces = relief.triangles()
    corners = vertices[faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    assert area == pytest.approx(2.0 * 1.0 + 0.5 * (2 + 2 + 1 + 1))
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outward = corners.mean(axis=1) - (1.0, 0.5, 0.25)
    assert ((normals * outward).sum(axis=1) > 0).all()


def test_every_reader_gets_the_same_mesh(tmp_path):
    world = world_with(tmp_path)
    land = solids(world)[-1]
    vertices, _ = triangles(land)
    assert (land.name, land.shape) == ("terrain", "mesh")
    assert vertices.max(axis=0) == pytest.approx((4.5, 3.0, 2.0))
    assert solids(world)[-1].mesh == land.mesh


def test_one_stands_on_the_terrain_and_things_count_above_it(tmp_path):
    gentle = np.tile(np.linspace(0, 51, 40).astype(np.uint8), (30, 1))
    post = Box("post", (2.0, 0.0, 0.75), (0.2, 0.2, 1.2))
    footing = Footing(world_with(tmp_path, gentle, (9.0, 6.0, 2.55), boxes=[post]))
    room, height, slope = footing.at(1.0, 0.0)
    assert height == pytest.approx(0.51 * 5.5 / 9.0, abs=0.02)
    assert 0.0 < slope < STEEPEST_GRADIENT
    assert room == pytest.approx(0.9, abs=0.01)


def test_slopes_too_steep_to_drive_are_obstacles(tmp_path):
    plan = floor_plan(world_with(tmp_path), 0.05)
    x, y = plan.centres()
    _, slope = relief_of(world_with(tmp_path).terrain).at(x, y)
    assert plan.cells[slope > STEEPEST_GRADIENT].all()
    assert plan.cells[slope > STEEPEST_GRADIENT].size > 1000


@pytest.mark.parametrize(
    ("pixels", "why"),
    [
        (np.zeros((4, 4, 3), dtype=np.uint8), "a picture in colours ('RGB')"),
        (np.zeros((1, 4), dtype=np.uint8), "4 x 1 pixels; terrain has 2 to 513 a side"),
        (np.zeros((600, 4), dtype=np.uint8), "4 x 600 pixels"),
    ],
)
def test_pictures_that_are_no_heights_are_refused(tmp_path, pixels, why):
    world = world_with(tmp_path, pixels)
    with pytest.raises(BadInput) as refused:
        relief_of(world.terrain)
    assert why in str(refused.value)


@pytest.mark.parametrize(
    ("terrain", "why"),
    [
        ("{heights: hill.png, size: [1, 1, 1]}", "no file 'hill.png'"),
        ("{heights: h.png, size: [1, 1, 1], position: [0, 0, -2]}", "terrain: position"),
        ("{height: h.png, size: [1, 1, 1]}", "unknown key 'height'"),
        ("{heights: world.yaml, size: [1, 1, 1]}", "not a picture"),
    ],
)
def test_what_is_wrong_with_a_terrain_is_said_where_it_stands(tmp_path, terrain, why):
    (tmp_path / "w").mkdir()
    (tmp_path / "w" / "h.png").write_bytes(b"")
    text = f"about: x\norigin: {{latitude: 0, longitude: 0}}\nfloor: [0, 0, 1, 1]\nterrain: {terrain}\n"
    (tmp_path / "w" / "world.yaml").write_text(text)
    with pytest.raises(BadInput) as refused:
        relief_of(load_world(tmp_path, "w").terrain)
    assert why in str(refused.value)
    assert "\n" not in str(refused.value)
