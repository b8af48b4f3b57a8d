"""Every benchmark group can be loaded: what it measures is still there under the names it uses."""

import importlib

import pytest

from uvf.runtime.site import ROOT

GROUPS = sorted(path.stem for path in (ROOT / "benchmarks").glob("*.py") if "CASES = " in path.read_text())


@pytest.mark.parametrize("group", GROUPS)
def test_a_group_has_cases_that_can_be_called(group):
    cases = importlib.import_module(f"benchmarks.{group}").CASES
    assert cases and all(map(callable, cases.values()))
