"""Every service keeps the contract, and the catalogue says what is so."""

import inspect
from pathlib import Path

import pytest

from launch import catalogue
from launch.checks import check_mission
from uvf.models.scenario import ROOT, load_site

SITE = load_site(ROOT / "missions" / "demo.yaml")
ASKING = load_site(ROOT / "missions" / "mapping.yaml")
TEAM = load_site(ROOT / "missions" / "team.yaml")
SITES = {"asked": ASKING, "team": TEAM}
HOSTS = {kind.name: catalogue.hosts(SITES.get(kind.needs, SITE), [kind]) for kind in catalogue.KINDS}
SERVICES = sorted({host.service for hosts in HOSTS.values() for host in hosts}, key=lambda s: s.name)


@pytest.mark.parametrize("service", SERVICES, ids=lambda s: s.name)
def test_step_takes_what_is_declared(service):
    declared = {*service.inputs, *service.requests, *service.calls}
    assert set(inspect.signature(service.step).parameters) == {"self", "t", *declared}


@pytest.mark.parametrize("service", SERVICES, ids=lambda s: s.name)
def test_names_mean_one_thing(service):
    assert not set(service.requests) & (set(service.inputs) | set(service.calls))
    assert not set(service.outputs) & (set(service.requests) | set(service.calls))
    assert service.__doc__


@pytest.mark.parametrize("service", SERVICES, ids=lambda s: s.name)
def test_what_is_recalled_is_kept_and_wanted(service):
    assert all(topic.kept for topic in service.recalls.values())
    parameters = inspect.signature(service.recall).parameters if hasattr(service, "recall") else ("self",)
    assert set(parameters) == {"self", *service.recalls} if service.recalls else set(parameters) == {"self"}


@pytest.mark.parametrize("host", [h for hosts in HOSTS.values() for h in hosts], ids=lambda h: f"{h.service.name}-{h.vehicle}")
def test_it_is_known_about_which_vehicles_a_service_writes(host):
    per_vehicle = any(topic.per_vehicle for topic in host.service.outputs.values())
    assert bool(host.vehicle or host.writes_for) or not per_vehicle
    assert set(host.writes_for) <= set(SITE.members) | set(TEAM.members)


@pytest.mark.parametrize("kind", catalogue.KINDS, ids=lambda k: k.name)
def test_the_catalogue_agrees_with_the_classes(kind):
    assert {host.service.clock for host in HOSTS[kind.name]} == {kind.clock}
    assert any(host.service.simulator for host in HOSTS[kind.name]) == kind.simulator


def test_the_wiring_of_every_mission_is_right():
    for mission in sorted(Path(ROOT, "missions").glob("*.yaml")):
        assert check_mission(str(mission)) == []
