"""The command line answers bad input with one clear line and a non-zero exit."""

import contextlib
import io
import os
import socket
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import NamedTuple
from unittest import mock

import pytest
import typer
import yaml

from launch import settings
from launch.cli import app, main
from launch.scoring.scores import MEASURES
from tests.runtime.modes import free_port
from uvf.models.scenario import ROOT, load_scenario


class Said(NamedTuple):
    returncode: int
    stdout: str
    stderr: str


def uvf(*arguments, **environment):
    """The command line's own entry in this process: starting one for each line would be most of the time."""
    out, err = io.StringIO(), io.StringIO()
    asked = mock.patch.object(sys, "argv", ["uvf", *arguments])
    with mock.patch.dict(os.environ, environment), asked, contextlib.chdir(ROOT), redirect_stdout(out), redirect_stderr(err):
        try:
            main()
        except SystemExit as end:
            return Said(end.code or 0, out.getvalue(), err.getvalue())
    raise AssertionError("it has to end with an exit code")


def mission(tmp_path, **changes):
    data = yaml.safe_load((ROOT / "missions" / "demo.yaml").read_text()) | changes
    path = tmp_path / "changed.yaml"
    path.write_text(yaml.safe_dump(data))
    return str(path)


def vehicle(**changes):
    return {"burger": {"model": "burger", "system_id": 2, "start": {"x": 2.0, "y": 1.0}} | changes}


BAD = {
    "unknown mission": ({}, "dmo", "no mission 'dmo'; did you mean 'demo'?"),
    "unknown key": ({"vehicels": {}}, None, "unknown key 'vehicels'; did you mean 'vehicles'?"),
    "unknown world": ({"world": "hose"}, None, "no world 'hose'"),
    "unknown model": ({"vehicles": vehicle(model="burgr"), "criteria": []}, None, "vehicles: burger: model: no vehicle 'burgr'"),
    "unknown vehicle of a criterion": ({"criteria": [{"vehicle": "burgr", "measure": "contacts"}]}, None, "did you mean 'burger'?"),
    "wrong type": ({"seed": "x"}, None, "seed"),
    "reserved name": ({"vehicles": {"sys": vehicle()["burger"]}, "criteria": []}, None, "vehicles"),
    "two of one system id": ({"vehicles": vehicle() | {"other": vehicle()["burger"]}, "criteria": []}, None, "both have system_id 2"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_mission_is_one_line_that_names_the_mend(tmp_path, case):
    changes, name, expected = BAD[case]
    done = uvf("check", name or mission(tmp_path, **changes))
    assert done.returncode == 2
    assert expected in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


def test_a_process_of_its_own_says_the_same(tmp_path):
    path = mission(tmp_path, world="hose")
    done = subprocess.run([sys.executable, "-m", "launch.cli", "check", path], cwd=ROOT, capture_output=True, text=True, check=False)
    assert tuple(uvf("check", path)) == (done.returncode, done.stdout, done.stderr)


def test_an_unknown_measure_is_named_before_the_run(tmp_path):
    path = mission(tmp_path, criteria=[{"vehicle": "burger", "measure": "distance_drivn", "at_least": 1.0}])
    done = uvf("run", path, "--until", "1", UVF_RUNS=str(tmp_path))
    assert done.returncode == 2
    assert f"{path}:4: criteria[0]: measure: no measure 'distance_drivn'; did you mean 'distance_driven'?" in done.stderr


def test_a_measure_that_is_like_none_is_answered_with_all_there_are(tmp_path):
    done = uvf("check", mission(tmp_path, criteria=[{"vehicle": "burger", "measure": "xyz", "at_least": 1.0}]))
    assert "no measure 'xyz'; there are: " in done.stderr and all(name in done.stderr for name in MEASURES)


def test_a_measure_of_the_other_kind_of_vehicle_is_refused(tmp_path):
    done = uvf("check", mission(tmp_path, criteria=[{"vehicle": "burger", "measure": "touchdown_sink", "at_most": 1.0}]))
    assert "measure: burger drives; touchdown_sink is a measure of aircraft" in done.stderr


def test_broken_yaml_names_file_and_line(tmp_path):
    path = tmp_path / "broken.yaml"
    path.write_text("about: x\nworld: [house\nseed: 1\n")
    done = uvf("check", str(path))
    assert done.returncode == 2
    assert f"{path}:3: not valid YAML" in done.stderr


@pytest.mark.parametrize(
    ("variable", "value", "what"), [("UVF_ROUTER", "tcp/127.0.0.1:{}", "the router"), ("UVF_GCS_PORT", "{}", "the page")]
)
def test_up_says_which_port_is_taken_and_how_to_choose_another(tmp_path, variable, value, what):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        done = uvf("up", "--for", "1", UVF_RUNS=str(tmp_path), **{variable: value.format(port)})
    assert done.returncode == 2
    assert f"port {port} for {what} is taken" in done.stderr and variable in done.stderr


def test_without_a_router_the_tools_say_so():
    done = uvf("node", "list", UVF_ROUTER="tcp/127.0.0.1:9")
    assert done.returncode == 2
    assert "no router at tcp/127.0.0.1:9" in done.stderr


def without_engines(*arguments):
    """What a command says; none of the engines may have been imported for it."""
    code = f"import sys, launch.cli as c\ntry: c.app({list(arguments)!r})\nexcept SystemExit as end: print('exit', end.code)\n"
    code += "print([m for m in ('zenoh', 'numpy', 'numba', 'pybullet', 'jsbsim', 'viser', 'trimesh') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip().endswith("[]")
    return done


def test_help_imports_no_engine():
    assert "exit 0" in without_engines("--help").stdout


MISSPELT = {
    ("run", "dmeo"): "no mission 'dmeo'; did you mean 'demo'?",
    ("up", "dmeo"): "no mission 'dmeo'; did you mean 'demo'?",
    ("check", "dmeo"): "no mission 'dmeo'; did you mean 'demo'?",
    ("teleop", "burger", "-m", "dmeo"): "no mission 'dmeo'; did you mean 'demo'?",
    ("service", "planner", "-m", "dmeo"): "no mission 'dmeo'; did you mean 'demo'?",
    ("replay", "tests/golden/dmo.mcap"): "no log tests/golden/dmo.mcap; did you mean 'demo.mcap'?",
    ("replay", "tests/golden/demo.mcap", "-m", "dmeo"): "no mission 'dmeo'; did you mean 'demo'?",
    ("log", "info", "tests/golden/dmo.mcap"): "no log tests/golden/dmo.mcap; did you mean 'demo.mcap'?",
    ("report", "tests/goldn"): "no run tests/goldn; did you mean 'golden'?",
    ("report", "nothing"): "no run nothing; runs are recorded in {runs}",
    ("bench", "buss"): "no benchmark group 'buss'; did you mean 'bus'?",
}


@pytest.mark.parametrize("arguments", MISSPELT, ids=" ".join)
def test_a_misspelt_name_is_answered_in_one_line_before_anything_is_loaded(arguments):
    done = without_engines(*arguments)
    assert done.stderr == f"uvf: {MISSPELT[arguments].format(runs=settings.runs_folder())}\n"
    assert "exit 2" in done.stdout


LONG = "a" * 5000
NO_NAMES = [
    ("check",),
    ("log", "info"),
    ("slam",),
    ("map", "load"),
    ("vehicle", "check"),
    ("world", "show"),
]


@pytest.mark.parametrize("command", NO_NAMES, ids=" ".join)
def test_a_name_too_long_for_a_file_is_refused_in_one_line_that_is_not_as_long(command):
    done = uvf(*command, LONG)
    assert done.returncode == 2
    assert done.stderr.endswith("aaa...: the name is too long for a file; name another\n")
    assert len(done.stderr) < 200


def test_a_line_is_not_as_long_as_the_name_that_it_speaks_of():
    done = uvf("run", "demo", "--log", "a" * 5000)
    assert done.returncode == 2 and len(done.stderr) < 300
    assert "aaa...: the name is too long for a file" in done.stderr


@pytest.mark.parametrize("command", [("check",), ("log", "info"), ("report",)], ids=" ".join)
def test_a_link_that_leads_round_in_a_circle_is_said_to_be_one(command, tmp_path):
    loop = tmp_path / "loop"
    loop.symlink_to(loop)
    done = uvf(*command, str(loop))
    assert done.returncode == 2
    assert "the link leads round in a circle" in done.stderr


def test_what_a_file_holds_can_neither_break_the_line_nor_steer_the_terminal(tmp_path):
    done = uvf("check", mission(tmp_path, **{"\x1b[31mred\n": 1}))
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert "unknown key '\\x1b[31mred '" in done.stderr


NOWHERE = "tcp/127.0.0.1:9"
USAGE = {
    ("chek", "demo"): "no such command 'chek'; did you mean 'check'?; try 'uvf --help'",
    ("topic", "ehco", "x"): "no such command 'ehco'; did you mean 'echo'?; try 'uvf topic --help'",
    ("map", "load"): "missing argument 'name'; try 'uvf map load --help'",
    ("up", "--ratee", "1"): "no such option: --ratee; did you mean --rate?; try 'uvf up --help'",
    ("run", "demo", "--untl", "3"): "no such option: --untl; did you mean --until?; try 'uvf run --help'",
    ("up", "--rate", "abc"): "invalid value for '--rate': 'abc' is no number; try",
    ("world", "check", "house", "--radius", "20"): "invalid value for '--radius': 20 m is above 10 m; try 'uvf world check --help'",
    ("world", "check", "house", "--radius", "0"): "invalid value for '--radius': 0 m is below 0.01 m; try",
    ("world", "new", "house", "x", "--rooms", "100"): "invalid value for '--rooms': 100 is above 40; try 'uvf world new house --help'",
    ("world", "new", "house", "x", "--rooms", "few"): "invalid value for '--rooms': 'few' is no whole number; try",
    ("up", "--rate", "nan"): "invalid value for '--rate': nan: give a number from 0 to 1000; try 'uvf up --help'",
    ("up", "--for", "-5"): "invalid value for '--for': -5: give a number at least 0.01; try 'uvf up --help'",
    ("up", "--for", "nan"): "invalid value for '--for': nan: give a number at least 0.01",
    ("service", "conductor", "--rate", "nan"): "invalid value for '--rate': nan",
    ("topic", "hz", "burger/nav/pose", "--for", "-1"): "invalid value for '--for': -1",
    ("topic", "echo", "burger/nav/pose", "-n", "-4"): "invalid value for '-n': ",
}


@pytest.mark.parametrize("arguments", USAGE, ids=" ".join)
def test_what_cannot_be_meant_is_one_line_that_names_the_help(arguments):
    done = uvf(*arguments, UVF_ROUTER=NOWHERE)
    assert done.returncode == 2
    assert done.stderr.startswith(f"uvf: {USAGE[arguments]}") and done.stderr.endswith(" --help'\n")
    assert len(done.stderr.splitlines()) == 1


def test_a_group_without_a_command_tells_what_there_is():
    done = uvf("sim")
    assert done.returncode == 2
    assert "restore" in done.stdout + done.stderr and "uvf: " not in done.stderr


def test_the_fault_itself_is_named_before_a_router_is_looked_for(tmp_path):
    (tmp_path / "empty.mcap").touch()
    for arguments, why in {
        ("replay", str(tmp_path / "empty.mcap")): "is empty: nothing was recorded in it",
        ("map", "save", "x", "--mode", "trinry"): "mode: no 'trinry' here; did you mean 'trinary'?",
        ("router", "--listen", "rubbish"): "--listen rubbish: not an endpoint; write it as tcp/127.0.0.1:7447",
    }.items():
        done = uvf(*arguments, UVF_ROUTER=NOWHERE)
        assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)
        assert why in done.stderr


def test_up_says_where_mavlink_goes(tmp_path, monkeypatch):
    monkeypatch.setattr("launch.up.up", lambda *_: 0)
    ports = {"UVF_RUNS": str(tmp_path), "UVF_GCS_PORT": str(free_port()), "UVF_ROUTER": f"tcp/127.0.0.1:{free_port()}"}
    said = uvf("up", UVF_MAVLINK_TARGETS="", UVF_MAVLINK_LISTEN="", **ports).stdout
    assert "MAVLink: off" in said and "14550" not in said
    assert "MAVLink: to UDP 10.0.0.2:14550," in uvf("up", "--no-gcs", UVF_MAVLINK_TARGETS="10.0.0.2:14550", **ports).stdout


def test_up_starts_a_mission_with_other_values_that_it_keeps_beside_the_log(tmp_path, monkeypatch):
    started = []
    monkeypatch.setattr("launch.up.up", lambda wanted, *_: started.append(wanted.mission) or 0)
    ports = {"UVF_RUNS": str(tmp_path), "UVF_GCS_PORT": str(free_port()), "UVF_ROUTER": f"tcp/127.0.0.1:{free_port()}"}
    uvf("up", "airship", "--set", "vehicles.airship.model=stick25", **ports)
    assert load_scenario(started[0]).members["airship"].entry.model == "stick25"
    assert Path(started[0]).parent.parent == tmp_path
    assert "write it as" in uvf("up", "airship", "--set", "vehicles", **ports).stderr


def test_the_help_says_what_each_measure_is_and_no_type_of_a_flag():
    said = " ".join(uvf("vehicle", "new", "--help", COLUMNS="160").stdout.split())
    assert "From the floor to the top of the body." in said and "From the middle of one wheel" in said
    assert "<bool>" not in said
    asked = (("up",), ("bench",), ("world", "new", "house"), ())
    assert all("<bool>" not in uvf(*words, "--help", COLUMNS="160").stdout for words in asked)


def test_the_help_of_shift_says_degrees_and_keeps_what_stands_in_it():
    assert "x and y in m, yaw in degrees" in " ".join(uvf("map", "compare", "--help", COLUMNS="240").stdout.split())


def test_the_help_of_bench_lists_the_groups():
    said = uvf("bench", "--help", COLUMNS="160").stdout
    assert all(name in said for name in settings.benchmark_names()) and "slow_lidar" in said


def test_no_help_has_brackets_which_rich_would_take_for_markup_and_leave_out():
    def helps(command, path):
        yield path, command.help or ""
        yield from ((f"{path} {p.name}", p.help or "") for p in command.params)
        for name, each in getattr(command, "commands", {}).items():
            yield from helps(each, f"{path} {name}")

    assert [where for where, text in helps(typer.main.get_command(app), "uvf") if "[" in text] == []
