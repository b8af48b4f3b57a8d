"""Each vehicle of the demo gets the autopilot of its kind."""

from services.autopilot.build import build
from uvf.models.scenario import ROOT, load_scenario


def test_every_vehicle_of_the_demo_has_one_autopilot():
    site = load_scenario(ROOT / "missions" / "demo.yaml")
    built = {host.vehicle: host.service.name for host in build(site) if host.service.name.startswith("autopilot")}
    for name, member in site.members.items():
        assert built[name] == ("autopilot_air" if member.file.kind == "fixed_wing" else "autopilot_ground")


def test_a_reset_makes_a_new_autopilot():
    host = next(h for h in build(load_scenario(ROOT / "missions" / "demo.yaml")) if h.vehicle == "milvus")
    assert host.make() is not host.make()
