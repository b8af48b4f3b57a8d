"""Another mission takes the place of the running one when somebody asks for it; one that is not there changes nothing."""

import time

import pytest

import uvf
from schemas import topics
from schemas.messages import LaunchRequest
from tests.distributed.system import System

pytestmark = pytest.mark.timeout(240)


def again(system, seconds=120.0):
    """A client of the run that has taken the place of the one before, once time runs in it."""
    end = time.monotonic() + seconds
    while system.said().count("time runs") < 2:
        assert system.popen.poll() is None and time.monotonic() < end, system.said()
        time.sleep(0.2)
    return uvf.connect(system.endpoint)


def test_a_mission_is_exchanged_for_another_one_and_a_wrong_name_is_refused(tmp_path):
    with System(tmp_path, mission="formation") as system:
        refused = system.client.ask("sys", topics.LAUNCH, LaunchRequest(mission="formatoin", source="test"), 20.0)
        assert not refused.accepted and "formation" in refused.reason
        assert system.client.ask("sys", topics.LAUNCH, LaunchRequest(mission="dubins", source="test"), 20.0).accepted
        system.client._bus.close()
        system.client = again(system)
        assert "sim_air" in system.children() and "sim_ground" not in system.children()
    runs = [path for path in tmp_path.iterdir() if path.is_dir() and not path.is_symlink() and path.name != "state"]
    assert len(runs) == 2, "each mission has a folder of its own"
