"""The library's examples do what they say, without a bus and in few lines."""

import os
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

from uvf.models.scenario import ROOT

LIBRARY = ROOT / "examples" / "library"
SAID = {
    "01_slam": r"200 scans, (6|7|8)\d keyframes, .* ends at Pose2\(x=3\.8\d*, y=4\.1\d*",
    "02_ekf": r"position off by 0\.\d m in the median",
    "03_dubins": r"LSL, 583 m, segments of 6, 301, 277 m",
    "04_trim": r"(?s)short period.*phugoid.*Dutch roll",
    "05_astar": r"\d\d\d cells, cost .* to \[3\.\d+ +5\.\d+\] m",
    "06_sensors": r"10 s: 3\.\de-05 rad/s, white noise alone 3\.2e-05 rad/s",
    "07_control": r"aileron 0\.2\d\d rad, elevator -0\.0\d\d rad, throttle 0\.\d\d",
    "08_frames": r"\(3\.0, 3\.1\) m: 47\.0000279, 8\.0000394 deg",
    "09_mavlink": r"(?s)21 bytes .*HEARTBEAT of system 1, type 10",
    "11_vision": r"a post at \((5\.9|6\.0|6\.1), (1\.9|2\.0|2\.1)\) m, seen from 3 places",
    "10_models": r"(?s)burger: radius .*demo: burger, milvus.*no vehicle 'burgr' .*did you mean 'burger'\?",
}
PARTS = ("control", "estimation", "guidance", "models", "planning", "sensors", "slam", "vision")


def ran(arguments, folder):
    environment = {**os.environ, "PYTHONPATH": f"{ROOT}:{ROOT / 'src'}", "MPLBACKEND": "agg"}
    return subprocess.run([sys.executable, *arguments], cwd=folder, env=environment, capture_output=True, text=True, check=False)


def test_every_example_is_run():
    assert {path.stem for path in LIBRARY.glob("*.py")} == set(SAID)


@pytest.mark.parametrize("name", SAID)
def test_it_says_what_comes_out(name, tmp_path):
    done = ran([str(LIBRARY / f"{name}.py")], tmp_path)
    assert done.returncode == 0, done.stderr
    assert re.search(SAID[name], done.stdout), done.stdout


@pytest.mark.parametrize("name", SAID)
def test_it_is_short_and_knows_no_message(name):
    text = Path(LIBRARY / f"{name}.py").read_text()
    assert len([line for line in text.splitlines() if line.strip() and not line.startswith(('"""', "import", "from", "#"))]) <= 15
    assert "schemas" not in text and "runtime" not in text


@pytest.mark.parametrize("part", PARTS)
def test_all_that_a_part_offers_is_there(part):
    package = import_module(f"uvf.{part}")
    for name in package.__all__:
        assert getattr(package, name).__module__.startswith("uvf."), name
    with pytest.raises(AttributeError, match=f"no 'nothing' in uvf.{part}; "):
        _ = package.nothing


@pytest.mark.parametrize(
    ("line", "unwanted"),
    [
        ("import uvf.slam, uvf.guidance", ("zenoh", "google.protobuf", "uvf.runtime", "numba")),
        ("from uvf.slam import GraphSlam", ("zenoh", "google.protobuf", "uvf.runtime")),
    ],
)
def test_a_part_is_imported_without_message_bus_or_what_it_does_not_use(line, unwanted, tmp_path):
    code = f"import sys\n{line}\nprint(*(name for name in {unwanted} if name in sys.modules))"
    assert ran(["-c", code], tmp_path).stdout.strip() == ""
