"""Broken and odd files of worlds and maps: each is refused in one line, or what was left out is told."""

import numpy as np
import pytest
from PIL import Image

from uvf.models.importing.worlds import Options, import_world
from uvf.models.world.file import load_world
from uvf.models.yaml_data import BadInput

BOX = "<box><size>1 1 1</size></box>"
POINTER = "version https://git-lfs.github.com/spec/v1\noid sha256:ab\nsize 1\n"
MAP = "image: ok.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n"
COSTMAP = "local_costmap:\n  local_costmap:\n    ros__parameters:\n      update_frequency: 5.0\n"
LAUGHS = "a: &a [x,x,x,x,x,x,x,x,x]\n" + "".join(f"{b}: &{b} [{','.join([f'*{a}'] * 9)}]\n" for a, b in zip("abcde", "bcdef", strict=True))


def world(inside):
    return f'<sdf version="1.7"><world name="w">{inside}</world></sdf>'


def model(geometry=BOX, name="m", pose=""):
    link = f'<link name="l"><collision name="c"><geometry>{geometry}</geometry></collision></link>'
    return f'<model name="{name}"><static>true</static>{pose}{link}</model>'


def at(latitude):
    where = f"<latitude_deg>{latitude}</latitude_deg><longitude_deg>0</longitude_deg>"
    return world(f"<spherical_coordinates>{where}</spherical_coordinates>{model()}")


def with_map(old, new):
    assert old in MAP
    return MAP.replace(old, new)


REFUSED = {
    "w.world": {
        "empty": ("", "not valid XML"),
        "pointer of Git LFS": (POINTER, "get the file itself with 'git lfs pull'"),
        "a robot": ('<robot name="r"><link name="l"/></robot>', "the root is <robot>, not <sdf>; give a Gazebo world or model"),
        "no world": ('<sdf version="1.7"><light name="l"/></sdf>', "neither a <world> nor a <model> in it"),
        "of 2010": ('<gazebo:world xmlns:gazebo="x"><model:physical name="m"/></gazebo:world>', "not valid XML: Namespace prefix"),
        "pose of nan": (world(model(pose="<pose>nan 0 0 0 0 0</pose>")), "<pose> holds 'nan 0 0 0 0 0'; write 6 finite numbers"),
        "pose of five": (world(model(pose="<pose>1 0 0 0 0</pose>")), "write 6 finite numbers"),
        "model in itself": (world("<include><uri>model://selfish</uri></include>"), "models include each other without end"),
        "nothing but what is missing": (world("<include><uri>model://none</uri></include>"), "not found on this machine (give --models)"),
        "box of a light minute": (world(model("<box><size>1e12 1 1</size></box>")), "boxes[0]: size[0]: 1e+12 is above 10000"),
        "latitude of 200": (at(200), "200, 0 deg is no place on Earth"),
        "latitude of words": (at("north"), "<latitude_deg>: could not convert string to float: 'north'"),
    },
    "office.building.yaml": {"of RMF": ("coordinate_system: reference_image\nlevels: {}\n", "drawn for Open-RMF is no map")},
    "geometry.urdf.xacro": {"a building as a robot": ("<robot/>", "of a building make an SDF of it first: gz sdf -p")},
    "map.yaml": {
        "empty": ("", "the file is empty"),
        "tabs": ("image:\tok.pgm\n\tresolution: 0.05\n", "not valid YAML"),
        "laughs": (LAUGHS, "more than 100000 values"),
        "of a costmap": (COSTMAP, "unknown key 'local_costmap'; there are: free_thresh, image"),
        "no image": ("resolution: 0.05\norigin: [0, 0, 0]\n", "key 'image' is missing"),
        "image that is not there": (with_map("ok.pgm", "none.pgm"), "none.pgm: cannot be read as a picture: No such file"),
        "image that is cut off": (with_map("ok.pgm", "cut.pgm"), "cut.pgm: cannot be read as a picture"),
        "image that is a pointer": (with_map("ok.pgm", "pointer.pgm"), "pointer.pgm: only a pointer of Git LFS is there"),
        "image that is too large": (with_map("ok.pgm", "large.png"), "more than 25 million"),
        "image without walls": (with_map("ok.pgm", "white.pgm"), "no cell is occupied"),
        "cells of no size": (with_map("0.05", "0"), "resolution: 0 is not above 0"),
        "cells of negative size": (with_map("0.05", "-1"), "resolution: -1 is not above 0"),
        "thresholds the wrong way round": (with_map("0.65", "0.1"), "free_thresh: 0.2 is not below occupied_thresh, 0.1"),
        "origin of words": (with_map("[0, 0, 0]", "[a, b, c]"), "origin[0]: 'a' is not a number"),
    },
    "w.blend": {"another program's": ("BLENDER", "files of this kind are not taken over; give .world, .sdf")},
}
TOLD = {
    "box inside out": (model("<box><size>-1 1 1</size></box>", "bad"), "<size> holds '-1 1 1'; lengths of 0.1 mm and more are needed"),
    "a thing beyond the horizon": (
        model(name="far", pose="<pose>1e7 0 0 0 0 0</pose>"),
        "from the origin are left out: 1",
    ),
    "model of Fuel": (
        "<include><uri>https://fuel.gazebosim.org/1.0/o/models/Tree</uri></include>",
        "not found on this machine (download",
    ),
    "mesh that is not there": (model("<mesh><uri>none.dae</uri></mesh>", "bad"), "meshes not found, their shapes are missing: none.dae"),
    "mesh that is prose": (model("<mesh><uri>prose.stl</uri></mesh>", "bad"), "prose.stl: no triangles in it"),
    "mesh that is a pointer": (model("<mesh><uri>pointer.stl</uri></mesh>", "bad"), "only a pointer of Git LFS is there"),
    "frame that is not there": (model(name="odd", pose='<pose relative_to="ghost">1 0 0 0 0 0</pose>'), "frames that are not there"),
    "shape that is not known": (model("<image><uri>x.png</uri></image>", "bad"), "shapes of a kind that is not taken over (image)"),
}


@pytest.fixture
def folder(tmp_path):
    """What stands beside the file."""
    (tmp_path / "prose.stl").write_text("this is no mesh")
    for name in ("pointer.stl", "pointer.pgm"):
        (tmp_path / name).write_text(POINTER)
    cells = np.full((40, 40), 254, np.uint8)
    Image.fromarray(cells).save(tmp_path / "white.pgm")
    cells[0] = 0
    Image.fromarray(cells).save(tmp_path / "ok.pgm")
    (tmp_path / "cut.pgm").write_bytes((tmp_path / "ok.pgm").read_bytes()[:300])
    Image.new("1", (6000, 6000)).save(tmp_path / "large.png")
    selfish = tmp_path / "selfish"
    selfish.mkdir()
    (selfish / "model.config").write_text("<model><name>selfish</name><sdf version='1.7'>model.sdf</sdf></model>")
    (selfish / "model.sdf").write_text('<sdf version="1.7"><model name="s"><include><uri>model://selfish</uri></include></model></sdf>')
    return tmp_path


@pytest.mark.parametrize(("file", "name"), [(file, name) for file, cases in REFUSED.items() for name in cases])
def test_what_cannot_be_taken_is_refused_in_one_line_and_leaves_nothing_behind(folder, file, name):
    text, answer = REFUSED[file][name]
    (folder / file).write_text(text)
    with pytest.raises(BadInput) as refused:
        import_world(folder / file, folder / "worlds" / "it", Options(models=(folder,)))
    assert answer in str(refused.value)
    assert "\n" not in str(refused.value) and ".import-" not in str(refused.value)
    assert not list((folder / "worlds").glob("*"))


@pytest.mark.parametrize("name", TOLD)
def test_what_is_left_out_is_told_and_the_rest_is_taken(folder, name):
    inside, answer = TOLD[name]
    (folder / "w.world").write_text(world(model() + inside))
    _, lines = import_world(folder / "w.world", folder / "worlds" / "it", Options(models=(folder,)))
    assert any(answer in line for line in lines)
    assert load_world(folder / "worlds", "it").boxes[0].name == "m"
