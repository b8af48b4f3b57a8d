"""The tutorial does what it says: its files and commands, in a copy of the tree."""

import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from foxglove_schemas_protobuf.LaserScan_pb2 import LaserScan

from tests.docs.lessons import LESSONS, Command, File, alike, steps
from uvf.models.scenario import ROOT

pytestmark = pytest.mark.timeout(300)  # where kernels have to be compiled first
TUTORIAL = ROOT / "docs" / "tutorial"
CODE = ("launch", "services", "schemas", "src", "vehicles", "worlds", "missions", "examples")


@pytest.fixture(scope="module")
def clone(tmp_path_factory):
    """A tree of one's own, compiled kernels included, in which the lessons leave their files."""
    folder = tmp_path_factory.mktemp("uvf")
    for name in CODE:
        shutil.copytree(ROOT / name, folder / name)
    for name in ("uvf", "pyproject.toml", "docker-compose.yml"):
        shutil.copy2(ROOT / name, folder / name)
    (folder / ".venv").symlink_to(ROOT / ".venv")
    return folder


def run(command: str, folder: Path) -> list[str]:
    paths = f"{folder}{os.pathsep}{folder / 'src'}"  # the environment's own is the tree that it was made for
    environment = {**os.environ, "COLUMNS": "120", "UVF_STATE": str(folder / "state"), "PYTHONPATH": paths}
    done = subprocess.run(command.split(), cwd=folder, env=environment, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, f"{command}\n{done.stdout}{done.stderr}"
    return (done.stdout + done.stderr).splitlines()


@pytest.mark.parametrize("lesson", LESSONS)
def test_lesson(lesson, clone):
    for step in steps(TUTORIAL / f"{lesson}.md"):
        if isinstance(step, File):
            step.write(clone)
        elif isinstance(step, Command):
            seen = [alike(line) for line in run(step.line, clone)]
            missing = [line for line in step.output if not any(alike(line) in each for each in seen)]
            assert missing == [], f"{step.line} printed {seen}"


def program(name: str = "wander") -> dict:
    """The names of the tutorial's program."""
    (text,) = (step.text for step in steps(TUTORIAL / "first-algorithm.md") if isinstance(step, File) and step.path == "wander.py")
    names: dict = {"__name__": name}
    exec(compile(text, "wander.py", "exec"), names)
    return names


def scan_of(wall: float, left: float, right: float) -> LaserScan:
    """720 beams of a whole turn, the first one backwards."""
    angles = [-math.pi + i * math.tau / 720 for i in range(720)]
    ranges = [wall if abs(a) < 0.5 else left if 0.5 <= a < 1.5 else right if -1.5 < a <= -0.5 else 5.0 for a in angles]
    return LaserScan(start_angle=angles[0], end_angle=angles[-1], ranges=ranges)


def test_the_program_drives_where_the_way_is_free_and_turns_to_the_freer_side():
    command = program()["command"]
    assert command(scan_of(3.0, 1.0, 1.0)).linear > 0
    assert command(scan_of(0.5, 2.0, 1.0)).angular > 0
    assert command(scan_of(0.5, 1.0, 2.0)).angular < 0


@pytest.mark.parametrize(
    ("arguments", "line"), [([], "say for how many seconds"), (["20"], "no router at tcp/127.0.0.1:9: start 'uvf up' first")]
)
def test_the_program_ends_with_one_line_without_its_argument_or_a_system(monkeypatch, arguments, line):
    monkeypatch.setattr(sys, "argv", ["wander.py", *arguments])
    monkeypatch.setenv("UVF_ROUTER", "tcp/127.0.0.1:9")
    with pytest.raises(SystemExit, match=line):
        program("__main__")
