"""Windsocks: straight down in calm, straight out from 15 knots on, to where the wind blows."""

import math

import numpy as np
import pytest

from uvf.maths.rotations import rotate
from uvf.models.world.file import WorldFile, load_world
from uvf.models.world.geometry import solids
from uvf.models.world.windsock import FULL, LENGTH, cloth, hangs
from uvf.models.yaml_data import BadInput

X = np.array((1.0, 0.0, 0.0))
WORLD = """
about: a meadow
origin: {latitude: 47.0, longitude: 8.0}
floor: [-10, -10, 10, 10]
"""


@pytest.mark.parametrize(
    ("wind", "points"),
    [
        ((0.0, 0.0, 0.0), (0.0, 0.0, -1.0)),
        ((0.0, FULL, 0.0), (0.0, 1.0, 0.0)),
        ((-20.0, 0.0, 3.0), (-1.0, 0.0, 0.0)),
        ((FULL / 2, 0.0, 0.0), (math.sqrt(0.5), 0.0, -math.sqrt(0.5))),
    ],
)
def test_it_points_to_where_the_wind_blows(wind, points):
    assert rotate(hangs(np.array(wind)), X) == pytest.approx(points, abs=1e-9)


def test_the_cloth_begins_at_the_mouth():
    vertices = np.vstack([part.vertices for part in cloth()])
    assert vertices[:, 0].min() == pytest.approx(0.0) and vertices[:, 0].max() == pytest.approx(LENGTH)


def written(tmp_path, more) -> WorldFile:
    (tmp_path / "w").mkdir()
    (tmp_path / "w" / "world.yaml").write_text(WORLD + more)
    return load_world(tmp_path, "w")


def test_its_pole_is_in_the_way(tmp_path):
    world = written(tmp_path, "windsocks: [{name: sock, base: [3, 4, 0], height: 5}]\n")
    (pole,) = solids(world)
    assert pole.name == "sock" and pole.position.tolist() == [3.0, 4.0, 2.5] and pole.size[1] == 5.0


def test_it_has_a_name_of_its_own(tmp_path):
    with pytest.raises(BadInput, match=r"windsocks\[0\]: name: 'bin' is given twice"):
        written(tmp_path, "cylinders: [{name: bin, base: [0, 0, 0], radius: 1, height: 1}]\nwindsocks: [{name: bin, base: [3, 4, 0]}]\n")
