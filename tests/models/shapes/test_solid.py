"""Solids of a world: scripts that move some of them, and files that describe them wrongly."""

import numpy as np
import pytest

from uvf.maths.rotations import matrix
from uvf.models.shapes.solid import Keyframes, Solid, pose_at
from uvf.models.world.file import load_world
from uvf.models.world.geometry import solids
from uvf.models.yaml_data import BadInput

HEAD = "about: a test\norigin: {latitude: 40.0, longitude: 14.0}\nfloor: [0.0, 0.0, 10.0, 10.0]\n"
WALK = Keyframes(np.array([[0.0, 0.0, 0.0, 0.0], [2.0, 4.0, 0.0, 0.0], [3.0, 4.0, 2.0, np.pi / 2], [5.0, 0.0, 0.0, 0.0]]))


def world_of(tmp_path, text):
    (tmp_path / "test").mkdir()
    (tmp_path / "test" / "world.yaml").write_text(HEAD + text)
    return load_world(tmp_path, "test")


def test_a_script_goes_straight_between_its_keys_and_round_again():
    assert WALK.at(1.0) == pytest.approx((2.0, 0.0, 0.0))
    assert WALK.at(2.5) == pytest.approx((4.0, 1.0, np.pi / 4))
    assert WALK.at(6.0) == pytest.approx(WALK.at(1.0))


@pytest.mark.parametrize("t", [0.3, 1.9, 2.4, 4.7, 5.6])
def test_the_velocity_of_a_script_is_the_slope_of_its_way(t):
    h = 1e-6
    slope = (np.array(WALK.at(t + h)) - np.array(WALK.at(t - h))) / (2 * h)
    assert WALK.velocity(t) == pytest.approx(slope, abs=1e-6)


def test_a_person_walks_upright_at_his_height():
    person = Solid("person", "cylinder", (0.2, 1.8), np.array((0.0, 0.0, 0.9)), path=WALK)
    position, orientation = pose_at(person, 2.5)
    assert position == pytest.approx((4.0, 1.0, 0.9))
    assert matrix(orientation)[2, 2] == pytest.approx(1.0)


def test_a_leaning_cylinder_stands_on_the_middle_of_its_lower_face(tmp_path):
    world = world_of(tmp_path, "cylinders: [{name: c, base: [1.0, 2.0, 0.5], radius: 0.1, height: 2.0, rpy: [0.0, 1.5707963, 0.0]}]\n")
    (leaning,) = solids(world, tmp_path)
    assert leaning.position == pytest.approx((2.0, 2.0, 0.5), abs=1e-6)


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("meshes: [{name: m, file: chair.stl}]", "no file 'chair.stl'"),
        ("boxes: [{name: a, centre: [0, 0, 0], size: [1, 1, 1], path: [[0, 0, 0, 0]]}]", "two or more keys"),
        ("boxes: [{name: a, centre: [0, 0, 0], size: [1, 1, 1], path: [[0, 0, 0, 0], [1, 1, 0, 0]]}]", "come back to the beginning"),
        ("boxes: [{name: a, centre: [0, 0, 0], size: [1, 1, 1], path: [[0, 0, 0, 0], [2, 1, 0, 0], [1, 0, 0, 0]]}]", "t rising"),
        ("spheres: [{name: a, centre: [0, 0, 0], radius: 1}]\nboxes: [{name: a, centre: [0, 0, 0], size: [1, 1, 1]}]", "given twice"),
    ],
)
def test_wrong_solids_are_refused_by_name(tmp_path, text, part):
    with pytest.raises(BadInput, match=part.replace("[", r"\[")):
        world_of(tmp_path, text)
