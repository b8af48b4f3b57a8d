"""``uvf test``: pytest over the whole tree, and one line for what this machine cannot run."""

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import typer

from uvf.models.scenario import ROOT

ON_THE_WALL = ["tests/browser", "tests/distributed"]
"""Tests of real processes in real time: two at once would make each other late, and together take as long."""


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

    Without arguments all tests: on every core those that have their own time, then by themselves those that live on the wall clock.
    """
    for line in left_out():
        typer.echo(f"uvf: {line}")
    own_time = ["-n", "auto", "--dist", "loadfile", *(f"--ignore={folder}" for folder in ON_THE_WALL)]
    runs = [list(arguments)] if arguments else [own_time, ON_THE_WALL]
    codes = [subprocess.run([sys.executable, "-m", "pytest", *run], cwd=ROOT, check=False).returncode for run in runs]
    return next((code for code in codes if code), 0)
