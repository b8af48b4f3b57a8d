"""What all tests keep to.

What runs against the wall clock may miss a deadline on a busy machine: it has a second try, and the end of the run tells which
tests needed it and why (FLAKED): each is a fault to be looked for, of the test or of what it tests.
Hypothesis tries the same examples each time.
"""

import gc
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


def pytest_collection_finish(session):
    """What has been collected stays: no garbage collection looks through it again."""
    gc.collect()
    gc.freeze()


def pytest_terminal_summary(terminalreporter):
    """One line for each test that passed at its second try only, and for each program that could not be had here."""
    root = terminalreporter.config.rootpath
    passed = {report.nodeid for report in terminalreporter.stats.get("passed", [])}
    failed = {report.nodeid for kind in ("failed", "error") for report in terminalreporter.stats.get(kind, [])}
    for report in terminalreporter.stats.get("rerun", []):
        if report.nodeid in passed - failed:
            terminalreporter.line(f"FLAKED {report.nodeid}: first try: {first_failure(report, root)}; second try: passed", yellow=True)
    reasons = {report.longrepr[2].removeprefix("Skipped: ") for report in terminalreporter.stats.get("skipped", [])}
    for reason in sorted(reason for reason in reasons if " left out: " in reason):
        terminalreporter.line(f"uvf: {reason}")


def first_failure(report, root):
    """Place and first line of the message; where not in the test itself, in which part."""
    part = "" if report.when == "call" else f"{report.when}: "
    crash = getattr(report.longrepr, "reprcrash", None)
    if crash is None:
        return part + (str(report.longrepr).splitlines() or ["no message"])[-1]
    path = Path(crash.path)
    place = path.relative_to(root) if path.is_relative_to(root) else path
    return f"{part}{place}:{crash.lineno}: {crash.message.splitlines()[0]}"
