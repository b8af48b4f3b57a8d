"""Words that the glossary has retired do not come back."""

import ast
from collections import defaultdict

import pytest

from tests.test_house import name, sources
from uvf.models.scenario import ROOT

CLASSES = {
    "Wish": "Setpoint",
    "Wanted": "a setpoint, or what is requested",
    "Flown": "ControlOutput",
    "Senses": "FlightContext",
    "Said": "SensorInputs",
    "Known": "FailsafeInputs",
    "Ship": "AutopilotConfig",
    "Pilot": "ModeManager",
    "Helm": "FlightController",
    "Stand": "PlanProgress",
    "Steadied": "LeaderSpeedFilter",
    "Trail": "LeaderTrack",
    "Station": "FormationSlot",
    "Line": "VehicleConnection, DelayLine",
    "Facts": "VehicleInfo",
    "Latest": "VehicleState",
    "Shell": "ServiceRunner",
    "Host": "ServiceInstance",
    "Site": "Scenario",
    "Member": "MissionVehicle",
    "Keeper": "StateStore",
    "Taste": "FrontierWeights",
    "Ways": "CostToGo, PathLengths",
}
ALLOWED = {"Station": {"services/mavlink_bridge/station.py"}, "Known": {"launch/slam/known.py"}}
"""A ground station is called so; what is known of a log's truth is no failsafe."""
PHRASES = (
    "Time stands.",
    "Time goes on.",
    "those of others.",
    "with whose body",
    "Whose; not needed",
    "Of the conductor.",
    "taken for true",
    "as it guesses",
    "The later ones come before",
    "goes behind it",
)
OWN_ROOMS = {"Inputs", "Outputs", "Recalls"}
"""What each service calls its own."""


def classes():
    found = defaultdict(set)
    for path in sources():
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                found[node.name].add(name(path))
    return found


def test_retired_names_are_not_defined():
    found = classes()
    assert {old: found[old] - ALLOWED.get(old, set()) for old in CLASSES if found[old] - ALLOWED.get(old, set())} == {}


def test_one_name_means_one_class():
    assert {each: files for each, files in classes().items() if len(files) > 1 and each not in OWN_ROOMS} == {}


@pytest.mark.parametrize("phrase", PHRASES)
def test_nobody_is_told_what_was_hard_to_understand(phrase):
    shown = [*sources(), *(ROOT / "services").rglob("*.html"), *(ROOT / "services").rglob("*.js"), ROOT / "README.md"]
    assert [name(path) for path in shown if phrase in path.read_text()] == []
