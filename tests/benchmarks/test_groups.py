"""Every benchmark group can be loaded: what it measures is still there under the names it uses."""

import importlib

import pytest

from launch.settings import ROOT, benchmark_modules

GROUPS = benchmark_modules()


def test_every_module_with_cases_is_a_group():
    found = {path.relative_to(ROOT) for path in (ROOT / "benchmarks").rglob("*.py") if "CASES = " in path.read_text()}
    assert {".".join(path.with_suffix("").parts) for path in found} == set(GROUPS.values())


@pytest.mark.parametrize("group", GROUPS)
def test_a_group_has_cases_that_can_be_called(group):
    module = importlib.import_module(GROUPS[group])
    if callable(module.CASES):
        return  # what depends on data has tests of its own
    cases = module.CASES
    assert cases and all(map(callable, cases.values()))


@pytest.mark.parametrize("group", ["air", "fleet", "sim"])
def test_real_time_factors_are_measured(group, monkeypatch):
    module = importlib.import_module(GROUPS[group])
    monkeypatch.setattr(module, "SECONDS", 0.2)
    if hasattr(module, "FLEETS"):
        monkeypatch.setattr(module, "FLEETS", (1,))
    for case in module.CASES.values():
        figures = case(None)
        assert figures and all(value > 0 for row in figures.values() for value in row.values())
