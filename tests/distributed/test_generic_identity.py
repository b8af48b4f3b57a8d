"""MAVSDK flies a vehicle that says it is generic, against the whole system."""

import sys
import time
from pathlib import Path

import pytest

from tests.distributed.programs.script import Script
from tests.distributed.programs.udp_station import UdpStation
from tests.distributed.system import System
from uvf.mavlink import dialect as mav

STRIP = Path(__file__).parent / "programs" / "strip.yaml"
FLIGHT_WITHIN = 300.0  # s
WORDS_WITHIN = 30.0  # s

pytestmark = pytest.mark.timeout(900)


def flown(folder):
    """The script, and the texts that a station has read which listens from the first datagram on.

    MAVSDK speaks to the vehicle before its program can subscribe to texts: what is said to it first may pass unread.
    """
    station = UdpStation()
    system = System(folder, "--rate", "2", mission=str(STRIP), programs=(station.port,))
    system.environment["UVF_MAVLINK_IDENTITY"] = "generic"
    with system, Script(sys.executable, system.mavlink, 1, 1, folder / "mavsdk.txt", "short") as script:
        texts = texts_for(station)
        script.ends(FLIGHT_WITHIN)
    station.close()
    return script, texts


def texts_for(station):
    """Until the vehicle has said what it is."""
    texts, give_up = [], time.monotonic() + WORDS_WITHIN
    while not any("UVF" in text for text in texts) and time.monotonic() < give_up:
        station.say(mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, mav.MAV_STATE_ACTIVE, 3))
        station.say(mav.MAVLink_param_request_read_message(1, 1, b"SYS_AUTOSTART", -1))
        texts += [message.text for message in station.run(0.5) if message.get_type() == "STATUSTEXT"]
    return texts


@pytest.fixture(scope="module")
def flight(tmp_path_factory):
    """What a busy machine has spoilt is flown once more."""
    script, texts = flown(tmp_path_factory.mktemp("generic"))
    return (script, texts) if script.has_ended() else flown(tmp_path_factory.mktemp("generic"))


def test_a_basic_flight_passes_without_a_refusal(flight):
    script, _ = flight
    assert script.amiss() == [] and script.has_ended(), script.said()[-2000:]


def test_its_modes_are_read_and_it_says_what_it_is(flight):
    script, texts = flight
    assert script.told("flight_mode")[:5] == ["HOLD", "TAKEOFF", "HOLD", "RETURN_TO_LAUNCH", "LAND"]
    assert any("simulated autopilot (generic MAVLink)" in text for text in texts), texts
