"""Rows, tables of single runs and pictures of the group ``nav``."""

import csv

import numpy as np
import pytest

from benchmarks.planning.barn import cases, many
from benchmarks.planning.barn.registry import known_controller
from benchmarks.planning.barn.simulation import Run
from launch.commands.bench import run_groups
from launch.commands.bench_selection import Selection
from tests.benchmarks.planning.barn.made_up import folder
from uvf.models.yaml_data import BadInput


def ended(world, ending, time, score):
    nothing = np.zeros((0, 3))
    return Run(world, 0, ending, time, score, 0.1, np.zeros(3), nothing, nothing, nothing[:, :2], nothing, 2.0, 9.0)


def test_a_row_is_as_the_organisers_report_it():
    """Times: the mean over worlds of their own successful means; all else over the runs."""
    made = [
        ended("world_1", "success", 10.0, 0.5),
        ended("world_1", "success", 20.0, 0.3),
        ended("world_2", "success", 40.0, 0.1),
        ended("world_2", "collision", 3.0, 0.0),
    ]
    row = cases.row_of([*made, ended("world_3", "timeout", 100.0, 0.0), ended("world_3", "timeout", 100.0, 0.0)])
    assert row["time s"] == pytest.approx((15.0 + 40.0) / 2)
    assert row["score"] == pytest.approx(0.9 / 6) and row["n"] == 6
    assert [row[f"{name} %"] for name in cases.ENDINGS] == pytest.approx([50.0, 100 / 6, 100 / 3])
    assert "time s" not in cases.row_of([ended("world_3", "timeout", 100.0, 0.0)])
    assert "score" not in cases.row_of([ended("easy_3", "timeout", 100.0, None)])


def test_one_command_makes_a_table_rows_of_runs_and_pictures(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(many.os, "sched_getaffinity", lambda process: {0})  # no other process needs to start
    data, table, pictures = folder(tmp_path), tmp_path / "runs.csv", tmp_path / "pictures"
    table.write_text("of before\n")
    selection = Selection(trials=2, seed=3, controller="straight", csv=table, pictures=pictures)
    run_groups(["nav", "barn", "dynabarn"], data, None, False, selection)
    rows = list(csv.DictReader(table.read_text().splitlines()))
    assert [(r["case"], r["world"], r["trial"]) for r in rows[:4]] == [("barn", f"world_{w}", t) for w in "47" for t in "01"]
    assert [r["collision"] for r in rows[:4]] == ["1", "1", "0", "0"] and [r["success"] for r in rows[:4]] == ["0", "0", "1", "1"]
    assert [r["score"] for r in rows] == ["0.0000", "0.0000", "0.5000", "0.5000", "", ""]
    assert float(rows[2]["time"]) == pytest.approx(8.9, abs=0.1)
    drawn = {path.name for path in pictures.iterdir()}
    assert {"barn-world_4-0-collision.png", "barn-world_4-1-collision.png"} <= drawn and not any("success" in name for name in drawn)
    said = capsys.readouterr().out
    assert "barn, straight" in said and "dynabarn, straight" in said


def test_a_seed_makes_the_same_rows_again(tmp_path):
    data = folder(tmp_path)
    told = []
    for _ in range(2):
        run_groups(["nav", "dynabarn"], data, None, False, Selection(seed=8, controller="straight", csv=tmp_path / "runs.csv"))
        told.append((tmp_path / "runs.csv").read_text())
    assert told[0] == told[1] and told[0].count("\n") == 2


def test_a_controller_that_is_not_there_is_refused_with_the_nearest():
    with pytest.raises(BadInput, match="did you mean 'straight'"):
        known_controller("straigth")


def test_a_path_cannot_be_followed_where_there_is_none(tmp_path):
    with pytest.raises(BadInput, match=r"easy_2: it has no path.*--controller"):
        run_groups(["nav", "dynabarn"], folder(tmp_path), None, False, Selection(controller="path"))
