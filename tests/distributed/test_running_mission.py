"""Tools that are given no mission take that of the running system."""

import pytest

from launch.running_mission import announce, wanted_mission
from tests.runtime.modes import free_port
from uvf.models.scenario import ROOT
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.zenoh_bus import ZenohBus, open_router


@pytest.fixture
def endpoint(monkeypatch):
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    monkeypatch.setenv("UVF_ROUTER", endpoint)
    router = open_router(endpoint)
    yield endpoint
    router.close()


@pytest.mark.parametrize("given", ["dubins", str(ROOT / "missions" / "dubins.yaml")])
def test_the_mission_of_the_running_system_is_found_by_its_name(endpoint, given):
    with ZenohBus(endpoint, timeout=5.0) as bus:
        announce(bus, given)
        assert wanted_mission(None) == "dubins"
        assert wanted_mission("demo") == "demo"


def test_one_from_elsewhere_is_found_by_its_path(endpoint, tmp_path):
    mission = tmp_path / "my mission #1.yaml"
    mission.write_text("about: x\n")
    with ZenohBus(endpoint, timeout=5.0) as bus:
        announce(bus, str(mission))
        assert wanted_mission(None) == str(mission)


def test_without_one_it_says_what_to_give(endpoint):
    with pytest.raises(BadInput, match=f"no missions are announced at {endpoint}: give -m MISSION"):
        wanted_mission(None)
