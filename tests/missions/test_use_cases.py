"""The use cases of the documentation to their ends: every criterion holds."""

import pytest

from launch.run import run_lockstep
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.log.reading import log_attachments
from uvf.runtime.log.replay import logged_site

pytestmark = pytest.mark.timeout(600)


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
