"""Teams, and an aircraft with a rover, to the ends of their missions."""

import pytest
import yaml

from launch.run import run_lockstep
from uvf.models.scenario import ROOT, load_scenario

pytestmark = pytest.mark.timeout(600)


@pytest.mark.parametrize("name", ["uav2_dubins", "leader_follower", "airship", "convoy", "ugv3_explore"])
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
