"""A mission whose vehicle has faults: the check tells them, a run says in one line that there are some."""

import shutil
from types import SimpleNamespace

import pytest
import yaml

from launch import up
from launch.checks import check_mission
from launch.commands import run
from launch.vehicles import mission_faults
from uvf.models.scenario import ROOT, load_scenario

RADIUS, WHEEL_RADIUS = 0.08, 0.33
LINE = "warning: burger: 3 faults; see 'uvf vehicle check burger'"


@pytest.fixture
def root(tmp_path):
    for folder in ("vehicles/burger", "worlds/house"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    (tmp_path / "missions").mkdir()
    one, other = ({"model": "burger", "system_id": i, "start": {"x": 1.0 + i, "y": 1.0}} for i in (1, 2))
    mission = {"about": "Two of one model.", "world": "house", "duration": 1.0, "vehicles": {"one": one, "other": other}}
    (tmp_path / "missions" / "two.yaml").write_text(yaml.safe_dump(mission))
    return tmp_path


@pytest.fixture
def faulty(root):
    path = root / "vehicles" / "burger" / "vehicle.yaml"
    data = yaml.safe_load(path.read_text())
    data["ground"]["radius"], data["ground"]["drive"]["wheel_radius"] = RADIUS, WHEEL_RADIUS
    path.write_text(yaml.safe_dump(data))
    return root


def site_of(root):
    return load_scenario(root / "missions" / "two.yaml", root)


def test_a_model_without_faults_is_not_spoken_of(root):
    site = site_of(root)
    assert mission_faults.mission_faults(site) == mission_faults.warnings(site) == mission_faults.warnings_from_outside(site) == []


def test_a_model_is_inspected_once_and_spoken_of_in_one_line(faulty):
    site = site_of(faulty)
    assert mission_faults.warnings(site) == mission_faults.warnings_from_outside(site) == [LINE]


def test_the_check_of_a_mission_tells_each_fault_with_its_place(faulty, monkeypatch):
    monkeypatch.setattr("launch.checks.load_scenario", lambda path: load_scenario(path, faulty))
    lines = check_mission(str(faulty / "missions" / "two.yaml"))
    assert len(lines) == 3 and all(f"{faulty}/vehicles/burger/vehicle.yaml:" in line for line in lines)
    assert "ground: drive: wheel_radius: 0.33 m, but the left wheel" in lines[0]


def test_a_run_says_so_before_it_begins(faulty, monkeypatch, capsys):
    monkeypatch.setattr(run, "load_scenario", lambda path: load_scenario(path, faulty))
    monkeypatch.setattr(run, "run_lockstep", lambda *_: SimpleNamespace(passed=True, recording_error=""))
    monkeypatch.setattr(run, "_print_result", lambda *_: None)
    assert run.run_and_report(str(faulty / "missions" / "two.yaml"), 1.0, faulty / "log.mcap", []) == 0
    assert capsys.readouterr().err == f"uvf: {LINE}\n"


def test_the_live_start_says_so_before_it_starts_anything(faulty, monkeypatch):
    said: list = []
    nothing = SimpleNamespace(stop=lambda: None, failed=False)
    stand_in = SimpleNamespace(
        start=lambda kinds, stop: said.append(kinds), watch=lambda stop: None, launcher=nothing, simulated=0.0, next_mission=None
    )
    monkeypatch.setattr(up, "load_scenario", lambda path: load_scenario(path, faulty))
    monkeypatch.setattr(up, "stop_flag", lambda: None)
    monkeypatch.setattr(up, "RunningMission", lambda *_: stand_in)
    assert up.up(up.StartOptions(str(faulty / "missions" / "two.yaml")), faulty, said.append) == 0
    assert said[0] == LINE and isinstance(said[1], list)
