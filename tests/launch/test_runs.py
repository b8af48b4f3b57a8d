"""Runs are kept in folders of their own until they take too much disk; what is being written is never touched."""

import os
import subprocess
import sys

import pytest

from launch.runs import given_up_when_refused, hold, keep_quota, new_run, prune
from uvf.models.yaml_data import BadInput


@pytest.fixture
def base(tmp_path, monkeypatch):
    """Three runs of a kilobyte each."""
    monkeypatch.setenv("UVF_RUNS", str(tmp_path))
    for day in (1, 2, 3):
        make(tmp_path, f"2026-01-0{day}_10-00-00", {"log-000.mcap": 1000})
    return tmp_path


def make(base, name, files):
    folder = base / name
    folder.mkdir()
    for file, size in files.items():
        (folder / file).write_bytes(bytes(size))
    return folder


def left(base):
    return [int(p.name[9]) for p in sorted(base.iterdir())]


def test_each_run_has_its_folder_and_latest_points_to_the_newest(tmp_path, monkeypatch):
    monkeypatch.setenv("UVF_RUNS", str(tmp_path / "runs"))
    first, second = new_run(), new_run()
    assert first != second
    assert (tmp_path / "runs" / "latest").resolve() == second.resolve()


def test_the_oldest_go_first_and_the_newest_stays(base):
    assert [f.name for f in prune(base, 2500)] == ["2026-01-01_10-00-00"]
    assert [f.name for f in prune(base, 10)] == ["2026-01-02_10-00-00"]
    assert left(base) == [3]


@pytest.mark.parametrize("text", ["nan", "-1", "much"])
def test_a_quota_that_is_none_removes_nothing(base, monkeypatch, text):
    monkeypatch.setenv("UVF_RUNS_QUOTA_GB", text)
    with pytest.raises(BadInput, match="not a number of gigabytes"):
        new_run()
    assert left(base) == [1, 2, 3]


def test_a_run_that_is_refused_leaves_nothing_and_the_one_before_is_the_latest(base):
    first = new_run()
    (first / "log-000.mcap").write_bytes(b"x")
    with pytest.raises(BadInput, match="no"), given_up_when_refused(folder := new_run()):
        raise BadInput("no")
    assert not folder.exists()
    assert (base / "latest").resolve() == first.resolve()
    with pytest.raises(BadInput, match="late"), given_up_when_refused(first):
        raise BadInput("late")
    assert (first / "log-000.mcap").exists()


def test_runs_of_one_second_are_told_apart_by_their_numbers(tmp_path):
    for name in ("2026-01-01_10-00-00-10", "2026-01-01_10-00-00", "2026-01-01_10-00-00-2"):
        make(tmp_path, name, {"log": 1000})
    assert [f.name for f in prune(tmp_path, 0)] == ["2026-01-01_10-00-00", "2026-01-01_10-00-00-2"]


def test_what_is_no_run_is_neither_counted_nor_removed(base):
    make(base, "letters", {"home": 9000})
    assert prune(base, 5000) == []
    prune(base, 0)
    assert (base / "letters" / "home").exists()


def test_a_run_that_somebody_writes_is_passed_over(base):
    descriptor = hold(base / "2026-01-01_10-00-00")
    assert [f.name for f in prune(base, 1500)] == ["2026-01-02_10-00-00"]
    os.close(descriptor)
    assert [f.name for f in prune(base, 1500)] == ["2026-01-01_10-00-00"]


def test_a_new_run_is_held_by_its_process(tmp_path, monkeypatch):
    monkeypatch.setenv("UVF_RUNS", str(tmp_path))
    mine = new_run()
    make(tmp_path, "2999-01-01_10-00-00", {"log": 1000})
    assert prune(tmp_path, 0) == []
    assert mine.exists()


def test_the_lock_of_a_killed_process_is_no_obstacle(base):
    path = str(base / "2026-01-01_10-00-00")
    code = f"from pathlib import Path; from launch.runs import hold; hold(Path({path!r})); print(flush=True); input()"
    writer = subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    try:
        writer.stdout.readline()
        assert [f.name for f in prune(base, 1500)] == ["2026-01-02_10-00-00"]
    finally:
        writer.kill()
        writer.communicate()
    assert (base / "2026-01-01_10-00-00" / ".held").exists()
    assert [f.name for f in prune(base, 1500)] == ["2026-01-01_10-00-00"]


def test_a_running_recorder_removes_old_runs_before_its_own_old_logs(base):
    own = make(base, "2026-01-04_10-00-00", {"log-000.mcap": 1000, "log-001.mcap": 1000, "log-002.mcap": 1000})
    hold(own)
    assert [p.name for p in keep_quota(own, 4500)] == ["2026-01-01_10-00-00", "2026-01-02_10-00-00"]
    assert [p.name for p in keep_quota(own, 2500)] == ["2026-01-03_10-00-00", "log-000.mcap"]
    assert [p.name for p in keep_quota(own, 0)] == ["log-001.mcap"]


def test_logs_elsewhere_have_the_quota_for_themselves(base, tmp_path_factory):
    own = make(tmp_path_factory.mktemp("elsewhere"), "logs", {"log-000.mcap": 1000, "log-001.mcap": 1000, "notes": 10})
    assert [p.name for p in keep_quota(own, 1500)] == ["log-000.mcap"]
    assert left(base) == [1, 2, 3]


def test_a_place_that_cannot_be_written_is_one_line(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("UVF_RUNS", str(tmp_path / "file" / "runs"))
    with pytest.raises(BadInput, match="UVF_RUNS"):
        new_run()
