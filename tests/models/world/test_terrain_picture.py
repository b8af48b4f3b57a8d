"""What stands out of a terrain, and the ground that it lies on."""

import numpy as np
import pytest

from uvf.models.scenario import ROOT
from uvf.models.world.file import load_world
from uvf.models.world.terrain import Relief, relief_of
from uvf.models.world.terrain_picture import raised_mesh, raised_triangles, with_ground_of


def test_level_ground_is_left_out_and_slopes_and_terraces_stay():
    heights = np.zeros((10, 10))
    heights[3:6, 3:6] = 2.0
    vertices, faces = raised_triangles(Relief(np.arange(10.0), np.arange(10.0), heights))
    corners = vertices[faces]
    assert corners[..., :2].min() == 2.0 and corners[..., :2].max() == 6.0
    assert (np.ptp(corners[..., 2], axis=1) == 0.0).sum() == 2 * 2 * 2  # the top
    assert len(raised_triangles(Relief(np.arange(10.0), np.arange(10.0), np.zeros((10, 10))))[1]) == 0


def test_of_a_yard_with_mounds_the_mounds_are_left_of_hills_nearly_all():
    yard, hills = (load_world(ROOT / "worlds", name).terrain for name in ("depot", "hills"))
    shares = [len(raised_triangles(relief_of(terrain))[1]) / len(relief_of(terrain).triangles()[1]) for terrain in (yard, hills)]
    assert shares[0] < 0.05 < 0.5 < shares[1]
    assert raised_mesh(yard) is not None


def test_the_ground_has_the_terrains_colour_below_all_other_patches():
    depot, house = load_world(ROOT / "worlds", "depot"), load_world(ROOT / "worlds", "house")
    patch = with_ground_of(depot).fields[-1]
    assert patch.area == pytest.approx((-60.0, -50.0, 60.0, 50.0)) and patch.colour == depot.terrain.colour
    assert with_ground_of(house) is house
