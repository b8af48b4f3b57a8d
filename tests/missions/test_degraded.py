"""Missions in which something breaks: nothing is touched, and nobody believes to be somewhere else."""

import pytest

from launch.changed_mission import changed_mission
from launch.run import run_lockstep
from uvf.models.scenario import ROOT, load_scenario

pytestmark = pytest.mark.timeout(600)


def test_a_rover_whose_lidar_dies_under_way_stands_and_touches_nothing(tmp_path):
    path = changed_mission(ROOT / "missions" / "convoy.yaml", ["faults=[{vehicle: first, part: scan, kind: lost, at: 20}]"], tmp_path)
    site = load_scenario(path)
    result = run_lockstep(site, 40.0, tmp_path / "log.mcap")
    contacts = [v for v in result.verdicts if v.criterion.measure == "contacts"]
    assert contacts and all(v.passed for v in contacts)
    assert any("lidar silent or frozen" in line for line in result.told.of("first", 20.0))
    assert not result.passed


def test_a_rover_that_is_spun_about_by_one_wheel_on_ice_does_not_believe_itself_far_away(tmp_path, monkeypatch):
    """It turns with 6 rad/s, of which the accelerometer feels much that is no tilt: it was 200 m off once."""
    monkeypatch.setenv("UVF_STATE", str(tmp_path / "state"))
    path = changed_mission(
        ROOT / "missions" / "ugv2_slam.yaml", ["faults=[{vehicle: rover, part: left_grip, kind: lost, at: 30}]"], tmp_path
    )
    result = run_lockstep(load_scenario(path), 78.0, tmp_path / "log.mcap")
    (error,) = (v.found.value for v in result.verdicts if v.criterion.measure == "pose_error")
    assert error < 4.0
