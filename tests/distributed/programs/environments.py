"""Environments of the programs that are run against the system: made from their lock files when they are first needed.

``python -m tests.distributed.programs.environments`` makes them all. After a change of a ``.in`` its lock file is made anew with
``uv pip compile --universal --python-version 3.11 --generate-hashes [--no-deps] NAME.in -o NAME.txt``; MAVProxy's with ``--no-deps``:
without a window it needs none of the gigabyte that it asks for (OpenCV, VTK, matplotlib).
"""

import fcntl
import subprocess
import sys
import venv
import zlib
from pathlib import Path

from uvf.models.scenario import ROOT

LOCKS = Path(__file__).parent
FOLDER = ROOT / ".programs"
NAMES = ("mavsdk3", "mavproxy")
PATIENCE = 300.0  # s


class LeftOut(Exception):
    """The environment is not here and cannot be made; says why."""


def python_of(name):
    """The interpreter of an environment. Raises LeftOut."""
    folder, lock = FOLDER / name, LOCKS / f"{name}.txt"
    mark, wanted = folder / ".lock", str(zlib.crc32(lock.read_bytes()))
    FOLDER.mkdir(exist_ok=True)
    with (FOLDER / f"{name}.making").open("w") as making:
        fcntl.flock(making, fcntl.LOCK_EX)
        if not (mark.is_file() and mark.read_text() == wanted):
            _make(name, folder, lock)
            mark.write_text(wanted)
    return folder / "bin" / "python"


def _make(name, folder, lock):
    venv.create(folder, clear=True, with_pip=True, symlinks=True)
    install = [str(folder / "bin" / "python"), "-m", "pip", "install", "-q", "--disable-pip-version-check", "--retries", "1"]
    exactly = ["--no-deps", "--require-hashes", "-r", str(lock)]
    try:
        done = subprocess.run([*install, *exactly], capture_output=True, text=True, timeout=PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        raise LeftOut(f"{name} left out: its packages did not come within {PATIENCE:.0f} s") from None
    if done.returncode != 0:
        raise LeftOut(f"{name} left out: its packages could not be installed: {done.stderr.strip().splitlines()[-1]}")


if __name__ == "__main__":
    try:
        for each in NAMES:
            python_of(each)
    except LeftOut as why:
        sys.exit(f"uvf: {why}")
