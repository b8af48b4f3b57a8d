"""Worlds under a roof, and meshes cut open."""

import numpy as np
import pytest
import trimesh

from uvf.models.shapes.solid import Keyframes, Solid
from uvf.models.world.cutaway import cut_open, is_roofed

FLOOR = (-5.0, -5.0, 5.0, 5.0)


def slab(name, z, side, path=None):
    return Solid(name, "box", (side, side, 0.2), np.array((0.0, 0.0, z)), path=path)


@pytest.mark.parametrize(
    ("parts", "expected"),
    [
        ([slab("roof", 3.0, 9.0)], True),
        ([slab("floor", -0.1, 9.0)], False),
        ([slab("table", 0.8, 9.0)], False),
        ([slab("lamp", 3.0, 1.0)], False),
        ([slab("lamp", 3.0, 3.0), slab("beam", 4.0, 4.5)], True),
        ([slab("cloud", 3.0, 9.0, Keyframes(np.array(((0.0, 0.0, 0.0, 0.0), (1.0, 1.0, 0.0, 0.0)))))], False),
    ],
)
def test_a_roof_is_what_hides_much_of_the_floor_from_above(parts, expected):
    assert is_roofed(parts, FLOOR) is expected


@pytest.mark.parametrize("faces", [[(0, 1, 2)], [(0, 2, 1)]])
def test_a_ceiling_of_one_sheet_is_a_roof_whichever_way_it_looks(tmp_path, faces):
    corners = [(-5.0, -5.0, 3.0), (5.0, -5.0, 3.0), (5.0, 5.0, 3.0)]
    trimesh.Trimesh(corners, faces, process=False).export(tmp_path / "ceiling.stl")
    assert is_roofed([Solid("ceiling", "mesh", (1.0, 1.0, 1.0), np.zeros(3), mesh=tmp_path / "ceiling.stl")], FLOOR)


def test_what_is_cut_ends_at_the_height_and_nothing_below_is_lost():
    tower = trimesh.creation.cylinder(1.0, 10.0)
    vertices, faces = cut_open(np.asarray(tower.vertices), np.asarray(tower.faces), 1.4)
    assert vertices[:, 2].max() == pytest.approx(1.4)
    wall = trimesh.Trimesh(vertices, faces).area - np.pi  # the lower end is there still
    assert wall == pytest.approx(2 * np.pi * 6.4, rel=0.01)
    assert len(cut_open(np.asarray(tower.vertices), np.asarray(tower.faces), -9.0)[1]) == 0
