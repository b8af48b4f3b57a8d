"""Maps of map_server: written and read back they are the same; foreign ones are read as ROS reads them; broken ones are one line."""

import errno
import os
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from PIL import Image

from launch.commands.testing import data_folder
from uvf.maths.se2 import Pose2
from uvf.models.world.map_file import GridMap, load_map, save_map
from uvf.models.yaml_data import BadInput

DATA = data_folder()
HEAD = "image: m.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
number = st.floats(-1e5, 1e5)
grids = st.builds(
    GridMap,
    arrays(np.int8, array_shapes(min_dims=2, max_dims=2, max_side=7), elements=st.integers(-1, 100)),
    st.floats(0.001, 10.0),
    st.builds(Pose2, number, number, st.floats(-3.14, 3.14)),
)


def written(tmp_path, yaml, pixels=None, content=None):
    if content is not None:
        (tmp_path / "m.pgm").write_bytes(content)
    if pixels is not None:
        Image.fromarray(np.array(pixels, dtype=np.uint8)).save(tmp_path / "m.pgm")
    (tmp_path / "m.yaml").write_text(yaml)
    return tmp_path / "m.yaml"


@settings(max_examples=60, deadline=None)
@given(grid=grids, mode=st.sampled_from(["scale", "raw"]))
def test_scale_and_raw_keep_everything(tmp_path_factory, grid, mode):
    again = load_map(save_map(grid, tmp_path_factory.mktemp("maps") / "m", mode))
    assert np.array_equal(again.cells, grid.cells)
    assert (again.resolution, again.origin) == (grid.resolution, grid.origin)


@settings(max_examples=60, deadline=None)
@given(grid=grids, suffix=st.sampled_from([".pgm", ".png", ".yaml", ""]))
def test_trinary_keeps_what_is_free_occupied_and_unknown(tmp_path_factory, grid, suffix):
    again = load_map(save_map(grid, tmp_path_factory.mktemp("maps") / f"m{suffix}"))
    wanted = np.where(grid.cells >= 65, 100, np.where((grid.cells >= 0) & (grid.cells <= 25), 0, -1))
    assert np.array_equal(again.cells, wanted)
    assert again.origin == grid.origin


def test_row_0_is_the_lowest_line_of_the_picture(tmp_path):
    cells = np.full((3, 2), -1, dtype=np.int8)
    cells[0, 1] = 100
    save_map(GridMap(cells, 0.1, Pose2(1.0, 2.0, 0.5)), tmp_path / "m.pgm")
    assert np.asarray(Image.open(tmp_path / "m.pgm")).tolist() == [[205, 205], [205, 205], [205, 0]]
    assert "origin: [1.0, 2.0, 0.5]\n" in (tmp_path / "m.yaml").read_text()


@pytest.mark.parametrize(
    ("lines", "cells"),
    [
        ("", [0, 0, -1, -1, 100, 100]),
        ("negate: 1", [100, 100, 100, -1, -1, 0]),
        ("mode: scale", [0, 0, 1, 65, 100, 100]),
        ("mode: raw", [-1, -1, -1, -1, 50, 0]),
        ("mode: raw\nnegate: true", [-1, -1, -1, -1, 50, 0]),
        ("occupied_thresh: 0.9\nfree_thresh: 0.1", [0, 0, -1, -1, -1, 100]),
    ],
)
def test_pixels_mean_what_nav2_takes_them_for(tmp_path, lines, cells):
    keys = [line.split(":")[0] for line in lines.splitlines()]
    head = "".join(f"{line}\n" for line in HEAD.splitlines() if line.split(":")[0] not in keys)
    path = written(tmp_path, head + lines, [[255, 254, 204, 130, 50, 0]])
    assert load_map(path).cells.tolist() == [cells]


def test_opacity_is_unknown_in_scale_and_one_more_colour_in_trinary(tmp_path):
    pixels = np.array([[[0, 255], [0, 0], [255, 0], [255, 255]]], dtype=np.uint8)
    Image.fromarray(pixels).save(tmp_path / "m.png")
    head = HEAD.replace("m.pgm", "m.png")
    assert load_map(written(tmp_path, head)).cells.tolist() == [[100, 100, -1, 0]]
    assert load_map(written(tmp_path, head + "mode: scale")).cells.tolist() == [[100, -1, -1, 0]]


@pytest.mark.skipif(DATA is None, reason="no data folder: Nav2's maps left out (set UVF_DATA)")
def test_maps_of_nav2_are_read():
    depot, keepout, speed = (load_map(DATA / "slam" / "maps" / f"nav2_depot{part}.yaml") for part in ("", "_keepout", "_speed"))
    assert depot.cells.shape == keepout.cells.shape == speed.cells.shape == (307, 604)
    assert set(np.unique(depot.cells)) <= {-1, 0, 100} and (depot.cells == 100).sum() > 1000
    assert (keepout.cells == 100).sum() > 1000
    assert speed.cells.min() >= 0 and len(np.unique(speed.cells)) > 2


def test_colours_count_alike(tmp_path):
    Image.fromarray(np.array([[[255, 0, 0], [255, 255, 255], [0, 90, 200]]], dtype=np.uint8)).save(tmp_path / "m.png")
    assert load_map(written(tmp_path, HEAD.replace("m.pgm", "m.png"))).cells.tolist() == [[100, 0, -1]]


@pytest.mark.parametrize(
    "content",
    [
        b"P5\n# made by hand\n3 1\n# and again\n255\n\xff\x00\x80",
        b"P5 3 1 255\n\xff\x00\x80",
        b"P2\n# plain\n3 1\n255\n255 0\n128\n",
        b"P2 3 1 15 15 0 8 ",
        b"P5 3 1 65535 \xff\xff\x00\x00\x80\x00",
    ],
)
def test_every_kind_of_pgm_is_read(tmp_path, content):
    assert load_map(written(tmp_path, HEAD, content=content)).cells.tolist() == [[0, 100, -1]]


@pytest.mark.parametrize(
    ("yaml", "part"),
    [
        (HEAD.replace("resolution: 0.05\n", ""), "key 'resolution' is missing"),
        (HEAD.replace("0.05", "-1"), r"m.yaml:2: resolution: -1 is not above 0"),
        (HEAD.replace("[0, 0, 0]", "[0]"), "write x, y"),
        (HEAD.replace("[0, 0, 0]", "[0, .nan, 0]"), "no number to work with"),
        (HEAD.replace("0.65", "0.1"), "free_thresh: 0.196 is not below occupied_thresh"),
        (HEAD + "mode: trinery", "did you mean 'trinary'"),
        (HEAD + "resolutoin: 1", "did you mean 'resolution'"),
        (HEAD.replace("m.pgm", "nobody.png"), "nobody.png: cannot be read as a picture: No such file"),
        ("[]", "m.yaml"),
        ("", "the file is empty"),
    ],
)
def test_wrong_yamls_are_one_line(tmp_path, yaml, part):
    with pytest.raises(BadInput, match=part) as refused:
        load_map(written(tmp_path, yaml, [[0]]))
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    "content",
    [b"", b"P5\n4 4\n255\nshort", b"P2\n4 4\n255\n1 2 3", b"P5\n-1 4\n255\n", b"P5\n100000 100000\n255\n", b"P9 1 1 1", b"P2 1 1 255 x"],
)
def test_broken_pictures_are_one_line(tmp_path, content):
    with pytest.raises(BadInput, match=r"m\.pgm: cannot be read as a picture") as refused:
        load_map(written(tmp_path, HEAD, content=content))
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("sides", [(5001, 5000), (12_000, 12_000), (10**5, 10**5), (99_999_999, 99_999_999)])
def test_a_picture_of_too_many_cells_is_refused_before_it_is_decoded(tmp_path, sides):
    head = b"P5\n%d %d\n255\n" % sides
    with pytest.raises(BadInput, match=r"m\.pgm: .* more than 25 million; cut it into parts, or make its cells larger") as refused:
        load_map(written(tmp_path, HEAD, content=head))
    assert "\n" not in str(refused.value)


def test_a_picture_takes_little_more_room_than_its_cells(tmp_path):
    cells = np.zeros((2500, 2500), dtype=np.int8)
    cells[3, 4], cells[2000, 2400] = 100, -1
    path = save_map(GridMap(cells, 0.05, Pose2(0.0, 0.0, 0.0)), tmp_path / "m.png", "scale")
    tracemalloc.start()
    again = load_map(path)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert np.array_equal(again.cells, cells)
    assert most < 25 * cells.size


def test_a_pipe_is_no_picture(tmp_path):
    os.mkfifo(tmp_path / "m.pgm")
    with pytest.raises(BadInput, match=r"m\.pgm: cannot be read as a picture: it is no file"):
        load_map(written(tmp_path, HEAD))


def test_a_map_that_was_renamed_is_still_found(tmp_path):
    path = written(tmp_path, HEAD.replace("m.pgm", "depot.pgm"), [[0, 255]])
    assert load_map(path).cells.tolist() == [[100, 0]]
    assert load_map(tmp_path / "m.pgm").cells.tolist() == [[100, 0]]


def test_a_file_of_another_kind_is_not_taken_for_the_map_beside_it(tmp_path):
    save_map(GridMap(np.zeros((4, 4), dtype=np.int8), 0.05, Pose2(0.0, 0.0, 0.0)), tmp_path / "first.yaml")
    with pytest.raises(BadInput, match=r"first\.npz: no map by its ending"):
        load_map(tmp_path / "first.npz")


def test_a_picture_without_its_yaml_is_told(tmp_path):
    with pytest.raises(BadInput, match="no such file; the picture's yaml"):
        load_map(tmp_path / "m.pgm")


def test_what_cannot_be_written_is_told(tmp_path):
    grid = GridMap(np.zeros((2, 2), dtype=np.int8), 0.05, Pose2(0.0, 0.0, 0.0))
    with pytest.raises(BadInput, match="did you mean 'trinary'"):
        save_map(grid, tmp_path / "m", "trinry")
    with pytest.raises(BadInput, match="mode scale needs transparency"):
        save_map(grid, tmp_path / "m.pgm", "scale")
    with pytest.raises(BadInput, match="without cells"):
        save_map(GridMap(np.zeros((0, 0), dtype=np.int8), 0.05, grid.origin), tmp_path / "m")


def test_a_full_disk_is_one_line_and_leaves_the_old_map(tmp_path, monkeypatch):
    grid = GridMap(np.zeros((2, 2), dtype=np.int8), 0.05, Pose2(0.0, 0.0, 0.0))
    save_map(grid, tmp_path / "m")
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}

    def full(path, content):
        path.open("wb").write(content[:1])
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(BadInput, match=r"m.pgm: cannot be written: No space left on device$"):
        save_map(GridMap(np.ones((5, 5), dtype=np.int8), 0.05, grid.origin), tmp_path / "m")
    monkeypatch.undo()
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before
