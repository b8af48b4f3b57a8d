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
