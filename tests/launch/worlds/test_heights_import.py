"""Terrain from pictures of heights, elevation models and the heightmaps of Gazebo."""

import numpy as np
import pytest
from PIL import Image, TiffImagePlugin
from typer.testing import CliRunner

from launch.cli import app
from uvf.models.importing.worlds import Options, import_world
from uvf.models.world.file import load_world
from uvf.models.world.footing import Footing
from uvf.models.world.geometry import floor_plan
from uvf.models.world.terrain import relief
from uvf.models.yaml_data import BadInput

X, Y = np.meshgrid(np.linspace(-1.0, 1.0, 65), np.linspace(1.0, -1.0, 65))
HILL = np.exp(-4.0 * ((X - 0.5) ** 2 + Y**2))  # in the east
UTM, WGS84 = (1, 1, 0, 1, 1024, 0, 1, 1), (1, 1, 0, 2, 1024, 0, 1, 2, 1025, 0, 1, 1)


def geotiff(path, heights, scale, keys, tie=(0.0, 0.0, 0.0, 8.0, 47.0, 0.0), no_data=None):
    tags = TiffImagePlugin.ImageFileDirectory_v2()
    for tag, kind, value in ((33550, 12, (*scale, 0.0)), (33922, 12, tie), (34735, 3, keys)):
        tags.tagtype[tag], tags[tag] = kind, value
    if no_data is not None:
        tags.tagtype[42113], tags[42113] = 2, no_data
    Image.fromarray(heights.astype(np.float32)).save(path, tiffinfo=tags)
    return path


def imported(tmp_path, file, **options):
    made, lines = import_world(file, tmp_path / "worlds" / "it", Options(**options))
    return load_world(tmp_path / "worlds", "it"), lines, made


def test_a_picture_with_its_measures_is_a_terrain(tmp_path):
    Image.fromarray((HILL * 255).astype(np.uint8)).save(tmp_path / "hill.png")
    world, lines, _ = imported(tmp_path, tmp_path / "hill.png", terrain=(20.0, 20.0, 2.0))
    heights, _ = relief(world).at(np.array((5.0, -9.0)), np.array((0.0, 9.0)))
    assert heights == pytest.approx((2.0, 0.0), abs=0.03)
    assert (world.floor, lines[-1].split(",")[0]) == ((-10.0, -10.0, 10.0, 10.0), "taken over: terrain")
    with pytest.raises(BadInput, match=r"has hill.yaml beside it.*heights is taken with --terrain EAST NORTH HEIGHT"):
        import_world(tmp_path / "hill.png", tmp_path / "worlds" / "other", Options(terrain=None))


def test_an_elevation_model_in_degrees_knows_its_place_its_size_and_its_heights(tmp_path):
    step = 1e-4  # deg: 7.6 m east and 11.1 m north
    file = geotiff(tmp_path / "alps.tif", 450.0 + 80.0 * HILL, (step, step), WGS84, no_data="-9999")
    world, lines, _ = imported(tmp_path, file)
    assert world.terrain.size == pytest.approx((64 * step * 111_320 * np.cos(np.radians(47.0)), 64 * step * 111_170, 80.0), rel=3e-3)
    assert (world.origin.latitude, world.origin.longitude) == pytest.approx((47.0 - 32.5 * step, 8.0 + 32.5 * step), abs=1e-6)
    assert world.origin.altitude == pytest.approx(450.0, abs=0.1)
    east, west = relief(world).at(np.array((0.25, -0.45)) * world.terrain.size[0], np.zeros(2))[0]
    assert (east, west) == (pytest.approx(80.0, abs=0.5), pytest.approx(0.3, abs=0.5))
    assert any("the drivable floor is 200 m a side" in line for line in lines)


def test_an_elevation_model_in_metres_with_holes(tmp_path):
    heights = np.where(X < -0.9, -9999.0, 12.0 + 3.0 * HILL)
    world, lines, _ = imported(tmp_path, geotiff(tmp_path / "site.tiff", heights, (0.5, 0.5), UTM, no_data="-9999"))
    assert world.terrain.size == pytest.approx((32.0, 32.0, 3.0), abs=0.01)
    assert any("cells without a height lie as low as the lowest: 260" in line for line in lines)
    assert any("projected metres: set 'origin'" in line for line in lines)


@pytest.mark.parametrize(
    ("heights", "scale", "keys", "refusal"),
    [
        (HILL, (0.5, 0.5), (1, 1, 0, 0), "neither degrees nor metres; project it first"),
        (HILL, (0.5, 0.5), (1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, 9002), "neither degrees nor metres"),
        (HILL, (0.0, 0.5), UTM, "ModelPixelScale is 0, 0.5"),
        (np.full((9, 9), np.nan), (0.5, 0.5), UTM, "no height is known in it"),
        (np.full((9, 9), 3.0), (0.5, 0.5), UTM, "from the lowest to the highest 0 m; that is level ground"),
        (HILL, (3.0, 3.0), WGS84, "terrain has at most 10000 m a side: cut out a part"),
        (HILL, (9.0, 9.0), WGS84, "that is no place to drive"),
    ],
)
def test_an_elevation_model_that_cannot_be_used_is_refused_and_leaves_nothing_behind(tmp_path, heights, scale, keys, refusal):
    with pytest.raises(BadInput, match=refusal.replace("(", r"\(")):
        imported(tmp_path, geotiff(tmp_path / "bad.tif", heights, scale, keys))
    assert not list((tmp_path / "worlds").glob("*"))


def test_a_tiff_without_place_or_spacing_and_a_file_that_is_no_picture_are_refused(tmp_path):
    Image.fromarray(HILL.astype(np.float32)).save(tmp_path / "plain.tif")
    with pytest.raises(BadInput, match="it does not say how wide its cells are"):
        imported(tmp_path, tmp_path / "plain.tif")
    (tmp_path / "text.tif").write_text("heights")
    with pytest.raises(BadInput, match="not a picture or elevation model that can be read"):
        imported(tmp_path, tmp_path / "text.tif")


def test_a_large_model_is_thinned_and_says_so(tmp_path):
    x = np.linspace(0.0, 1.0, 1500)
    file = geotiff(tmp_path / "large.tif", np.tile(np.sin(6.0 * x), (1400, 1)), (1.0, 1.0), UTM)
    world, lines, _ = imported(tmp_path, file)
    ground = relief(world)
    assert ground.heights.shape == (513, 513)
    assert any("more than 513 cells a side: taken every: 2.93 m" in line for line in lines)
    east = np.array((-500.0, 0.0, 400.0))
    meant = np.sin(6.0 * (east / 1499 + 0.5))
    assert ground.at(east, np.zeros(3))[0] - meant == pytest.approx(np.full(3, -np.sin(6.0 * x).min()), abs=0.02)


SDF = """<sdf version="1.6"><world name="w">
<model name="hills"><static>true</static><link name="l"><collision name="c"><geometry><heightmap>
<uri>file://{uri}</uri><size>20 20 4</size><pos>0 0 -1</pos></heightmap></geometry></collision></link></model>
<model name="post"><static>true</static><pose>-8 0 0.5 0 0 0</pose><link name="l"><collision name="c"><geometry>
<cylinder><radius>0.2</radius><length>3</length></cylinder></geometry></collision></link></model>
</world></sdf>"""


def test_a_heightmap_of_gazebo_is_the_terrain_and_all_stands_on_it(tmp_path):
    """The brightest is as high as <size> says, 0 lies at <pos>; then everything is moved so that the lowest is z = 0."""
    Image.fromarray((50 + HILL * 150).astype(np.uint8)).save(tmp_path / "bowl.png")
    (tmp_path / "w.world").write_text(SDF.format(uri="bowl.png"))
    world, lines, _ = imported(tmp_path, tmp_path / "w.world")
    assert world.terrain.size == (20.0, 20.0, pytest.approx(3.0, abs=0.01))
    assert any("the terrain's lowest lies at 0 m" in line or "lowest" not in line for line in lines)
    (post,) = world.cylinders
    assert post.base[2] == pytest.approx(-1.0, abs=0.02)
    assert Footing(world).at(5.0, 0.0).height == pytest.approx(3.0, abs=0.03)
    plan = floor_plan(world, 0.1)
    assert plan.cells[plan.cell(-8.0, 0.0)] and plan.cells[plan.cell(2.5, 0.0)] and not plan.cells[plan.cell(-6.0, 5.0)]


def test_a_heightmap_that_is_not_there_or_of_one_height_is_told(tmp_path):
    (tmp_path / "w.world").write_text(SDF.format(uri="none.png"))
    assert any(
        "heightmaps not found, the ground is level instead: file://none.png" in line for line in imported(tmp_path, tmp_path / "w.world")[1]
    )
    Image.fromarray(np.full((9, 9), 7, np.uint8)).save(tmp_path / "none.png")
    lines = imported(tmp_path, tmp_path / "w.world", replace=True)[1]
    assert any("heightmaps that cannot be read, the ground is level instead: hills" in line and "one brightness" in line for line in lines)


def test_the_command_takes_the_measures(tmp_path, monkeypatch):
    monkeypatch.setattr("launch.commands.world._worlds", lambda: tmp_path / "worlds")
    Image.fromarray((HILL * 60000).astype(np.uint16)).save(tmp_path / "hill.png")
    said = CliRunner().invoke(app, ["world", "import", str(tmp_path / "hill.png"), "--name", "hill", "--terrain", "30", "20", "5"])
    assert said.exit_code == 0, said.output
    assert load_world(tmp_path / "worlds", "hill").terrain.size == (30.0, 20.0, 5.0)
