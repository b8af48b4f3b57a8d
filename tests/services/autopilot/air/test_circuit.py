"""The circuit mission in lockstep: take-off from the strip, legs, landing on it."""

import pytest

from launch.run import run_lockstep
from uvf.models.scenario import ROOT, load_scenario

CIRCUIT = ROOT / "missions" / "circuit.yaml"


@pytest.fixture(scope="module")
def circuit(tmp_path_factory):
    return run_lockstep(load_scenario(CIRCUIT), 180.0, tmp_path_factory.mktemp("circuit") / "log.mcap")


def test_every_criterion_of_the_circuit_holds(circuit):
    assert len(circuit.verdicts) == 4
    assert {v.criterion.measure: v.found for v in circuit.verdicts if not v.passed} == {}
