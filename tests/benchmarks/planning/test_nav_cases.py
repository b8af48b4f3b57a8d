"""The group ``nav`` holds the cases of navigation and planning under the names that pages use."""

import numpy as np
import pytest

from benchmarks.planning import cases as nav
from benchmarks.planning import curves, cycle, recovery, sampling
from launch.commands.bench_selection import Selection, check_known
from launch.settings import benchmark_modules
from uvf.maths.curves.dubins_words import dubins_length
from uvf.models.yaml_data import BadInput
from uvf.planning.local.planners import LOCAL_PLANNERS

NAMES = {"barn", "dynabarn", "recovery", "cycle", "dubins", "coverage", "sampling", "survey", "movingai", "nav2maps", "goals"}


def test_the_group_has_each_case_and_planning_has_no_other_group():
    assert {name.partition(":")[0] for name in nav.cases(None, Selection())} == NAMES
    assert [group for group, module in benchmark_modules().items() if module.startswith("benchmarks.planning")] == ["nav"]


def test_no_group_is_called_as_a_case_is():
    """``uvf bench nav dubins`` is one case: a name that is a group's stands for the group."""
    assert NAMES.isdisjoint(benchmark_modules())


def test_recovery_takes_seed_and_trials_and_dubins_does_not():
    check_known("nav", ["recovery"], nav.OPTIONS, Selection(seed=2, trials=1))
    with pytest.raises(BadInput, match="nav dubins has no --seed"):
        check_known("nav", ["dubins"], nav.OPTIONS, Selection(seed=2))


def test_the_seed_and_the_number_of_trials_reach_recovery(monkeypatch):
    asked = []

    def run(case, seed):
        asked.append(seed)
        return recovery.Outcome(recovery.Status.REACHED, recovery.Failure.NONE, 1.0, 0, False, [], np.zeros((0, 3)))

    monkeypatch.setattr(recovery, "run", run)
    rows = nav.cases(None, Selection(seed=5, trials=2))["recovery"](None)
    assert asked == [5, 6] * 8 and all(name.startswith("recovery: ") for name in rows)
    assert rows["recovery: dead end"]["right"] == 1.0 and rows["recovery: closed room"]["right"] == 0.0


def test_a_cycle_is_told_by_its_parts_and_for_each_local_planner(monkeypatch):
    monkeypatch.setattr(cycle, "PLACES", 4)
    monkeypatch.setattr(cycle, "SAMPLES", 400)
    rows = nav.cases(None, Selection())["cycle"](None)
    parts = {"cycle: costmap 100 x 100, 720 beams", "cycle: window", "cycle: mppi 400 x 56", "cycle: mppi 400 x 56, 6 moving"}
    assert set(rows) == parts | {f"cycle: {name}" for name in LOCAL_PLANNERS}
    assert all(row["n"] == 3 and 0.0 < row["ms"] <= row["worst ms"] for row in rows.values())


def test_dubins_lengths_are_compared_with_those_of_the_files(tmp_path, monkeypatch):
    folder = tmp_path / "dubins"
    folder.mkdir()
    straight = "1.0,0,0,0,5,0,0,5.0\n"
    for name, off in (("dubins", 0.25), ("reeds_shepp", 0.0)):
        length = dubins_length((0.0, 0.0, 0.0), (7.0, 3.0, 1.0), 2.0) + off if name == "dubins" else None
        second = f"2.0,0,0,0,7,3,1,{length!r}\n" if length else straight
        (folder / f"{name}_ompl.csv").write_text(f"radius,x0,y0,a0,x1,y1,a1,length\n{straight}{second}")
    monkeypatch.setattr(curves, "ROUNDS", 1)
    monkeypatch.setattr(curves, "LARGE", 10)
    rows = nav.cases(tmp_path, Selection())["dubins"](tmp_path)
    assert rows["dubins: dubins"]["largest error / radius"] == pytest.approx(0.125)
    assert rows["dubins: reeds_shepp"]["largest error / radius"] < 1e-9


@pytest.mark.parametrize("name", ["dubins", "sampling:Berlin_0_256"])
def test_without_the_data_folder_the_file_is_named(name):
    with pytest.raises(BadInput, match="--data"):
        nav.cases(None, Selection())[name](None)


CITY = 60  # cells a side


@pytest.fixture
def city(tmp_path, monkeypatch):
    folder = tmp_path / "movingai" / "maps" / "cities"
    folder.mkdir(parents=True)
    rows = ["".join("@" if 25 <= i < 30 and 10 <= j < 50 else "." for j in range(CITY)) for i in range(CITY)]
    head = f"type octile\nheight {CITY}\nwidth {CITY}\nmap\n"
    (folder / "Berlin_0_256.map").write_text(head + "\n".join(rows) + "\n")
    for name, value in {"SECONDS": 0.15, "PAIRS": 1, "SEEDS": 1}.items():
        monkeypatch.setattr(sampling, name, value)
    return tmp_path


def test_without_ompl_its_row_is_left_out_and_a_line_says_so(city, monkeypatch, capsys):
    monkeypatch.setattr(sampling, "find_spec", lambda name: None)
    rows = nav.cases(city, Selection())["sampling:Berlin_0_256"](city)
    assert set(rows) == {"sampling: Berlin_0_256: RRT*", "sampling: Berlin_0_256: RRT*, cut short"}
    assert capsys.readouterr().err == "uvf: no OMPL: its rows are left out (pip install ompl)\n"
    assert all(row["success %"] == 100.0 and row["held %"] == 100.0 and row["median / line"] >= 1.0 for row in rows.values())


def test_ompl_is_measured_on_the_same_queries_where_there_is_one(city, monkeypatch):
    """A stand-in that drives half as far again as UVF's way does."""
    monkeypatch.setattr(sampling, "find_spec", lambda name: object())

    def longer(ground, query, seed):
        length, places = sampling.own(ground, 0, query, seed)
        return 1.5 * length, places

    monkeypatch.setattr(sampling, "ompl", longer)
    rows = nav.cases(city, Selection())["sampling:Berlin_0_256"](city)
    assert rows["sampling: Berlin_0_256: RRT*"]["peer"] == pytest.approx(1 / 1.5, rel=0.1)
    assert rows["sampling: Berlin_0_256: OMPL RRTstar"]["peer"] == 1.0


def test_the_check_of_ways_sees_obstacles_tight_turns_and_wrong_ends():
    occupied = np.zeros((40, 40), dtype=bool)
    occupied[20, 20] = True
    ground = sampling.Ground(sampling.clearance_field(occupied, 1.0), sampling.disc(0.0))
    x = np.arange(5.0, 35.0, 0.1)
    free, blocked = (np.column_stack((x, np.full(len(x), y), np.zeros(len(x)))) for y in (10.5, 20.5))

    def query(way):
        return tuple(map(tuple, way[[0, -1]]))

    assert sampling.holds(ground, query(free), free)
    assert not sampling.holds(ground, query(blocked), blocked)
    assert not sampling.holds(ground, query(free), free[:-1])
    assert not sampling.holds(ground, query(free), free[::2])
    tight = free.copy()
    tight[100:, 2] = 0.1
    assert not sampling.holds(ground, query(free), tight)
