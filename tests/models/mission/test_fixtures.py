"""The markers of a mission stand in its world, on its ground."""

import pytest

from launch.worlds.check import hidden_markers
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput

MISSION = """about: One.
world: WORLD
markers: MARKERS
vehicles:
  eye: {model: milvus, system_id: 1, start: {x: 0.0, y: 0.0, z: 100.0}}
"""


def loaded(tmp_path, world, markers):
    path = tmp_path / "one.yaml"
    path.write_text(MISSION.replace("WORLD", world).replace("MARKERS", markers))
    return load_scenario(path, ROOT)


def test_they_stand_among_the_things_of_the_world(tmp_path):
    site = loaded(tmp_path, "depot", "[{x: 1.0, y: 2.0}, {x: 3.0, y: 4.0, radius: 0.2, height: 2.0, colour: [0, 0, 1]}]")
    first, second = site.world.cylinders[-2:]
    assert (first.name, first.base, first.height) == ("marker_1", (1.0, 2.0, 0.0), 1.0)
    assert (second.name, second.radius, second.colour) == ("marker_2", 0.2, (0.0, 0.0, 1.0))


def test_one_that_nobody_can_see_or_come_to_is_named(tmp_path):
    site = loaded(tmp_path, "depot", "[{x: 1.0, y: 2.0}, {x: -28.0, y: -12.0}, {x: 8.6, y: -8.0}]")
    inside, beside = hidden_markers(site)
    assert "markers[1]: (-28, -12) is 0.00 m from a wall or furniture" in inside
    assert "markers[2]: (8.6, -8) is 0.15 m from" in beside


def test_they_stand_on_hills(tmp_path):
    site = loaded(tmp_path, "hills", "[{x: 0.0, y: 0.0}]")
    assert site.world.cylinders[-1].base[2] == pytest.approx(10.0, abs=0.5)


@pytest.mark.parametrize(
    ("markers", "why"),
    [
        ("[{x: 100.0, y: 2.0}]", r"markers\[0\]: \(100, 2\) is not on the floor"),
        ("[{x: 1.0, y: 2.0, radius: 0.0}]", "radius"),
        ("[{x: 1.0, y: 2.0, color: [0, 0, 1]}]", "did you mean 'colour'"),
    ],
)
def test_what_cannot_stand_there_is_refused(markers, why, tmp_path):
    with pytest.raises(BadInput, match=why):
        loaded(tmp_path, "depot", markers)
