"""The group ``nav`` holds the cases of navigation and planning under the names that pages use."""

import numpy as np
import pytest

from benchmarks.planning import cases as nav
from benchmarks.planning import curves, recovery
from launch.commands.bench_selection import Selection, check_known
from launch.settings import benchmark_modules
from uvf.maths.curves.dubins_words import dubins_length
from uvf.models.yaml_data import BadInput

NAMES = {"barn", "dynabarn", "recovery", "dubins", "coverage", "sampling", "survey", "movingai", "nav2maps"}


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
