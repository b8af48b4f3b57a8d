"""``uvf test``: pytest over the whole tree, and one line for what this machine cannot run."""

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import IO

import typer

from uvf.models.scenario import ROOT

PROCESSES, BROWSER = "tests/distributed", "tests/browser"
"""Tests on the wall clock. Two at once would make each other late, and together take as long."""


def left_out() -> list[str]:
    """The tests that will be skipped on this machine, and what would enable them."""
    lines = []
    if not data_folder():
        lines.append("no data folder: benchmark data tests left out (set UVF_DATA)")
    if not shutil.which("chromium"):
        lines.append("no chromium: browser tests left out (Debian: apt install chromium)")
    return lines


def data_folder() -> Path | None:
    """The folder with benchmark data, when there is one."""
    folder = Path(os.environ.get("UVF_DATA", ROOT.parent / "shared" / "data"))
    return folder if folder.is_dir() else None


def run_tests(arguments: Sequence[str]) -> int:
    """Runs pytest in processes of its own; returns the first exit code that is not 0.

    Without arguments all tests. Those that keep a time of their own run on every core with what the real processes of the others leave
    of them; a browser that draws without a graphics card leaves nothing.
    """
    for line in left_out():
        typer.echo(f"uvf: {line}")
    if arguments:
        return _pytest(arguments).wait()
    own_time = _pytest(["-n", "auto", "--dist", "loadfile", f"--ignore={PROCESSES}", f"--ignore={BROWSER}"])
    step_aside(own_time.pid)
    with tempfile.TemporaryFile() as said:
        codes = [_pytest([PROCESSES], said).wait()]
        said.seek(0)
        typer.echo(f"\n{said.read().decode(errors='replace')}")
    codes += [own_time.wait(), _pytest([BROWSER]).wait()]
    return next((code for code in codes if code), 0)


def _pytest(arguments: Sequence[str], output: IO[bytes] | None = None) -> subprocess.Popen[bytes]:
    return subprocess.Popen([sys.executable, "-m", "pytest", *arguments], cwd=ROOT, stdout=output, stderr=output)


def step_aside(process: int) -> None:
    """A process, and whatever it will start, has only the time that no other wants; process: its id."""
    if hasattr(os, "sched_setscheduler"):
        os.sched_setscheduler(process, os.SCHED_IDLE, os.sched_param(0))
    else:
        os.setpriority(os.PRIO_PROCESS, process, 19)
