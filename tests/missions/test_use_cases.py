"""The use cases of the documentation to their ends: every criterion holds."""

import pytest
import yaml

from launch.changed_mission import changed_mission
from launch.commands.log_tools import replay_into
from launch.run import run_lockstep
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.log.reading import log_attachments
from uvf.runtime.log.replay import logged_site

pytestmark = pytest.mark.timeout(600)


@pytest.mark.parametrize("name", ["ugv1_waypoints", "uav1_surfaces"])
def test_a_vehicle_s_own_program_does_the_mission(name, tmp_path):
    site = load_scenario(ROOT / "missions" / f"{name}.yaml")
    result = run_lockstep(site, site.mission.duration, tmp_path / "log.mcap")
    assert result.passed, [(v.subject, v.criterion.measure, v.found) for v in result.verdicts if not v.passed]
    (program,) = (name for name in log_attachments(tmp_path / "log.mcap") if name.startswith("programs/"))
    with logged_site(tmp_path / "log.mcap") as again:
        (member,) = again.members.values()
        assert (again.mission_path.parent / member.entry.program).resolve() == (again.mission_path.parents[1] / program).resolve()
        with pytest.raises(BadInput, match="a program is run with --mission only"):
            replay_into(tmp_path / "log.mcap", site.members[member.name].entry.program.split("/")[1][:-3], None, None)


@pytest.mark.parametrize("name", ["ugv2_slam", "ugv3_team_slam"])
def test_every_criterion_holds(name, tmp_path, monkeypatch):
    monkeypatch.setenv("UVF_STATE", str(tmp_path / "state"))
    site = load_scenario(ROOT / "missions" / f"{name}.yaml")
    result = run_lockstep(site, site.mission.duration, tmp_path / "log.mcap")
    assert result.passed, [(v.subject, v.criterion.measure, v.found) for v in result.verdicts if not v.passed]
    assert result.simulated < site.mission.duration
    assert "tracks/" in " ".join(log_attachments(tmp_path / "log.mcap"))
    with logged_site(tmp_path / "log.mcap") as again:
        assert len(again.mission.tasks) == len(site.mission.tasks)
    maps = sorted(path.name for path in (tmp_path / "state" / "maps").glob("*.pgm"))
    assert maps == {"ugv2_slam": ["ugv2_slam.pgm"], "ugv3_team_slam": ["ugv3_large.pgm", "ugv3_small.pgm", "ugv3_team.pgm"]}[name]


@pytest.mark.parametrize("name", ["uav2_dubins", "leader_follower", "convoy", "ugv3_explore"])
def test_vehicles_and_teams_do_their_missions(name, tmp_path, monkeypatch):
    monkeypatch.setenv("UVF_STATE", str(tmp_path / "state"))
    site = load_scenario(ROOT / "missions" / f"{name}.yaml")
    result = run_lockstep(site, site.mission.duration, tmp_path / "log.mcap")
    assert result.passed, [(v.subject, v.criterion.measure, v.found) for v in result.verdicts if not v.passed]


def test_a_rover_drives_by_the_map_of_an_aircraft(tmp_path):
    """The mission without the rover that has no map and explores for minutes."""
    mission = yaml.safe_load((ROOT / "missions" / "air_ground.yaml").read_text())
    del mission["vehicles"]["alone"]
    survey, drive = mission["tasks"]
    mission["tasks"] = [survey, drive["parallel"][0]]
    mission["criteria"] = [criterion for criterion in mission["criteria"] if criterion.get("vehicle") != "alone"]
    (tmp_path / "air_ground.yaml").write_text(yaml.safe_dump(mission))
    site = load_scenario(tmp_path / "air_ground.yaml")
    result = run_lockstep(site, site.mission.duration, tmp_path / "log.mcap")
    assert result.passed, [(v.subject, v.criterion.measure, v.found) for v in result.verdicts if not v.passed]
    assert result.simulated < 260.0


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
