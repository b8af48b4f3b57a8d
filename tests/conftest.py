"""What all tests keep to.

What runs against the wall clock may miss a deadline on a busy machine: it has a second try, which the summary tells (R).
Hypothesis tries the same examples each time.
"""

from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("repeatable", derandomize=True)
settings.load_profile("repeatable")

WALL = [Path(__file__).parent / folder for folder in ("browser", "distributed")]


def pytest_collection_modifyitems(items):
    for item in items:
        if any(item.path.is_relative_to(folder) for folder in WALL):
            item.add_marker(pytest.mark.flaky(reruns=1))


def pytest_terminal_summary(terminalreporter):
    """One line for each program that could not be had here."""
    reasons = {report.longrepr[2].removeprefix("Skipped: ") for report in terminalreporter.stats.get("skipped", [])}
    for reason in sorted(reason for reason in reasons if " left out: " in reason):
        terminalreporter.line(f"uvf: {reason}")
