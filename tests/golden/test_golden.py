"""Each service, fed with the inputs of a log recorded before, still puts out what it put out then.

A difference is either a fault or meant; when meant, ``python -m tests.golden.make`` records anew.
"""

import dataclasses

import msgspec
import pytest

from launch import catalogue
from tests.golden.make import GOLDEN
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.log.replay import into_service

TOLERANCE = 1e-6  # processors round the last digits differently
TOLERANCES = {"tracker": 0.05}
"""m/s and rad/s: what it chooses it averages from many futures, in single precision, and each average is the start of the next."""
KINDS = [catalogue.kind(name) for name in ("sim_ground", "sim_air", "slam", "planner", "autopilot")]
ONLY_ASKED = "map_server"  # speaks when it is asked for something, and nobody does so in this log
HOSTS = {h.service.name: h for h in catalogue.hosts(load_scenario(ROOT / "missions" / "demo.yaml"), KINDS) if h.service.name != ONLY_ASKED}


@pytest.mark.parametrize("name", HOSTS)
def test_the_service_does_what_it_did(name):
    assert [str(d) for d in into_service(GOLDEN, HOSTS[name], TOLERANCES.get(name, TOLERANCE))][:5] == []


@pytest.mark.parametrize("name", HOSTS)
def test_a_service_that_falls_silent_is_noticed(name):
    host = HOSTS[name]

    def mute():
        service = host.make()
        service.step = lambda t, now: service.Outputs()
        return service

    assert any(d.now == "missing" for d in into_service(GOLDEN, dataclasses.replace(host, make=mute), TOLERANCE))


def test_a_change_of_behaviour_is_noticed():
    host = HOSTS["autopilot_air"]

    def otherwise():
        service = host.make()
        service.params = msgspec.structs.replace(service.params, trim_airspeed=26.0)
        return service

    changed = list(into_service(GOLDEN, dataclasses.replace(host, make=otherwise), TOLERANCE))
    assert changed and "actuator/surfaces" in {d.key.split("/", 2)[2] for d in changed}
