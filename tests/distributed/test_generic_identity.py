"""MAVSDK flies a vehicle that says it is generic, against the whole system."""

import sys
from pathlib import Path

import pytest

from tests.distributed.programs.script import Script
from tests.distributed.system import System

STRIP = Path(__file__).parent / "programs" / "strip.yaml"
FLIGHT_WITHIN = 300.0  # s

pytestmark = pytest.mark.timeout(900)


def flown(folder):
    system = System(folder, "--rate", "2", mission=str(STRIP))
    system.environment["UVF_MAVLINK_IDENTITY"] = "generic"
    with system, Script(sys.executable, system.mavlink, 1, 1, folder / "mavsdk.txt", "short") as script:
        return script, script.ends(FLIGHT_WITHIN)


@pytest.fixture(scope="module")
def script(tmp_path_factory):
    """What a busy machine has spoilt is flown once more."""
    script, has_ended = flown(tmp_path_factory.mktemp("generic"))
    return script if has_ended else flown(tmp_path_factory.mktemp("generic"))[0]


def test_a_basic_flight_passes_without_a_refusal(script):
    assert script.amiss() == [] and script.has_ended(), script.said()[-2000:]


def test_its_modes_are_read_and_it_says_what_it_is(script):
    assert script.told("flight_mode")[:5] == ["HOLD", "TAKEOFF", "HOLD", "RETURN_TO_LAUNCH", "LAND"]
    assert any("simulated autopilot (generic MAVLink)" in text for text in script.told("status_text"))
