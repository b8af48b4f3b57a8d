"""Every benchmark group can be loaded: what it measures is still there under the names it uses."""

import importlib

import pytest

from benchmarks import kept
from uvf.models.scenario import ROOT

GROUPS = sorted(path.stem for path in (ROOT / "benchmarks").glob("*.py") if "CASES = " in path.read_text())


@pytest.mark.parametrize("group", GROUPS)
def test_a_group_has_cases_that_can_be_called(group):
    module = importlib.import_module(f"benchmarks.{group}")
    if callable(module.CASES):
        return  # what depends on data has tests of its own
    cases = module.CASES
    assert cases and all(map(callable, cases.values()))


@pytest.mark.parametrize("group", ["air", "fleet", "sim"])
def test_real_time_factors_are_measured(group, monkeypatch):
    module = importlib.import_module(f"benchmarks.{group}")
    monkeypatch.setattr(module, "SECONDS", 0.2)
    if hasattr(module, "FLEETS"):
        monkeypatch.setattr(module, "FLEETS", (1,))
    for case in module.CASES.values():
        figures = case(None)
        assert figures and all(value > 0 for row in figures.values() for value in row.values())


def test_what_has_been_flown_is_kept_until_its_sources_change(tmp_path, monkeypatch):
    flown = []

    def fly(seed):
        flown.append(seed)
        return {"seed": seed}

    monkeypatch.setattr(kept, "FOLDER", tmp_path)
    assert [kept.figures_of(fly, (seed,)) for seed in (1, 2, 1)] == [{"seed": 1}, {"seed": 2}, {"seed": 1}]
    assert flown == [1, 2]
    monkeypatch.setattr(kept, "_sources", lambda own: "changed")
    kept.figures_of(fly, (1,))
    assert flown == [1, 2, 1]
