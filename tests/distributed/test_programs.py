"""The programs that people use, at the same time, each from an environment of its own, against the whole system: MAVSDK 4.1.0 and
3.17.4 each fly an aircraft from start to end, MAVProxy 1.8.75 has a third one on the ground, QGroundControl's emulator connects to all.
"""

import itertools
import re
import sys
import time
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.distributed.programs.environments import LeftOut, python_of
from tests.distributed.programs.mavproxy import MavProxy
from tests.distributed.programs.script import Script
from tests.distributed.programs.tap import Tap
from tests.distributed.programs.udp_station import UdpStation
from tests.distributed.system import System
from tests.distributed.test_mavsdk import free_port
from tests.services.autopilot.mavlink.qgroundcontrol import QGroundControl
from uvf.mavlink import dialect as mav

FIELD = Path(__file__).parent / "programs" / "field.yaml"
VEHICLES = [1, 2, 3, 4, 5]
SDK3, SDK4, MAVPROXY = "mavsdk 3.17.4", "mavsdk 4.1.0", "mavproxy 1.8.75"
FLOWN = {SDK3: 1, SDK4: 2, MAVPROXY: 3}
"""Which vehicle each program has. MAVSDK 3 takes the first that it hears: its port is for that one alone."""
IDS = {SDK3: (245, 190), SDK4: (245, 190), MAVPROXY: (255, 230)}
TOGETHER = 60.0  # s
LONGEST_GAP = 1.5  # s
FLIGHT_WITHIN = 420.0  # s
MODES = ["HOLD", "TAKEOFF", "HOLD", "POSCTL", "MISSION", "HOLD", "MISSION", "HOLD", "RETURN_TO_LAUNCH", "LAND"]
LANDED = ["ON_GROUND", "TAKING_OFF", "IN_AIR", "LANDING", "ON_GROUND"]
NO_SUCH_PARAMETER = "a parameter that is none"

pytestmark = pytest.mark.timeout(1500)


@dataclass
class Seen:
    """What came of it all: by program the scripts, whether they have come to their end, and the wire taps; by vehicle what
    QGroundControl's user is told.
    """

    scripts: dict
    ends: dict
    taps: dict
    console: str
    unanswered: list
    complaints: dict


def told_by_qgroundcontrol(station):
    """What it complains of each vehicle."""
    station.drain()
    complaints = {}
    for system_id in VEHICLES:
        ground_station = QGroundControl(station, system_id)
        ground_station.connect()
        complaints[system_id] = ground_station.complaints
    return complaints


def flown(pythons, folder):
    """All programs at once, from the start of the system until the last of them has ended."""
    ports = {program: free_port() for program in FLOWN}
    with ExitStack() as stack:
        swapped = {MAVPROXY: mav.MAVLINK_MSG_ID_MISSION_REQUEST_INT}
        taps = {program: stack.enter_context(Tap(port, swapped.get(program))) for program, port in ports.items()}
        station = stack.enter_context(closing(UdpStation()))
        targets = [taps[SDK4].port, taps[MAVPROXY].port, station.port, f"{taps[SDK3].port}/{FLOWN[SDK3]}"]
        stack.enter_context(System(folder, "--rate", "1", mission=str(FIELD), programs=targets))
        scripts = {
            program: stack.enter_context(Script(pythons[program], ports[program], FLOWN[program], len(VEHICLES), folder / f"{program}.txt"))
            for program in (SDK4, SDK3)
        }
        console = stack.enter_context(MavProxy(pythons[MAVPROXY], ports[MAVPROXY], FLOWN[MAVPROXY], folder))
        begun = time.monotonic()
        unanswered, complaints = console.converse(), told_by_qgroundcontrol(station)
        ends = {program: script.ends(FLIGHT_WITHIN) for program, script in scripts.items()}
        time.sleep(max(0.0, begun + TOGETHER + 1.0 - time.monotonic()))
        return Seen(scripts, ends, taps, console.said(), unanswered, complaints)


@pytest.fixture(scope="module")
def pythons():
    try:
        return {SDK3: python_of("mavsdk3"), SDK4: Path(sys.executable), MAVPROXY: python_of("mavproxy")}
    except LeftOut as why:
        pytest.skip(str(why))


@pytest.fixture(scope="module")
def seen(pythons, tmp_path_factory):
    """What a busy machine has spoilt is flown once more."""
    first = flown(pythons, tmp_path_factory.mktemp("programs"))
    return first if all(first.ends.values()) else flown(pythons, tmp_path_factory.mktemp("programs"))


both = pytest.mark.parametrize("program", [SDK4, SDK3])


@both
def test_a_script_flies_from_arming_to_disarming_without_a_refusal(seen, program):
    script = seen.scripts[program]
    assert [step for step in script.amiss() if step["what"] != NO_SUCH_PARAMETER] == []
    assert seen.ends[program], script.said()[-2000:]


@both
def test_it_is_ready_within_20_seconds(seen, program):
    assert seen.scripts[program].told("health_all_ok")[-1] is True
    assert seen.scripts[program].step("ready")["t"] - seen.scripts[program].step("connected")["t"] < 20.0


@both
def test_its_streams_tell_the_flight_as_it_is(seen, program):
    assert seen.scripts[program].told("armed") == [False, True, False]
    assert seen.scripts[program].told("in_air") == [False, True, False]
    assert seen.scripts[program].told("landed_state") == LANDED
    assert seen.scripts[program].told("flight_mode")[: len(MODES)] == MODES


@both
def test_a_mission_comes_back_as_it_went_up_and_is_flown_to_its_last_item(seen, program):
    assert seen.scripts[program].step("download")["off"] < 2e-7
    assert seen.scripts[program].told("progress") == [[0, 4], [1, 4], [3, 4], [4, 4]]
    assert seen.scripts[program].step("finished")["now"] is True
    assert seen.scripts[program].step("jump")["took"] < 1.0


@both
def test_parameters_are_set_and_an_unknown_one_fails_soon(seen, program):
    back = seen.scripts[program].step("read back")
    assert (back["value"], back["system_id"]) == (85.0, FLOWN[program])
    unknown = seen.scripts[program].step(NO_SUCH_PARAMETER)
    assert "DOES_NOT_EXIST" in unknown["failed"] and unknown["took"] <= 3.1


@both
def test_it_is_told_of_nothing_that_is_wrong(seen, program):
    texts = [m for _, m in seen.taps[program].heard() if m.get_type() == "STATUSTEXT" and m.get_srcSystem() == FLOWN[program]]
    assert [m.text for m in texts if m.severity <= mav.MAV_SEVERITY_ERROR or m.text.startswith("PreArm") or "refused" in m.text] == []


def test_five_vehicles_are_found_by_mavsdk_and_qgroundcontrol(seen):
    assert seen.scripts[SDK4].step("connected")["found"] == VEHICLES
    assert seen.complaints == {system_id: [] for system_id in VEHICLES}


def test_mavproxy_is_answered_and_prints_no_error(seen):
    assert seen.unanswered == []
    assert not re.search(r"ERROR|Traceback|breach|REJECTED|DENIED|UNSUPPORTED", seen.console), seen.console


def test_mavproxy_has_its_parameters_within_5_seconds_of_its_vehicle(seen):
    """By the vehicle's own clock: on a busy machine all of it is late."""
    tap = seen.taps[MAVPROXY]
    asked = next(t for t, m in tap.said() if m.get_type() == "PARAM_REQUEST_LIST" and m.target_system == FLOWN[MAVPROXY])
    own = [(t, m) for t, m in tap.heard() if t >= asked and m.get_srcSystem() == FLOWN[MAVPROXY]]
    values = [(t, m) for t, m in own if m.get_type() == "PARAM_VALUE"]
    first = {m.param_index: t for t, m in reversed(values) if m.param_index < m.param_count}
    assert set(first) == set(range(values[0][1].param_count))
    clock = [m.time_boot_ms for t, m in own if m.get_type() == "SYSTEM_TIME" and t <= max(first.values())]
    assert clock == [] or clock[-1] - clock[0] < 5000


def test_mavproxy_asks_for_five_items_at_once_in_another_order_and_has_them_all(seen):
    tap = seen.taps[MAVPROXY]
    asked = [(t, m.seq) for t, m in tap.said() if m.get_type() == "MISSION_REQUEST_INT" and m.mission_type == 0]
    answered = [(t, m.seq) for t, m in tap.heard() if m.get_type() == "MISSION_ITEM_INT" and m.mission_type == 0]
    assert [seq for _, seq in asked[:5]] == [0, 1, 2, 3, 4] and asked[4][0] < answered[0][0], "it asks ahead"
    assert [seq for _, seq in answered[:4]] == [1, 0, 3, 2], "two of its questions change places on the way"
    assert {seq for _, seq in answered} == set(range(8))


@pytest.mark.parametrize("program", FLOWN)
def test_each_hears_the_answers_to_its_own_commands_alone(seen, program):
    asked = {}
    for _, m in seen.taps[program].said():
        if m.get_type() in ("COMMAND_LONG", "COMMAND_INT"):
            asked[m.command] = asked.get(m.command, 0) + 1
    acks = [m for _, m in seen.taps[program].heard() if m.get_type() == "COMMAND_ACK"]
    assert acks and {(m.target_system, m.target_component) for m in acks} == {IDS[program]}
    answered = {command: sum(m.command == command for m in acks) for command in {m.command for m in acks}}
    assert all(count <= asked.get(command, 0) for command, count in answered.items()), (answered, asked)


@pytest.mark.parametrize("program", FLOWN)
def test_each_hears_each_vehicle_without_a_gap_for_a_minute(seen, program):
    for system_id in [FLOWN[SDK3]] if program == SDK3 else VEHICLES:
        heard = seen.taps[program].heard()
        beats = [t for t, m in heard if m.get_type() == "HEARTBEAT" and m.get_srcSystem() == system_id]
        assert beats[-1] - beats[0] >= TOGETHER
        assert max(b - a for a, b in itertools.pairwise(beats)) <= LONGEST_GAP
