"""Teams, and an aircraft with a rover, to the ends of their missions."""

import pytest
import yaml

from launch.run import run_lockstep
from schemas import topics
from schemas.messages import Battery
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.log.reading import read_log

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


def test_an_aircraft_finds_the_markers_from_above(tmp_path):
    """The mission without the rovers that go there."""
    mission = yaml.safe_load((ROOT / "missions" / "search.yaml").read_text())
    del mission["vehicles"]["anne"], mission["vehicles"]["bert"], mission["roles"]
    mission["tasks"] = [{"name": "survey", "mission": "eye"}]
    mission["criteria"] = [criterion for criterion in mission["criteria"] if criterion.get("vehicle") == "eye"]
    (tmp_path / "search.yaml").write_text(yaml.safe_dump(mission))
    site = load_scenario(tmp_path / "search.yaml")
    result = run_lockstep(site, site.mission.duration, tmp_path / "log.mcap")
    assert result.passed and len(result.verdicts) == 2, [(v.criterion.measure, v.found) for v in result.verdicts]


def test_rovers_deliver_and_the_one_that_is_low_is_charged(tmp_path, monkeypatch):
    """One round of each."""
    monkeypatch.setenv("UVF_STATE", str(tmp_path / "state"))
    mission = yaml.safe_load((ROOT / "missions" / "delivery.yaml").read_text().replace("maps/house", str(ROOT / "missions/maps/house")))
    for part in mission["tasks"][0]["parallel"]:
        part["repeat"] = 1
    (tmp_path / "delivery.yaml").write_text(yaml.safe_dump(mission))
    site = load_scenario(tmp_path / "delivery.yaml")
    result = run_lockstep(site, site.mission.duration, tmp_path / "log.mcap")
    assert result.passed, [(v.subject, v.criterion.measure, v.found) for v in result.verdicts if not v.passed]
    charge = {m.name: [] for m in site.members.values()}
    for sample in read_log(tmp_path / "log.mcap", [topics.BATTERY.at(name) for name in charge]):
        charge[sample.key.split("/")[1]].append(Battery.FromString(sample.payload).remaining)
    assert charge["anne"][0] < 0.3 and max(charge["anne"]) >= 0.39
    assert max(charge["carl"]) < 0.31
