"""The house rules that a machine can check."""

import ast
import re
import subprocess
from pathlib import Path
from statistics import median

import pytest

from uvf.models.scenario import ROOT

GENERATED = re.compile(r"_pb2\.py$|mavlink/dialect\.py$")
TABLES = {"schemas/topics.py"}
ENGINES = {
    "zenoh": ["src/uvf/runtime/bus/zenoh_bus.py"],
    "mcap": [f"src/uvf/runtime/log/{name}.py" for name in ("reading", "recording", "recovery")],
    "pybullet": ["services/sim_camera/renderer.py", "services/sim_ground/engine.py"],
    "jsbsim": ["services/sim_air/engine/airframe.py"],
    "pymavlink": ["src/uvf/mavlink/generate.py", "src/uvf/models/world/earth_field.py"],  # its messages, and its map of the magnetic field
    "sdl2": ["launch/teleop/gamepad.py"],
}


def sources():
    files = [p for folder in ("src", "schemas", "services", "launch") for p in sorted((ROOT / folder).rglob("*.py"))]
    return [p for p in files if not GENERATED.search(str(p))]


def name(path):
    return str(path.relative_to(ROOT))


def functions(path):
    tree = ast.parse(path.read_text())
    return [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)]


def imported(path):
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module or ""


def test_no_file_is_longer_than_400_lines_and_most_are_short():
    lines = {name(p): len(p.read_text().splitlines()) for p in sources()}
    assert {n: c for n, c in lines.items() if c > 400 and n not in TABLES} == {}
    assert median(c for c in lines.values() if c) <= 140


def test_nine_functions_of_ten_fit_on_a_screen_and_none_is_longer_than_two():
    lengths = [(f.end_lineno - f.lineno + 1, f"{name(p)}:{f.name}") for p in sources() for f in functions(p)]
    assert [where for length, where in lengths if length > 60] == []
    assert sum(length <= 30 for length, _ in lengths) >= 0.9 * len(lengths)


def test_every_module_says_what_it_is():
    mute = [name(p) for p in sources() if p.read_text().strip() and ast.get_docstring(ast.parse(p.read_text())) is None]
    assert mute == []


@pytest.mark.parametrize("engine", ENGINES)
def test_one_file_imports_each_engine(engine):
    found = [name(p) for p in sources() if any(m == engine or m.startswith(f"{engine}.") for m in imported(p))]
    assert found == ENGINES[engine]


def test_viser_is_imported_by_its_own_files():
    for p in sources():
        for module in imported(p):
            if module.split(".")[0] == "viser":
                assert p.parent.name == "page" and p.name.startswith(("viser_", "guard")), name(p)


def test_nothing_that_drives_or_flies_reads_the_truth():
    readers = []
    library = ("estimation", "control", "guidance", "planning", "slam")
    for folder in ("services/slam", "services/planner", "services/autopilot", *(f"src/uvf/{part}" for part in library)):
        readers += [name(p) for p in (ROOT / folder).rglob("*.py") if re.search(r"topics\.TRUTH|truth/", p.read_text())]
    assert readers == []


def test_no_drawer_without_a_subject():
    assert [name(p) for p in sources() if p.stem in ("utils", "util", "helpers", "misc", "common")] == []


def test_what_is_in_the_tree_is_meant_to_be_there():
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False).stdout.split()
    heavy = [f for f in listed if Path(ROOT, f).is_file() and Path(ROOT, f).stat().st_size > 3_000_000]
    assert heavy == []
    assert "src/uvf/mavlink/dialect.py" not in listed  # generated at install, from schemas/mavlink
