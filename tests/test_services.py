"""Every service keeps the contract, and the catalogue says what is so."""

import inspect
from pathlib import Path
from typing import get_type_hints

import pytest

from launch import catalogue
from launch.checks import check_mission
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.contract.declaration import Called, Frames, Served, StopInput, declared_in
from uvf.runtime.contract.service import Answer
from uvf.runtime.messages.frames import FrameBuffer
from uvf.runtime.state.stop_all import StopStatus

SITE = load_scenario(ROOT / "missions" / "demo.yaml")
ASKING = load_scenario(ROOT / "missions" / "mapping.yaml")
FROM_ABOVE = load_scenario(ROOT / "missions" / "air_ground.yaml")
SEARCH = load_scenario(ROOT / "missions" / "search.yaml")
TEAM = load_scenario(ROOT / "missions" / "team.yaml")
TASKS = load_scenario(ROOT / "missions" / "ugv2_slam.yaml")
PROGRAM = load_scenario(ROOT / "missions" / "ugv1_waypoints.yaml")
SITES = {"asked": ASKING, "team": TEAM, "tasks": TASKS, "program": PROGRAM, "elevation": FROM_ABOVE, "detector": SEARCH}
HOSTS = {kind.name: catalogue.hosts(SITES.get(kind.name, SITES.get(kind.needs, SITE)), [kind]) for kind in catalogue.KINDS}
SERVICES = sorted({host.service for hosts in HOSTS.values() for host in hosts}, key=lambda s: s.name)


def declared_type(how):
    """What a step is handed of it, as its type is written."""
    if isinstance(how, Frames):
        return FrameBuffer
    if isinstance(how, StopInput):
        return StopStatus
    if isinstance(how, Called):
        return list[Answer[how.request.message, how.request.reply]]
    if isinstance(how, Served):
        return list[how.request.message]
    one = list[how.topic.message] if how.every else how.topic.message
    if how.each_vehicle:
        return dict[str, one]
    return one if how.required or how.every else one | None


@pytest.mark.parametrize("service", SERVICES, ids=lambda s: s.name)
def test_types_are_those_of_the_topics(service):
    written = get_type_hints(service.Inputs)
    for name, how in declared_in(service.Inputs).items():
        assert written[name] in (declared_type(how), declared_type(how) | None), name


@pytest.mark.parametrize("service", SERVICES, ids=lambda s: s.name)
def test_a_step_takes_the_time_and_what_is_declared(service):
    hints = get_type_hints(service.step, vars(inspect.getmodule(service)), dict(vars(service)))
    assert list(inspect.signature(service.step).parameters) == ["self", "t", "now"]
    assert issubclass(service.Inputs, hints["now"]) and issubclass(service.Outputs, hints["return"])
    assert service.__doc__


@pytest.mark.parametrize("service", SERVICES, ids=lambda s: s.name)
def test_what_is_recalled_is_kept_and_wanted(service):
    assert all(topic.kept for topic in service.recalls.values())
    assert hasattr(service, "recall") == bool(service.recalls)


@pytest.mark.parametrize("host", [h for hosts in HOSTS.values() for h in hosts], ids=lambda h: f"{h.service.name}-{h.vehicle}")
def test_it_is_known_about_which_vehicles_a_service_writes(host):
    per_vehicle = any(topic.per_vehicle for topic in host.service.outputs.values())
    assert bool(host.vehicle or host.writes_for) or not per_vehicle
    assert set(host.writes_for) <= set(SITE.members) | {name for site in SITES.values() for name in site.members}


@pytest.mark.parametrize("kind", catalogue.KINDS, ids=lambda k: k.name)
def test_the_catalogue_agrees_with_the_classes(kind):
    assert {host.service.clock for host in HOSTS[kind.name]} == {kind.clock}
    assert any(host.service.simulator for host in HOSTS[kind.name]) == kind.simulator


def test_the_wiring_of_every_mission_is_right():
    for mission in sorted(Path(ROOT, "missions").glob("*.yaml")):
        assert check_mission(str(mission)) == []
