"""The check of worlds names each fault, and finds none in the worlds that come along."""

import pytest

from launch.worlds.check import problems
from tests.models.world.test_geometry import world_of
from uvf.models.scenario import ROOT
from uvf.models.world.file import Box, Cylinder, Sphere, Wall, load_world

HERE_AND_BACK = [(0.0, 0.5, 1.0, 0.0), (5.0, 3.5, 1.0, 0.0), (10.0, 0.5, 1.0, 0.0)]


def person(name="person", path=HERE_AND_BACK):
    return Cylinder(name, (0.5, 1.0, 0.0), 0.2, 1.7, path=path)


@pytest.mark.parametrize(
    ("parts", "complaint"),
    [
        ({"boxes": [Box("lamp", (2.0, 1.0, 1.5), (0.3, 0.3, 0.3))]}, "lamp floats: nothing between it and the ground, 1.35 m below"),
        ({"boxes": [Box("box", (2.0, 1.0, -0.5), (0.3, 0.3, 0.3))]}, "box is sunk: it ends 0.35 m below the ground"),
        ({"spheres": [Sphere("ball", (2.0, 1.0, -0.1), 0.3)]}, "ball is sunk: 0.40 m of it lie below"),
        ({"walls": [Wall([(2.0, 0.0), (2.0, 2.0)])]}, "of floor about (3.0, 1.0) are out of reach for a radius of 0.115 m"),
        ({"cylinders": [person()], "walls": [Wall([(2.0, 0.8), (2.0, 1.2)])]}, "person goes through a wall at t = "),
        ({"cylinders": [person(), person("other")]}, "other goes through person at t = 0.0 s"),
    ],
)
def test_each_fault_is_named(parts, complaint):
    (line,) = problems(world_of(**parts), 0.115)
    assert complaint in line


def test_a_top_on_legs_stands_and_a_person_beside_a_pillar_is_not_in_its_way():
    top = Box("top", (2.0, 1.6, 0.72), (1.0, 0.5, 0.04))
    leg = Cylinder("leg", (2.0, 1.6, 0.0), 0.05, 0.7)
    assert list(problems(world_of(boxes=[top], cylinders=[leg, person()]), 0.115)) == []


@pytest.mark.parametrize("name", sorted(p.parent.name for p in (ROOT / "worlds").glob("*/world.yaml")))
def test_the_worlds_that_come_along_are_clean(name):
    assert list(problems(load_world(ROOT / "worlds", name), 0.115)) == []
