"""A test that needs its second try is told of at the end of the run, with what went wrong the first time."""

from pathlib import Path

import pytest

pytest_plugins = ["pytester"]

CONFTEST = Path(__file__).with_name("conftest.py").read_text()
LATE = """
import pytest
from pathlib import Path

@pytest.fixture
def started(tmp_path_factory):
    mark = Path(__file__).with_name("started")
    if not mark.exists():
        mark.touch()
        raise TimeoutError("no page on port 8080")

def test_late():
    mark = Path(__file__).with_name("tried")
    if not mark.exists():
        mark.touch()
        assert 3 < 2, "the page is late"

def test_starts(started):
    pass

def test_always():
    pass

def test_never():
    assert 1 == 2
"""


@pytest.mark.parametrize("processes", ["-n0", "-n2"])
def test_a_test_that_passes_at_its_second_try_is_told_with_message_and_place_of_the_first(pytester, processes):
    pytester.makeconftest(CONFTEST)
    pytester.mkdir("browser").joinpath("test_browser.py").write_text(LATE)
    told = pytester.runpytest_subprocess("-q", processes, "browser").outlines
    late, starts = sorted(line for line in told if line.startswith("FLAKED"))
    place = "browser/test_browser.py"
    assert late == f"FLAKED {place}::test_late: first try: {place}:16: AssertionError: the page is late; second try: passed"
    assert starts == f"FLAKED {place}::test_starts: first try: setup: {place}:10: TimeoutError: no page on port 8080; second try: passed"
    assert any(line.startswith("FAILED") and "test_never" in line for line in told)


def test_only_tests_on_the_wall_clock_have_a_second_try(pytester):
    pytester.makeconftest(CONFTEST)
    pytester.mkdir("launch").joinpath("test_launch.py").write_text(LATE)
    done = pytester.runpytest_subprocess("-q", "-n0", "launch")
    done.assert_outcomes(passed=1, failed=2, errors=1)
    assert not any(line.startswith("FLAKED") for line in done.outlines)
