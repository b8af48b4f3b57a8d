"""What runs against the wall clock may miss a deadline on a busy machine: it has a second try, which the summary tells (R)."""

from pathlib import Path

import pytest

WALL = [Path(__file__).parent / folder for folder in ("browser", "distributed")]


def pytest_collection_modifyitems(items):
    for item in items:
        if any(item.path.is_relative_to(folder) for folder in WALL):
            item.add_marker(pytest.mark.flaky(reruns=1))
