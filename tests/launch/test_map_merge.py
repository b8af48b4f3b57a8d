"""``uvf map merge`` on session files: what it writes, what it says, what it refuses."""

import numpy as np
import pytest
from typer.testing import CliRunner

from launch.cli import app
from tests.slam.merging.offices import anne, bert, first
from uvf.models.world.map_file import load_map
from uvf.slam.maps.session import MappingSession


@pytest.fixture
def merge(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("UVF_STATE", str(tmp_path / "state"))
    for name, session in {"anne": anne().session, "bert": bert().session, "stranger": bert(2).session}.items():
        session.save(tmp_path / f"{name}.npz")

    def run(*arguments):
        result = CliRunner().invoke(app, ["map", "merge", *arguments])
        return result.exit_code, result.output

    return run


def test_sessions_that_fit_are_one_map_and_one_session(merge, tmp_path):
    code, said = merge("anne.npz", "bert.npz", "stranger.npz", "--out", "team.yaml")
    assert code == 0, said
    x, y, yaw = anne().map_from(bert())
    told = next(line for line in said.splitlines() if "bert.npz: its origin" in line)
    numbers = [float(word.strip("(),")) for word in told.split(" at ")[1].split()[:4] if word.strip("(),").lstrip("-")[0].isdigit()]
    assert numbers == pytest.approx((x, y, np.degrees(yaw)), abs=0.5)
    assert "anne.npz: the frame of the others" in said and "stranger.npz: fits nowhere" in said
    assert len(MappingSession.load(tmp_path / "team.npz").keyframes) == len(anne().session.keyframes) + len(bert().session.keyframes)
    grid = load_map(tmp_path / "team.yaml")
    assert (grid.cells == 0).sum() * grid.resolution**2 > 80.0
    assert (tmp_path / "team.png").stat().st_size > 1000


def test_saved_sessions_are_known_by_their_names(merge, tmp_path):
    for name in ("anne", "bert"):
        (tmp_path / "state" / "maps").mkdir(parents=True, exist_ok=True)
        (tmp_path / f"{name}.npz").rename(tmp_path / "state" / "maps" / f"{name}.npz")
    code, said = merge("anne", "bert", "--out", "both")
    assert code == 0 and "bert: its origin is at" in said
    assert (tmp_path / "state" / "maps" / "both.npz").exists()


def test_when_nothing_fits_nothing_is_written_and_the_exit_code_tells(merge, tmp_path):
    code, said = merge("anne.npz", "stranger.npz")
    assert code == 1
    assert said.count("fits nowhere") == 2 and "nothing is written" in said
    assert not (tmp_path / "state").exists()


def test_bad_files_are_one_line(merge, tmp_path):
    (tmp_path / "broken.npz").write_bytes((tmp_path / "anne.npz").read_bytes()[:2000])
    first(anne().session, 0).save(tmp_path / "empty.npz")
    for files, part in (
        (("anne.npz",), "two sessions at least"),
        (("anne.npz", "./anne.npz"), "session ./anne.npz: given twice"),
        (("anne.npz", "none.npz"), "no such file"),
        (("anne.npz", "broken.npz"), "not a session"),
    ):
        code, said = merge(*files)
        assert (code, said.count("\n")) == (2, 1) and part in said
    assert merge("anne.npz", "empty.npz")[0] == 1
