"""Runs are kept in folders of their own until they take too much disk."""

import pytest

from uvf.launch.runs import new_run, prune
from uvf.runtime.params import BadInput


def test_each_run_has_its_folder_and_latest_points_to_the_newest(tmp_path, monkeypatch):
    monkeypatch.setenv("UVF_RUNS", str(tmp_path / "runs"))
    first, second = new_run(), new_run()
    assert first != second
    assert (tmp_path / "runs" / "latest").resolve() == second.resolve()


def test_the_oldest_go_first_and_the_newest_stays(tmp_path):
    for name in ("2026-01-01", "2026-01-02", "2026-01-03"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "log").write_bytes(bytes(1000))
    assert [f.name for f in prune(tmp_path, 2500)] == ["2026-01-01"]
    assert [f.name for f in prune(tmp_path, 10)] == ["2026-01-02"]
    assert (tmp_path / "2026-01-03" / "log").exists()


def test_a_place_that_cannot_be_written_is_one_line(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("UVF_RUNS", str(tmp_path / "file" / "runs"))
    with pytest.raises(BadInput, match="UVF_RUNS"):
        new_run()
