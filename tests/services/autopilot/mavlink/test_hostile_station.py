"""A station that means harm, or is only broken, keeps nobody else from uploading, downloading and commanding."""

from schemas.messages import Event
from tests.services.autopilot.mavlink.missions.test_missions import LAT, LON, count, item, upload
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, Rig, long, of, texts
from tests.services.autopilot.mavlink.test_two_stations import BEAT
from uvf.mavlink import dialect as mav
from uvf.mavlink.endpoint import MOST_LEARNED, Callers
from uvf.runtime.messages.convert import stamp

FENCE = mav.MAV_MISSION_TYPE_FENCE
STRANGER = {"system": 200, "peer": ("203.0.113.9", 3000)}


def acks_of(messages):
    return [m.type for m in of(messages, "MISSION_ACK")]


def test_who_announces_a_fence_keeps_nobody_from_uploading_a_mission():
    rig = Rig()
    rig.run()
    rig.say(count(3, FENCE), **STRANGER)
    rig.run(0.04)
    assert upload(rig, [item(0)])[0].type == mav.MAV_MISSION_ACCEPTED


def test_a_denied_upload_says_who_uploads():
    rig = Rig()
    rig.run()
    rig.say(count(3), peer=OTHER)
    rig.run(0.04)
    rig.say(count(1))
    heard = rig.run(0.04)
    assert acks_of(heard) == [mav.MAV_MISSION_DENIED]
    assert "Mission refused: another station 255 (at 127.0.0.1:14540) uploads" in texts(heard)
    assert not texts(rig.heard(OTHER))


def test_an_upload_that_is_begun_again_and_again_makes_room_after_ten_seconds():
    rig = Rig()
    rig.run()
    results, told = [], []
    for step in range(600):
        if step % 75 == 0:
            rig.say(count(3), **STRANGER)
        if step % 50 == 30:
            rig.say(count(1))
        rig.run(0.02)
        if of(rig.heard(GCS), "MISSION_REQUEST_INT"):
            rig.say(item(0))
        results += acks_of(rig.heard(GCS))
        told += texts(rig.heard(STRANGER["peer"]))
    assert results.count(mav.MAV_MISSION_ACCEPTED) >= 1 and results.index(mav.MAV_MISSION_ACCEPTED) <= 10
    assert "Mission upload ended after 10 s: station 255 uploads now" in told


def test_pauses_between_its_tries_make_no_upload_younger():
    rig = Rig()
    rig.run()
    results = []
    for second in range(12):
        if second % 3 == 0:
            rig.say(count(3), **STRANGER)
        rig.say(count(1) if second == 10 else mav.MAVLink_mission_ack_message(PLANE, 1, 0, 0))
        results += acks_of(rig.run(0.1))
        if of(rig.heard(GCS), "MISSION_REQUEST_INT"):
            rig.say(item(0))
        results += acks_of(rig.run(0.9))
    assert results == [mav.MAV_MISSION_ACCEPTED]


def test_who_still_uploads_within_ten_seconds_is_not_disturbed():
    rig = Rig()
    rig.run()
    rig.say(count(2), peer=OTHER)
    for second in range(9):
        rig.say(item(0), peer=OTHER) if second == 1 else rig.say(count(2), peer=OTHER)
        rig.say(count(1))
        rig.run(0.04)
        assert acks_of(rig.heard(GCS)) == [mav.MAV_MISSION_DENIED]
        rig.run(0.96)
    for seq in range(2):
        rig.say(item(seq, place=(LAT, LON, 90.0)), peer=OTHER)
    rig.run()
    assert acks_of(rig.heard(OTHER)) == [mav.MAV_MISSION_ACCEPTED]


def asked_for(rig, seq, peer=OTHER):
    rig.say(mav.MAVLink_mission_request_int_message(PLANE, 1, seq, 0), peer=peer)
    rig.run(0.04)
    return [round(m.z) for m in of(rig.heard(peer), "MISSION_ITEM_INT")]


def listed(rig, peer=OTHER):
    rig.say(mav.MAVLink_mission_request_list_message(PLANE, 1, 0), peer=peer)
    rig.run(0.04)


def plan_at(height):
    return [item(seq, place=(LAT, LON, height)) for seq in range(2)]


def test_a_download_is_of_one_plan_though_another_is_uploaded_meanwhile():
    rig = Rig()
    rig.run()
    upload(rig, plan_at(11.0))
    listed(rig)
    first = asked_for(rig, 0)
    upload(rig, plan_at(91.0))
    assert first + asked_for(rig, 1) == [11, 11]
    listed(rig)
    assert asked_for(rig, 0) + asked_for(rig, 1) == [91, 91]


def test_who_has_uploaded_or_acknowledged_sees_the_plan_in_force():
    rig = Rig()
    rig.run()
    upload(rig, plan_at(11.0))
    for peer in (GCS, OTHER):
        listed(rig, peer)
    rig.say(mav.MAVLink_mission_ack_message(PLANE, 1, mav.MAV_MISSION_ACCEPTED, 0), peer=OTHER)
    upload(rig, plan_at(91.0))
    assert asked_for(rig, 1, GCS) == asked_for(rig, 1, OTHER) == [91]


def test_a_download_that_is_given_up_is_forgotten():
    rig = Rig()
    rig.run()
    upload(rig, plan_at(11.0))
    listed(rig)
    upload(rig, plan_at(91.0))
    assert asked_for(rig, 1) == [11]
    rig.run(10.1)
    assert asked_for(rig, 1) == [91]


def test_a_flood_of_callers_pushes_out_nobody_who_has_spoken_for_a_while():
    rig, station = Rig(), ("192.0.2.1", 50_000)
    attitudes = 0
    for step in range(700):
        if step % 50 == 0:
            rig.say(BEAT, peer=station)
        for port in range(40):
            if step >= 300 and step % 5 == port % 5:
                rig.say(BEAT, system=200, peer=("203.0.113.9", 3000 + port))
        rig.run(0.02)
        attitudes += step >= 300 and len(of(rig.heard(station), "ATTITUDE", PLANE))
    assert attitudes >= 155, "20 a second"


def test_one_hosts_flood_keeps_no_newcomer_of_another_host_out():
    callers, station = Callers(), ("192.0.2.1", 50_000)
    for n in range(1000):
        callers.keep(n * 2.5e-3, ("203.0.113.9", n % 40), engaged=True)
        if n == 100:
            callers.keep(n * 2.5e-3, station)
    assert station in callers.peers(2.5)


def test_when_all_have_spoken_for_long_the_newest_makes_room():
    callers = Callers()
    ports = [("203.0.113.9", n) for n in range(MOST_LEARNED)]
    for second in range(10):
        for n, port in enumerate(ports):
            callers.keep(second + n * 1e-3, port)
    callers.keep(10.0, GCS)
    assert callers.peers(10.0) == [*ports[:-1], GCS]


def test_who_was_silent_for_long_counts_as_new():
    callers = Callers()
    for second in range(10):
        callers.keep(float(second), GCS)
    callers.keep(20.0, GCS)
    for n in range(MOST_LEARNED):
        callers.keep(20.1, (f"203.0.113.{n}", 1))
    assert GCS not in callers.peers(20.1)


SPEED, RETURN, ARM = 178, 20, 400


def flood(rig, n):
    """Changes of speed of a stranger with many numbers, none of which is a repetition."""
    for k in range(n):
        rig.say(long(SPEED, 0.0, 10.0 + k * 1e-3), system=3 + k % 200, peer=STRANGER["peer"])


def test_a_strangers_flood_of_commands_is_no_reason_to_refuse_the_operators():
    rig = Rig()
    rig.run()
    flood(rig, 70)
    rig.say(long(ARM, 1.0))
    rig.say(long(RETURN))
    rig.run(0.02)
    assert {"arm", "set_mode"} <= rig.outputs.keys() and len(rig.outputs["order"]["plane"]) == 8
    rig.run(0.04)
    assert [(m.command, m.result) for m in of(rig.heard(), "COMMAND_ACK")] == [(ARM, 0), (RETURN, 0)]


def test_what_makes_a_vehicle_safe_passes_whatever_else_one_asks():
    rig = Rig(answers=False)
    rig.run()
    for k in range(20):
        rig.say(long(SPEED, 0.0, 10.0 + k))
    rig.say(long(RETURN))
    rig.say(long(ARM, 0.0))
    rig.run(0.02)
    assert len(rig.outputs["order"]["plane"]) == 8 and {"arm", "set_mode"} <= rig.outputs.keys()


def test_strangers_at_many_ports_leave_room_for_who_has_asked_nothing_yet():
    rig = Rig(answers=False)
    rig.run()
    for port in range(30):
        for k in range(8):
            rig.say(long(SPEED, 0.0, 10.0 + k), system=200, peer=("203.0.113.9", 3000 + port))
    rig.say(long(ARM, 1.0))
    rig.run(0.02)
    assert "arm" in rig.outputs and len(rig.outputs["order"]["plane"]) < 100


def test_a_file_of_parameters_sent_at_once_is_set_as_a_whole():
    rig = Rig()
    rig.run()
    names = [p.name for p in rig.service._vehicles["plane"]._parameters.table if p.name.startswith("ROLL_")]
    values = [(name, 1.0 + 1e-3 * n) for n in range(30) for name in names[:1]]
    for name, value in values:
        rig.say(mav.MAVLink_param_set_message(PLANE, 1, name.encode(), value, 9))
    heard = rig.run(1.0)
    assert len([m for m in of(heard, "PARAM_VALUE") if m.param_id == names[0]]) >= 30 and not of(heard, "PARAM_ERROR")


def test_texts_of_a_refusal_go_to_the_asker_alone():
    rig = Rig()
    rig.plane.refuse |= dict.fromkeys(("set_mode", "set_mission", "arm", "goal", "set_current"), "no")
    rig.run(2.0)
    for message in (
        mav.MAVLink_set_mode_message(PLANE, 1, 77),
        mav.MAVLink_set_mode_message(PLANE, 1, 84148224),
        mav.MAVLink_mission_set_current_message(PLANE, 1, 4),
        mav.MAVLink_set_position_target_local_ned_message(0, PLANE, 1, 1, 0b110111111000, 0, 0, -80, 0, 0, 0, 0, 0, 0, 0, 0),
        long(ARM, 1.0),
        long(ARM, 2.0),
        count(501),
        item(0, current=2),
    ):
        rig.say(message, **STRANGER)
        refused = []
        for _ in range(75):
            rig.run(0.02)
            refused += [text for text in texts(rig.heard(STRANGER["peer"])) if "simulated" not in text]
            assert not texts(rig.heard(GCS)) and not texts(rig.heard(OTHER))
        assert len(refused) == 1, message


def refusals(rig, seconds, each_step):
    """Texts that the asker got in a while of asking for modes that do not exist, some in each step."""
    heard = []
    for step in range(round(seconds / 0.02)):
        for k in range(each_step):
            rig.say(mav.MAVLink_set_mode_message(PLANE, 1, 1000 * step + k + 1))
        rig.run(0.02)
        heard += texts(rig.heard())
    return [text for text in heard if "simulated" not in text]


def test_a_flood_of_texts_is_left_out_and_said_in_one_line():
    rig = Rig()
    rig.say(BEAT)
    rig.run(2.0)
    flooded = refusals(rig, 1.0, 40)
    assert 50 <= len(flooded) <= 72
    after = refusals(rig, 4.0, 0)
    assert after == [f"{2000 - len(flooded)} texts left out"]


def test_what_is_critical_is_never_left_out():
    rig = Rig()
    rig.run(2.0)
    refusals(rig, 1.0, 40)
    rig.events = {"plane": [Event(severity=Event.CRITICAL, text="motor failed", timestamp=stamp(rig.t))]}
    assert "motor failed" in texts(rig.run(0.02))
