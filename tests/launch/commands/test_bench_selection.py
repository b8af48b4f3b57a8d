"""Options of ``uvf bench`` that only some cases know."""

import types
from pathlib import Path

import pytest

from launch.commands import bench
from launch.commands.bench_selection import Selection
from uvf.models.yaml_data import BadInput


@pytest.fixture
def measured(monkeypatch):
    """The selections with which cases have run: one knows worlds and seed, one nothing; and a group of before."""
    ran = []

    def cases(data, selection):
        return {name: lambda data, name=name: ran.append((name, selection)) or {name: {"m": 1.0}} for name in ("some", "none")}

    modules = {
        "benchmarks.runtime.bus.round_trips": types.SimpleNamespace(CASES=cases, OPTIONS={"some": {"worlds", "seed", "csv"}, "none": ()}),
        "benchmarks.sim.real_time": types.SimpleNamespace(CASES=lambda data: {"old": lambda data: {"old": {"m": 2.0}}}),
    }
    monkeypatch.setattr(bench.importlib, "import_module", modules.__getitem__)
    return ran


def test_a_case_that_knows_an_option_gets_it(measured):
    bench.run_groups(["bus", "some"], None, None, False, Selection(worlds="0:5", seed=0))
    assert measured == [("some", Selection(worlds="0:5", seed=0))]


@pytest.mark.parametrize(
    ("names", "selection", "said"),
    [
        (["bus"], Selection(worlds="1"), "bench bus none has no --worlds; name cases that have it: some"),
        (["bus", "none"], Selection(seed=0), "bench bus none has no --seed; name cases that have it: some"),
        (["bus", "some"], Selection(trials=3), "bench bus some has no --trials; leave it out"),
        (["sim"], Selection(pictures=Path("x")), "bench sim has no --pictures; leave it out"),
        (["bus", "some", "sim"], Selection(worlds="1"), "bench sim has no --worlds; leave it out"),
    ],
)
def test_an_option_that_a_chosen_case_does_not_know_is_refused_before_anything_runs(measured, names, selection, said):
    with pytest.raises(BadInput) as refused:
        bench.run_groups(names, None, None, False, selection)
    assert str(refused.value) == said and measured == []


def test_without_options_all_cases_run_and_groups_of_before_as_before(measured, capsys):
    bench.run_groups(["bus", "sim"], None, None, False)
    assert [name for name, _ in measured] == ["some", "none"] and "old" in capsys.readouterr().out


def test_a_file_that_cannot_be_written_is_told_before_anything_runs(measured, tmp_path):
    with pytest.raises(BadInput, match="cannot be written"):
        bench.run_groups(["bus", "some"], None, None, False, Selection(csv=tmp_path / "gone" / "x.csv"))
    assert measured == []


def test_options_are_told_as_they_can_be_typed():
    assert Selection("0:5", trials=2, csv=Path("a b.csv")).words() == ["--worlds", "0:5", "--trials", "2", "--csv", "a b.csv"]
