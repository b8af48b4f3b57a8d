"""Two ground stations with one number, as every QGroundControl has it, are two; and strangers, however many, leave nothing behind."""

import struct

import pytest

from schemas.messages import Mode
from services.autopilot.mavlink.connection.command_server import MOST_SENDERS
from services.autopilot.mavlink.missions.missions import MOST_WAITING
from tests.services.autopilot.mavlink.missions.test_missions import LAT, LON, count, item
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, ROVER, Rig, long, of, texts
from uvf.mavlink import dialect as mav
from uvf.mavlink.endpoint import ENGAGED_FOR, FORGET_AFTER, MOST_LEARNED, Callers

BEAT = mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3)
OPEN = struct.Struct("<HBBBBBxI").pack(1, 0, 4, 8, 0, 0, 0) + b"/nothing"


def acknowledged(rig, peer):
    return [m.type for m in of(rig.heard(peer), "MISSION_ACK")]


def test_two_uploads_at_once_are_not_mixed_into_one_plan():
    rig = Rig()
    rig.run()
    rig.say(count(2), peer=GCS)
    rig.run(0.04)
    rig.say(count(2), peer=OTHER)
    for seq in range(2):
        rig.say(item(seq, place=(LAT, LON, 50.0)), peer=GCS)
        rig.say(item(seq, place=(LAT, LON, 90.0)), peer=OTHER)
    rig.run()
    assert acknowledged(rig, OTHER) == [mav.MAV_MISSION_DENIED] and acknowledged(rig, GCS) == [mav.MAV_MISSION_ACCEPTED]
    assert {round(i.position.z) for i in rig.plane.mission.items} == {70}, "of one of them alone: 50 m above a home at 20 m"


def test_one_does_not_end_the_others_upload():
    rig = Rig()
    rig.run()
    rig.say(count(1), peer=GCS)
    rig.run(0.04)
    rig.say(mav.MAVLink_mission_ack_message(PLANE, 1, mav.MAV_MISSION_OPERATION_CANCELLED, 0), peer=OTHER)
    rig.say(item(0), peer=GCS)
    rig.run()
    assert acknowledged(rig, GCS) == [mav.MAV_MISSION_ACCEPTED]


@pytest.mark.parametrize("system", [PLANE, ROVER])
def test_only_one_of_them_steers(system):
    rig = Rig()
    for vehicle in (rig.plane, rig.rover):
        vehicle.status.mode = Mode.MODE_MANUAL
    rig.run()
    output = "surfaces" if system == PLANE else "drive"
    rig.say(mav.MAVLink_manual_control_message(system, 0, 500, 500, 0, 0), peer=GCS)
    rig.run(0.02)
    assert output in rig.outputs
    rig.say(mav.MAVLink_manual_control_message(system, 0, -500, 0, 0, 0), peer=OTHER)
    rig.run(0.02)
    assert output not in rig.outputs
    assert "Sticks ignored: another station 255 (at 127.0.0.1:14550) steers" in texts(rig.heard(OTHER))


def test_what_one_has_asked_is_no_repetition_of_the_other():
    rig = Rig()
    rig.run()
    rig.say(long(400, 1.0, confirmation=0), peer=GCS)
    rig.run()
    rig.say(long(400, 1.0, confirmation=1), peer=OTHER)
    rig.run()
    assert len([1 for name, _ in rig.plane.asked if name == "arm"]) == 2


def test_both_count_as_stations_in_touch():
    rig = Rig()
    rig.say(BEAT, peer=GCS)
    rig.say(BEAT, peer=OTHER)
    seen = set()
    for _ in range(50):
        rig.run(0.02)
        seen |= {link.stations for link in rig.outputs.get("link", {}).values()}
    assert max(seen) == 2


def sizes(service, link, t):
    """Of all that is kept by sender or peer."""
    reception, signing = service._reception, service._signing
    found = {
        "peers": len(reception._peers),
        "stations": len(reception.stations._heard),
        "links": len(link.peers(t)),
        "keys": len(signing._keys) + len(signing._by_peer) + len(signing._streams),
        "numbering": len(service.codec._seq),
    }
    for vehicle in service._vehicles.values():
        found["commands"] = sum(map(len, vehicle._commands._last.values()))
        found["files"] = len(vehicle._ftp._talks) + len(vehicle._ftp._sessions)
        found["lists"] = len(vehicle._parameters._progress)
        found["rates"] = len(vehicle.schedule._own) + len(vehicle.schedule._due)
        found["texts"] = len(vehicle.line._limiter._said)
        found["shares"] = len(vehicle.line._budget)
        found["plans"] = len(vehicle._missions._waiting) + len(vehicle._missions._shown)
    return found


def stranger(rig, n):
    """One more, from a port and with numbers of its own; some say several things."""
    who = {"system": 3 + n % 250, "component": n // 250 % 256, "peer": ("203.0.113.7", 1024 + n % 60_000)}
    rig.say(BEAT, **who)
    rig.say(long(20_000 + n % 5000, 0.0), **who)
    if n % 10 == 0:
        rig.say(long(511, 30.0, 1e5), **who)
        rig.say(mav.MAVLink_param_request_list_message(PLANE, 1), **who)
        rig.say(mav.MAVLink_mission_request_list_message(PLANE, 1, 0), **who)
        rig.say(mav.MAVLink_setup_signing_message(PLANE, 1, n.to_bytes(32, "little"), 0), **{**who, "peer": ("127.0.0.1", who["peer"][1])})
        rig.say(mav.MAVLink_file_transfer_protocol_message(0, PLANE, 1, OPEN.ljust(251, b"\0")), **who)


def test_thousands_of_strangers_fill_no_table_and_are_forgotten():
    rig = Rig()
    rig.run()
    for n in range(4000):
        stranger(rig, n)
        if n % 100 == 99:
            rig.run(0.02)
    most = sizes(rig.service, rig.link, rig.t)
    assert most["links"] <= 2 + MOST_LEARNED and most["stations"] <= 64 and most["keys"] <= 64
    assert most["commands"] <= 32 * MOST_SENDERS and most["texts"] <= 256 and most["files"] <= 96
    assert most["peers"] <= 32 * (3 + MOST_LEARNED) and most["lists"] <= 2 + MOST_LEARNED and most["rates"] < 100
    assert most["shares"] <= 128 and most["plans"] <= 2 * MOST_WAITING
    rig.link.outgoing.clear()
    for _ in range(4):
        rig.run(FORGET_AFTER / 2)
    gone = sizes(rig.service, rig.link, rig.t)
    assert gone["links"] == 2 and gone["commands"] == gone["peers"] == gone["stations"] == 0
    assert gone["files"] == gone["lists"] == gone["plans"] == gone["shares"] == 0


def test_a_station_among_strangers_is_answered_and_keeps_its_rates():
    rig = Rig()
    rig.run()
    good = ("127.0.0.1", 40_000)
    rig.say(long(512, 148.0), peer=good)
    for n in range(100):
        stranger(rig, n)
    rig.run(0.1)
    answers = rig.heard(good)
    assert of(answers, "AUTOPILOT_VERSION") and [m.result for m in of(answers, "COMMAND_ACK")] == [0]


def test_who_transfers_or_steers_is_forgotten_after_those_that_only_call():
    callers = Callers()
    callers.keep(0.0, GCS, engaged=True)
    for n in range(3 * MOST_LEARNED):
        callers.keep(0.1, (f"203.0.113.{n}", 7))
    assert GCS in callers.peers(0.1) and len(callers.peers(0.1)) == MOST_LEARNED
    for n in range(3 * MOST_LEARNED):
        callers.keep(ENGAGED_FOR + 0.2, (f"203.0.113.{n}", 8))
    assert GCS not in callers.peers(ENGAGED_FOR + 0.2)
