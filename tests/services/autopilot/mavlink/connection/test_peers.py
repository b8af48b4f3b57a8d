"""Who is there: connections begin and end, each system is greeted once, and each peer has its own rates and numbering."""

import itertools

from services.autopilot.mavlink.connection.line import Sender
from services.autopilot.mavlink.connection.peers import CONNECTION_ENDS, Peers
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, Rig, long, of, texts
from uvf.mavlink import dialect as mav

BEAT = mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3)
SET_INTERVAL = mav.MAV_CMD_SET_MESSAGE_INTERVAL


def greetings(messages):
    return [t for t in texts(messages) if "simulated autopilot" in t]


def beating(rig, seconds, **sender):
    """Heartbeats once a second for a while; all that was heard."""
    heard = []
    for _ in range(seconds):
        rig.say(BEAT, **sender)
        heard += rig.run(1.0)
    return heard


def test_a_peer_with_two_systems_is_known_for_both():
    peers = Peers()
    assert peers.hear(0.0, Sender(GCS, 255, 190)) == (True, True)
    assert peers.hear(0.1, Sender(GCS, 254, 190)) == (False, True)
    assert peers.hear(0.2, Sender(GCS, 255, 230)) == (False, False)
    assert peers.systems(0.2, GCS) == {254, 255} and peers.systems(0.2, OTHER) == set()


def test_a_connection_ends_with_silence_and_leaves_nothing_behind():
    peers = Peers()
    peers.hear(0.0, Sender(GCS, 255, 190))
    assert peers.hear(CONNECTION_ENDS, Sender(GCS, 255, 190)) == (False, False)
    assert peers.hear(2 * CONNECTION_ENDS + 0.1, Sender(GCS, 255, 190)) == (True, True)
    peers.forget(100.0, [GCS])
    assert len(peers) == 0


def test_a_ground_station_is_greeted_once_a_connection_and_again_when_it_comes_back():
    rig = Rig()
    rig.run()
    assert len(greetings(beating(rig, 30))) == 2  # one a vehicle
    rig.run(CONNECTION_ENDS + 1.0)
    assert len(greetings(beating(rig, 12))) == 2


def test_a_second_system_behind_the_same_address_is_greeted_too():
    rig = Rig()
    rig.run()
    beating(rig, 11)
    assert len(greetings(beating(rig, 2, system=254))) == 2


def test_a_caller_hears_what_the_configured_peers_hear():
    rig, caller = Rig(), ("127.0.0.1", 40000)
    rig.say(BEAT, peer=caller)
    rig.run(2.0)
    kinds = [{m.get_type() for m in rig.heard(peer)} for peer in (caller, GCS)]
    assert {"HEARTBEAT", "ATTITUDE", "GLOBAL_POSITION_INT"} <= kinds[0] and "STATUSTEXT" in kinds[0]


def test_answers_go_to_the_asker_alone():
    rig = Rig()
    rig.run()
    rig.say(long(512, 148.0))
    rig.say(long(400, 1.0), system=245, peer=OTHER)
    rig.run()
    assert [(m.command, m.target_system) for m in of(rig.heard(GCS), "COMMAND_ACK")] == [(512, 255)]
    assert [(m.command, m.target_system) for m in of(rig.heard(OTHER), "COMMAND_ACK")] == [(400, 245)]
    assert of(rig.heard(GCS), "AUTOPILOT_VERSION") and not of(rig.heard(OTHER), "AUTOPILOT_VERSION")


def test_nobody_misses_a_number_however_different_the_rates():
    rig = Rig()
    rig.run()
    rig.say(long(SET_INTERVAL, float(mav.MAVLINK_MSG_ID_ATTITUDE), -1.0))
    rig.say(long(512, 148.0), peer=OTHER)
    rig.run(4.0)
    for peer in (GCS, OTHER):
        seqs = [m.get_seq() for m in rig.heard(peer) if m.get_srcSystem() == PLANE]
        assert {(b - a) % 256 for a, b in itertools.pairwise(seqs)} == {1}
    assert not of(rig.heard(GCS), "ATTITUDE", PLANE) and of(rig.heard(OTHER), "ATTITUDE", PLANE)


def test_a_new_connection_begins_with_default_rates():
    rig = Rig()
    rig.say(long(SET_INTERVAL, float(mav.MAVLINK_MSG_ID_ATTITUDE), -1.0))
    assert not of(rig.run(1.0)[5:], "ATTITUDE", PLANE)
    assert not of(rig.run(CONNECTION_ENDS), "ATTITUDE", PLANE)
    rig.say(BEAT)
    assert of(rig.run(1.0), "ATTITUDE", PLANE)


def rates(rig, peer, seconds=4.0):
    """Messages a second of the plane, by type."""
    rig.run(seconds)
    kinds = [m.get_type() for m in rig.heard(peer) if m.get_srcSystem() == PLANE]
    return {kind: kinds.count(kind) / seconds for kind in set(kinds)}


def test_a_data_stream_changes_the_rates_of_its_group_for_its_peer_alone():
    rig = Rig()
    rig.run()
    rig.say(mav.MAVLink_request_data_stream_message(PLANE, 1, mav.MAV_DATA_STREAM_EXTRA1, 5, 1))
    mine, theirs = rates(rig, GCS), rates(Rig(), OTHER)
    assert mine["ATTITUDE"] == mine["ATTITUDE_QUATERNION"] == 5 and theirs["ATTITUDE"] == 20
    assert mine["GLOBAL_POSITION_INT"] == theirs["GLOBAL_POSITION_INT"] == 10


def test_all_data_streams_as_mavproxy_asks_for_them_leave_heartbeat_and_home_alone():
    rig = Rig()
    rig.run()
    for _ in range(3):
        rig.say(mav.MAVLink_request_data_stream_message(PLANE, 0, mav.MAV_DATA_STREAM_ALL, 4, 1))
        rig.run(1.0)
    seen = rates(rig, GCS)
    assert {seen[k] for k in ("ATTITUDE", "VFR_HUD", "GLOBAL_POSITION_INT", "SYS_STATUS", "GPS_RAW_INT")} == {4.0}
    assert (seen["HEARTBEAT"], seen["HOME_POSITION"], seen["EXTENDED_SYS_STATE"]) == (1.0, 0.5, 1.0)


def test_a_data_stream_is_stopped_and_goes_back_to_what_it_was():
    rig = Rig()
    rig.run()
    for rate, start, wanted in ((4, 0, None), (0, 1, 10.0)):
        rig.say(mav.MAVLink_request_data_stream_message(PLANE, 1, mav.MAV_DATA_STREAM_POSITION, rate, start))
        rig.run()
        assert rates(rig, GCS).get("GLOBAL_POSITION_INT") == wanted
    rig.say(mav.MAVLink_request_data_stream_message(PLANE, 1, 99, 4, 1))
    rig.run()


def test_intervals_are_set_told_and_given_back():
    rig = Rig()
    rig.run()
    number = float(mav.MAVLINK_MSG_ID_VFR_HUD)
    for microseconds, hz, told in ((500_000.0, 2.0, 500_000), (-1.0, None, -1), (0.0, 10.0, 100_000), (1.0, 50.0, 20_000)):
        rig.say(long(SET_INTERVAL, number, microseconds))
        rig.run()
        rig.say(long(mav.MAV_CMD_GET_MESSAGE_INTERVAL, number))
        assert [(m.message_id, m.interval_us) for m in of(rig.run(), "MESSAGE_INTERVAL")] == [(74, told)]
        assert rates(rig, GCS).get("VFR_HUD") == hz
