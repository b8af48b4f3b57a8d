"""The use cases of the documentation to their ends: every criterion holds."""

import pytest

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
