"""``uvf map`` on files: what it says, what it draws, what it refuses."""

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from launch.cli import app
from launch.maps.running import doubt
from schemas import topics
from uvf.maths.se2 import IDENTITY, Pose2
from uvf.models.world.map_file import GridMap, load_map, save_map
from uvf.runtime.bus.interface import Sample
from uvf.runtime.log.recording import Recorder
from uvf.runtime.messages.convert import occupancy_grid, planar_frame

ROOM = np.full((60, 80), -1, dtype=np.int8)
ROOM[10:50, 10:70] = 0
ROOM[9:51, [9, 70]] = ROOM[[9, 50], 9:71] = 100


@pytest.fixture
def uvf(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("UVF_STATE", str(tmp_path / "state"))
    monkeypatch.setenv("UVF_RUNS", str(tmp_path / "runs"))

    def run(*arguments):
        result = CliRunner().invoke(app, ["map", *arguments])
        return result.exit_code, result.output

    return run


@pytest.fixture
def past_run(tmp_path):
    """Of two rovers that have drawn a room, the second one placed and turned in the world; the first has the team's map."""
    with Recorder(tmp_path / "log-000.mcap") as recorder:
        for owner, place in {"anne": Pose2(0.0, 0.0, 0.0), "bert": Pose2(1.0, -2.0, np.pi / 2)}.items():
            said = (
                (topics.MAP, occupancy_grid(np.full((4, 4), -1, dtype=np.int8), 0.05, 0.0, 0.0, f"{owner}/map", 1.0)),
                (topics.MAP, occupancy_grid(ROOM, 0.05, 0.5, 0.0, f"{owner}/map", 2.0)),
                (topics.TF_WORLD, planar_frame(0.0, "world", f"{owner}/map", place)),
            )
            for n, (topic, message) in enumerate(said, start=1):
                recorder.write(Sample(topic.at(owner), message.DESCRIPTOR.full_name, message.SerializeToString(), n, n, 0))
    return tmp_path


def test_the_map_of_a_past_run_is_saved_where_it_lies_in_the_world(uvf, past_run, tmp_path):
    assert uvf("save", "room", "--run", str(past_run), "--vehicle", "bert")[0] == 0
    room = load_map(tmp_path / "state" / "maps" / "room.yaml")
    assert room.cells.shape == ROOM.shape and room.origin == pytest.approx((1.0, -1.5, np.pi / 2), abs=1e-6)
    assert uvf("save", "own", "--run", str(past_run), "--vehicle", "bert", "--own-frame")[0] == 0
    assert load_map(tmp_path / "state" / "maps" / "own.yaml").origin == pytest.approx((0.5, 0.0, 0.0), abs=1e-6)


def test_a_map_that_no_past_run_has_is_one_line(uvf, past_run):
    for arguments, part in (
        ((), "choose one by --vehicle: anne, bert"),
        (("--vehicle", "ann"), "did you mean 'anne'?"),
        (("--layer", "team"), "no map in this log of a team"),
        (("--layer", "tem"), "did you mean 'team'?"),
        (("--vehicle", "anne", "--session"), "a log holds no session"),
    ):
        code, said = uvf("save", "room", "--run", str(past_run), *arguments)
        assert code == 2 and part in " ".join(said.split()), said


def test_load_tells_what_is_in_a_map(uvf, tmp_path):
    save_map(GridMap(ROOM, 0.05, Pose2(1.0, -2.0, 0.5)), tmp_path / "state" / "maps" / "room.yaml")
    code, said = uvf("load", "room")
    assert code == 0
    assert "80 x 60 cells of 0.05 m: 4.00 x 3.00 m" in said
    assert "corner at (1, -2) m, yaw 28.6479 deg" in said
    assert "free 6.0 m^2, occupied 0.51 m^2, unknown 45.8% of the cells" in said
    assert "0 look doubled" in said


def test_compare_measures_a_shift_and_draws_it(uvf, tmp_path):
    save_map(GridMap(ROOM, 0.05, IDENTITY), tmp_path / "a.yaml")
    save_map(GridMap(ROOM, 0.05, Pose2(1.0, 0.0, 0.0)), tmp_path / "b.yaml")
    code, said = uvf("compare", "a.yaml", "b.yaml", "--shift", "1.0", "0", "0", "--out", "same.png")
    assert code == 0 and "walls within 0.05 m: F1 1.000" in said and "IoU of free ones 1.000" in said
    _, said = uvf("compare", "a.yaml", "b.yaml", "--out", "off.png")
    assert "walls within 0.10 m: F1 1.000" not in said
    same, off = (np.asarray(Image.open(tmp_path / name)) for name in ("same.png", "off.png"))
    assert same.shape == (60, 80, 3) and off.shape == (60, 100, 3)
    assert (same == (0, 0, 0)).all(axis=2).sum() == (ROOM == 100).sum()
    assert (same[..., 0] > same[..., 2]).sum() == 0
    assert (off[..., 0] > off[..., 2]).sum() > 50 and (off[..., 2] > off[..., 0]).sum() > 50


def test_what_cannot_be_compared_is_one_line(uvf, tmp_path):
    save_map(GridMap(ROOM, 0.05, IDENTITY), tmp_path / "a.yaml")
    save_map(GridMap(ROOM, 0.05, Pose2(1e5, 0.0, 0.0)), tmp_path / "far.yaml")
    for arguments, part in (
        (("a.yaml",), "needs one thing to compare with"),
        (("a.yaml", "b.yaml"), "b.yaml: no such file"),
        (("a.yaml", "far.yaml"), "the maps lie far apart"),
        (("a.yaml", "--world", "hous"), "did you mean 'house'"),
        (("nobody", "a.yaml"), "no map 'nobody' is saved; there are: none"),
    ):
        code, said = uvf("compare", *arguments)
        assert code == 2 and part in said and said.count("\n") == 1


@pytest.mark.parametrize("shift", [("nan", "0", "0"), ("0", "inf", "0")])
def test_a_shift_that_is_no_number_is_one_line(uvf, tmp_path, shift):
    save_map(GridMap(ROOM, 0.05, IDENTITY), tmp_path / "a.yaml")
    code, said = uvf("compare", "a.yaml", "a.yaml", "--shift", *shift)
    assert (code, said.count("\n")) == (2, 1) and "three finite numbers are needed" in said


def test_a_map_is_measured_against_a_world(uvf, tmp_path):
    save_map(GridMap(np.full((20, 20), -1, dtype=np.int8), 0.05, IDENTITY), tmp_path / "a.yaml")
    code, said = uvf("compare", "a.yaml", "--world", "watkins", "--out", "a.png")
    assert code == 0 and "100.0% of the world's free floor is unknown" in said


def test_a_map_without_walls_has_dashes_and_no_negative_zero(uvf, tmp_path):
    save_map(GridMap(np.full((20, 20), 0, dtype=np.int8), 0.05, Pose2(-0.0, 0.0, -0.0)), tmp_path / "a.yaml")
    code, said = uvf("compare", "a.yaml", "a.yaml")
    assert code == 0 and "nan" not in said
    assert "walls lie off the true ones by - on average, 95 % by less than -" in said
    assert "corner at (0, 0) m, yaw 0 deg" in uvf("load", "a.yaml")[1]


def test_the_picture_of_differences_lands_in_the_runs_folder(uvf, tmp_path):
    save_map(GridMap(ROOM, 0.05, IDENTITY), tmp_path / "a.yaml")
    _, said = uvf("compare", "a.yaml", "a.yaml")
    assert f"uvf: {tmp_path / 'runs' / 'compare.png'}: white" in said
    assert (tmp_path / "runs" / "compare.png").is_file() and not (tmp_path / "compare.png").exists()


def test_a_map_that_is_mostly_written_as_unknown_is_told_of():
    once = GridMap(np.where(ROOM == 0, 40, ROOM).astype(np.int8), 0.05, IDENTITY)
    assert "of the cells that were seen are written as unknown" in doubt(once, "trinary") and "--mode scale" in doubt(once, "trinary")
    assert doubt(once, "scale") == doubt(GridMap(ROOM, 0.05, IDENTITY), "trinary") == ""
    assert doubt(GridMap(np.full((2, 2), -1, dtype=np.int8), 0.05, IDENTITY), "trinary") == ""
