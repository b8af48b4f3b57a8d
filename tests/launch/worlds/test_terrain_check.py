"""On terrain, things stand, float and are sunk by its height below them."""

import numpy as np
import pytest
from PIL import Image

from launch.worlds.check import problems
from launch.worlds.report import figures
from uvf.models.scenario import ROOT
from uvf.models.world.file import Box, Origin, Terrain, WorldFile, load_world


def told(tmp_path, z):
    """A box of 1 m whose middle is at ``z`` [m] on a plateau of 5 m."""
    Image.fromarray(np.full((3, 3), 255, dtype=np.uint8)).save(tmp_path / "h.png")
    terrain, box = Terrain(str(tmp_path / "h.png"), (8.0, 8.0, 5.0)), Box("crate", (0.0, 0.0, z), (1.0, 1.0, 1.0))
    world = WorldFile("test", Origin(0.0, 0.0), (-3.0, -3.0, 3.0, 3.0), boxes=[box], terrain=terrain)
    return [line for line in problems(world, 0.1) if "crate" in line]


@pytest.mark.parametrize(("z", "said"), [(5.5, []), (6.0, ["crate floats: nothing between it and the ground, 0.50 m below"])])
def test_what_stands_on_it_is_right_and_what_hangs_above_floats(tmp_path, z, said):
    assert told(tmp_path, z) == said


def test_what_lies_in_it_is_sunk(tmp_path):
    assert "below the ground" in told(tmp_path, 0.5)[0]


def test_the_hills_are_sound_and_tell_their_size():
    world = load_world(ROOT / "worlds", "hills")
    assert "terrain  480 x 400 m, 0.0 .. 42.1 m high, cells of 5 m" in list(figures(world))
    assert list(problems(world, 0.115)) == []
