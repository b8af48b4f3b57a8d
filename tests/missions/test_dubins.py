"""Fourteen places, each in a given direction, in wind: flown in lockstep on noisy sensors."""

import pytest

from launch.run import run_lockstep
from uvf.models.scenario import ROOT, load_scenario


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    log = tmp_path_factory.mktemp("dubins") / "log.mcap"
    return run_lockstep(load_scenario(ROOT / "missions" / "dubins.yaml"), 260.0, log)


def test_every_place_is_passed_in_its_direction(flown):
    assert len(flown.verdicts) == 3
    assert {v.criterion.measure: v.found for v in flown.verdicts if not v.passed} == {}
