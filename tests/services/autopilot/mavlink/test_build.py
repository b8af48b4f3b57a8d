"""Addresses from the environment, and vehicles from the mission."""

import pytest

from services.autopilot.mavlink import build as build_module
from services.autopilot.mavlink.build import build
from services.autopilot.mavlink.parameters.parameter_table import parameters_of
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.address import peer


@pytest.mark.parametrize("text", ["", "14550", "host:", ":14550", "host:abc", "host:0", "host:70000"])
def test_what_is_no_address_is_named_with_its_place(text):
    with pytest.raises(BadInput, match=r"UVF_X: .* is not host:port"):
        peer(text, "UVF_X", "127.0.0.1:14550")


def test_addresses():
    assert peer(" 10.0.0.2:14550 ", "X", "") == ("10.0.0.2", 14550)


def test_parameters_get_the_numbers_of_the_vehicles_own_files():
    site = load_scenario(ROOT / "missions" / "demo.yaml")
    for facts in build_module.facts_of(site):
        values = {p.name for p in parameters_of(facts)}
        assert ("NAV_LOITER_RAD" in values) == (facts.file.kind == "fixed_wing")
        assert {p.value for p in parameters_of(facts) if p.name == "MAV_SYS_ID"} == {facts.system_id}


@pytest.fixture
def opened(monkeypatch):
    """What ``build`` would open, without opening it."""
    seen = []
    monkeypatch.setattr(build_module, "open_link", lambda targets, listen: seen.append((targets, listen)))
    return seen


def test_one_process_speaks_for_all_vehicles_of_the_mission(opened, monkeypatch):
    monkeypatch.delenv("UVF_MAVLINK_TARGETS", raising=False)
    monkeypatch.delenv("UVF_MAVLINK_LISTEN", raising=False)
    site = load_scenario(ROOT / "missions" / "demo.yaml")
    (host,) = build(site)
    host.make()
    assert opened == [([("127.0.0.1", 14550), ("127.0.0.1", 14540)], ("127.0.0.1", 14580))]
    ids = {f.name: f.system_id for f in build_module.facts_of(site)}
    assert ids == {name: vehicle.system_id for name, vehicle in site.mission.vehicles.items()}


def test_the_environment_chooses_other_addresses(opened, monkeypatch):
    monkeypatch.setenv("UVF_MAVLINK_TARGETS", "gcs.local:14550,10.0.0.2:9")
    monkeypatch.setenv("UVF_MAVLINK_LISTEN", "")
    (host,) = build(load_scenario(ROOT / "missions" / "demo.yaml"))
    host.make()
    assert opened == [([("gcs.local", 14550), ("10.0.0.2", 9)], None)]


@pytest.mark.parametrize("text", ["px5", "PX4", ""])
def test_an_identity_that_there_is_not_is_named_with_its_place(text, monkeypatch):
    monkeypatch.setenv("UVF_MAVLINK_IDENTITY", text)
    with pytest.raises(BadInput, match="UVF_MAVLINK_IDENTITY"):
        build(load_scenario(ROOT / "missions" / "demo.yaml"))


def test_the_environment_chooses_identity_and_whether_signing_is_required(opened, monkeypatch, tmp_path):
    site = load_scenario(ROOT / "missions" / "demo.yaml")
    monkeypatch.setenv("UVF_STATE", str(tmp_path))
    made = []
    monkeypatch.setattr(build_module, "MavlinkService", lambda *arguments: made.append(arguments))
    for identity, required in (("px4", "0"), ("generic", "1")):
        monkeypatch.setenv("UVF_MAVLINK_IDENTITY", identity)
        monkeypatch.setenv("UVF_MAVLINK_REQUIRE_SIGNING", required)
        build(site)[0].make()
    chosen = [({f.generic for f in facts}, signing._required) for facts, _, _, signing, _ in made]
    assert chosen == [({False}, False), ({True}, True)]
