"""Gazebo worlds as published files have them: thick plates, floors in tiles, basements, glued numbers, late declarations."""

import numpy as np
import pytest

from tests.launch.worlds.test_sdf_import import BOX, model, no_models_of_this_machine, taken  # noqa: F401  a fixture of all tests
from uvf.models.importing.worlds import Options, import_world
from uvf.models.world.file import load_world
from uvf.models.world.geometry import floor_plan


def crates(z, over=((-4.0, -4.0), (4.0, 4.0), (3.0, -4.0))):
    return "".join(model(f"crate_{i}", BOX.format("1 1 1"), f"<pose>{x} {y} {z + 0.5} 0 0 0</pose>") for i, (x, y) in enumerate(over))


def test_a_thick_plate_under_everything_is_the_ground(tmp_path):
    """As of AWS' racetrack: 0.84 m."""
    plate = model("plate", BOX.format("20 20 0.84"), "<pose>0 0 -0.36 0 0 0</pose>")
    world, notes = taken(tmp_path, plate + crates(0.06))
    assert "a slab under everything is the ground, z = 0: plate" in notes
    assert [box.name for box in world.boxes] == ["crate_0", "crate_1", "crate_2"]
    assert world.boxes[0].centre[2] == pytest.approx(0.5)


def test_a_floor_laid_in_tiles_is_the_ground_whatever_lies_far_off(tmp_path):
    """As of a logistics warehouse: nine tiles, and one thing that was pushed away."""
    tiles = "".join(
        model(f"tile_{i}_{j}", BOX.format("5 5 0.1"), f"<pose>{5 * i} {5 * j} -0.117 0 0 0</pose>") for i in (-1, 0, 1) for j in (-1, 0, 1)
    )
    over = [(x, y) for x in (-6.0, -2.0, 2.0, 6.0) for y in (-5.0, 0.0, 5.0)]
    world, notes = taken(tmp_path, tiles + crates(-0.067, [*over, (120.0, 0.0)]))
    assert "a slab under everything is the ground" in notes and "tile_0_0" in notes
    assert len(world.boxes) == 13
    assert world.boxes[0].centre[2] == pytest.approx(0.5)
    assert len(world.fields) == 9
    assert not floor_plan(world, 0.1).cells.mean() > 0.05


def test_tables_are_no_tiles(tmp_path):
    tables = "".join(model(f"table_{i}", BOX.format("4 4 0.1"), f"<pose>{5 * i} 0 0.8 0 0 0</pose>") for i in range(3))
    world, notes = taken(tmp_path, tables + crates(0.0, [(x, 5.0) for x in range(-3, 4)]))
    assert "slab" not in notes
    assert len(world.boxes) == 10


def test_floors_below_the_ground_are_told_of(tmp_path):
    """As of a hospital whose ramps lead 4 m down: the ground is a plane."""
    low = model("basement", BOX.format("10 10 0.2"), "<pose>20 0 -2.1 0 0 0</pose>")
    _, notes = taken(tmp_path, model("block", BOX.format("4 4 1"), "<pose>0 0 0.5 0 0 0</pose>") + low)
    assert "level floor below the ground z = 0, where nothing drives: 100 m^2, down to -2 m" in notes
    assert "no ground in the file: a plane at z = 0 is put in" in notes


@pytest.mark.parametrize("ground", ["<include><uri>model://ground_plane</uri></include>", "plane"])
def test_a_ground_that_the_file_has_is_not_put_in(tmp_path, ground):
    plane = "<collision name='c'><geometry><plane><normal>0 0 1</normal><size>9 9</size></plane></geometry></collision>"
    _, notes = taken(tmp_path, (model("floor", plane) if ground == "plane" else ground) + crates(0.0))
    assert "is put in" not in notes


def test_a_world_in_which_nothing_stands_says_so(tmp_path):
    """As of Clearpath's: a launch file spawns the building."""
    _, notes = taken(tmp_path, "<include><uri>model://ground_plane</uri></include>")
    assert "nothing stands in this world; what a launch file spawns is not in it" in notes


def test_numbers_without_a_space_between_them_are_two(tmp_path):
    world, _ = taken(tmp_path, model("a", BOX.format("1 1e-1 2"), "<pose>0.09 41.632-0.25 0 -0 0</pose>"))
    assert world.boxes[0].centre == pytest.approx((0.09, 41.632, -0.25))
    assert world.boxes[0].size == pytest.approx((1.0, 0.1, 2.0))


def test_a_declaration_below_empty_lines_is_read(tmp_path):
    path = tmp_path / "late.world"
    path.write_text(f"\n\n<?xml version='1.0' ?>\n<sdf version='1.4'><world name='w'>{crates(0.0)}</world></sdf>")
    import_world(path, tmp_path / "worlds" / "w", Options())
    assert np.shape(load_world(tmp_path / "worlds", "w").boxes) == (3,)
