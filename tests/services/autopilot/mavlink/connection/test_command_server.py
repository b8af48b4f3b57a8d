"""Commands: one final acknowledgement each, what they ask of the autopilot, and why it refused."""

import math

import pytest

from schemas.messages import Clock, Mode, StopEngagement
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, ROVER, Rig, acks, long, of, texts
from uvf.mavlink import dialect as mav

NAN = math.nan
ACCEPTED, REJECTED, DENIED, UNSUPPORTED = 0, 1, 2, 3


def test_arming_is_acknowledged_within_100_ms_and_shows_in_a_heartbeat_at_once():
    rig = Rig()
    rig.run(0.5)
    rig.say(long(400, 1.0))
    heard = rig.run(0.1)
    assert acks(heard) == [(400, ACCEPTED)]
    assert of(heard, "HEARTBEAT", PLANE)[-1].base_mode & mav.MAV_MODE_FLAG_SAFETY_ARMED


def test_a_refused_arming_says_why():
    rig = Rig()
    rig.plane.refuse["arm"] = "no airspeed"
    rig.say(long(400, 1.0))
    heard = rig.run()
    assert acks(heard) == [(400, REJECTED)]
    assert "Arming denied: no airspeed" in texts(heard)
    assert not rig.plane.status.armed


def test_force_is_passed_on():
    rig = Rig()
    rig.say(long(400, 1.0, 2989.0))
    rig.run()
    assert [r.force for _, r in rig.plane.asked] == [True]


def test_acknowledgements_go_to_the_asker_only():
    rig = Rig()
    rig.say(long(400, 1.0))
    rig.run()
    assert of(rig.heard(GCS), "COMMAND_ACK") and not of(rig.heard(OTHER), "COMMAND_ACK")


@pytest.mark.parametrize(
    ("command", "mode"),
    [
        (long(176, 129.0, 4.0, 3.0), Mode.MODE_HOLD),
        (long(176, 1.0, 4.0, 5.0), Mode.MODE_RETURN),
        (long(176, 1.0, 67371008.0), Mode.MODE_MISSION),
        (long(176, 157.0, 1.0), Mode.MODE_MANUAL),
        (long(20), Mode.MODE_RETURN),
        (long(21), Mode.MODE_LAND),
        (long(22), Mode.MODE_TAKEOFF),
        (long(193, 0.0), Mode.MODE_HOLD),
        (long(193, 1.0), Mode.MODE_MISSION),
        (long(192, -1.0, 1.0, 0.0), Mode.MODE_HOLD),
        (long(300, 0.0, 0.0), Mode.MODE_MISSION),
    ],
)
def test_modes_by_command(command, mode):
    rig = Rig()
    rig.say(command)
    assert acks(rig.run()) == [(command.command, ACCEPTED)]
    assert [r.mode for _, r in rig.plane.asked] == [mode]


def test_set_mode_is_answered_by_a_heartbeat_and_a_refusal_by_words():
    rig = Rig()
    rig.run(0.5)
    rig.say(mav.MAVLink_set_mode_message(PLANE, 157, 67371008))
    assert of(rig.run(), "HEARTBEAT", PLANE)[-1].custom_mode == 67371008
    rig.plane.refuse["set_mode"] = "no home"
    rig.say(mav.MAVLink_set_mode_message(PLANE, 157, 84148224))
    heard = rig.run()
    assert "Mode Return refused: no home" in texts(heard)
    assert not of(heard, "HEARTBEAT", PLANE)
    rig.say(mav.MAVLink_set_mode_message(PLANE, 157, 10))
    assert any("There is no mode" in text for text in texts(rig.run()))


def test_go_to_takes_altitudes_above_sea_level_and_above_home():
    rig = Rig()
    rig.run()
    x, y = 407_700_000, 147_900_000
    rig.say(mav.MAVLink_command_int_message(PLANE, 1, 0, 192, 0, 0, -1, 1, 0, NAN, x, y, 400.0))
    rig.say(mav.MAVLink_command_int_message(PLANE, 1, 6, 192, 0, 0, -1, 1, 0, NAN, x, y, 50.0), component=191)
    rig.run()
    absolute, relative = (r.position for _, r in rig.plane.asked)
    assert (absolute.x, absolute.y) == pytest.approx((0.0, 0.0), abs=0.02)
    assert absolute.z == pytest.approx(100.0)
    assert relative.z == pytest.approx(70.0)


def test_a_rover_is_put_into_mission_mode_before_it_is_sent_somewhere():
    rig = Rig()
    rig.run()
    rig.say(long(192, -1.0, 1.0, 0.0, NAN, 40.77, 14.79, NAN, system=ROVER))
    assert acks(rig.run(0.2)) == [(192, ACCEPTED)]
    assert [name for name, _ in rig.rover.asked] == ["set_mode", "goal"]
    assert rig.rover.status.mode == Mode.MODE_MISSION


def test_where_a_rover_cannot_be_sent_it_goes_back_to_its_mode():
    rig = Rig()
    rig.run()
    rig.rover.refuse["goal"] = "there is a wall"
    rig.say(long(192, -1.0, 1.0, 0.0, NAN, 40.77, 14.79, NAN, system=ROVER))
    assert acks(rig.run(0.2)) == [(192, REJECTED)]
    assert [name for name, _ in rig.rover.asked] == ["set_mode", "goal", "set_mode"]
    assert rig.rover.status.mode == Mode.MODE_HOLD


def test_without_leave_to_change_the_mode_it_is_not_changed():
    rig = Rig()
    rig.run()
    rig.say(long(192, -1.0, 0.0, 0.0, NAN, 40.77, 14.79, NAN, system=ROVER))
    heard = rig.run(0.2)
    assert acks(heard) == [(192, DENIED)]
    assert "Go to refused: the mode is Hold, and the command may not change it" in texts(heard)
    assert rig.rover.asked == []


@pytest.mark.parametrize(
    ("command", "result"),
    [
        (long(192, -1.0, 1.0, 0.0, NAN, 95.0, 14.0, 400.0), DENIED),
        (long(192, -1.0, 1.0, 0.0, NAN, 40.77, 14.79, 1e8), DENIED),
        (long(192, -1.0, 1.0, 0.0, NAN, math.inf, 14.0, 400.0), DENIED),
        (long(400, 1e30), DENIED),
        (long(400, 0.5), DENIED),
        (long(400), DENIED),
        (long(176, 1.0, 9.0, 9.0), DENIED),
        (long(176), DENIED),
        (long(224), DENIED),
        (long(241, 1.0), UNSUPPORTED),
        (long(44999), UNSUPPORTED),
    ],
)
def test_nonsense_reaches_no_autopilot(command, result):
    rig = Rig()
    rig.run()
    rig.say(command)
    heard = rig.run()
    assert acks(heard) == [(command.command, result)]
    assert rig.plane.asked == []
    assert (result == UNSUPPORTED) or texts(heard)


def test_every_command_number_with_every_parameter_nan_gets_one_answer():
    rig = Rig()
    rig.run()
    numbers = range(0, 45000, 97)
    for number in numbers:
        rig.say(long(number))
    answers = acks(rig.run(0.2))
    assert sorted(number for number, _ in answers) == list(numbers)


def test_a_repetition_is_executed_once():
    rig = Rig()
    rig.say(long(400, 1.0))
    rig.say(long(400, 1.0, confirmation=1))
    assert acks(rig.run()) == [(400, ACCEPTED)], "no 'in progress', which MAVSDK takes for a refusal"
    rig.say(long(400, 1.0, confirmation=2))
    assert acks(rig.run()) == [(400, ACCEPTED)]
    assert len(rig.plane.asked) == 1


def test_commands_for_others_are_ignored():
    rig = Rig()
    rig.say(long(400, 1.0, system=77))
    rig.say(long(400, 1.0, component=100))
    rig.say(long(400, 1.0), system=PLANE)
    assert acks(rig.run()) == []
    assert rig.plane.asked == rig.rover.asked == []


def test_a_broadcast_reaches_every_vehicle():
    rig = Rig()
    rig.say(long(400, 1.0, system=0))
    assert acks(rig.run()) == [(400, ACCEPTED)] * 2
    assert rig.plane.status.armed and rig.rover.status.armed


def test_without_an_answer_the_command_ends_all_the_same():
    rig = Rig(answers=False)
    rig.say(long(400, 1.0))
    assert acks(rig.run(1.5)) == []
    heard = rig.run(1.0)
    assert acks(heard) == [(400, REJECTED)]
    assert "Arming denied: the autopilot did not answer" in texts(heard)


def test_in_a_pause_commands_are_refused_at_once():
    rig = Rig()
    rig.run()
    rig.clock.state = Clock.PAUSED
    rig.say(long(400, 1.0))
    heard = rig.run()
    assert acks(heard) == [(400, REJECTED)]
    assert "Arming denied: the simulation is paused" in texts(heard)


def test_a_requested_message_follows_its_acknowledgement():
    rig = Rig()
    rig.run(0.5)
    for number in (148, 300, 242, 245):
        rig.say(long(512, float(number)))
    kinds = [m.get_type() for m in rig.run() if m.get_srcSystem() == PLANE]
    for name in ("AUTOPILOT_VERSION", "PROTOCOL_VERSION", "HOME_POSITION", "EXTENDED_SYS_STATE"):
        assert kinds[kinds.index(name) - 1] == "COMMAND_ACK"
    rig.say(long(512, 395.0))
    assert acks(rig.run()) == [(512, UNSUPPORTED)]


def test_message_intervals_hold_for_the_peer_that_asked():
    rig = Rig()
    rig.run()
    rig.say(long(511, 245.0, 100_000.0))
    rig.say(long(511, 30.0, -1.0))
    rig.say(long(510, 245.0))
    assert of(rig.run(), "MESSAGE_INTERVAL")[0].interval_us == 100_000
    rig.run(2.0)
    mine, others = (rig.heard(peer) for peer in (GCS, OTHER))
    assert len(of(mine, "EXTENDED_SYS_STATE", PLANE)) in (19, 20, 21)
    assert len(of(others, "EXTENDED_SYS_STATE", PLANE)) == 2
    assert not of(mine, "ATTITUDE", PLANE) and len(of(others, "ATTITUDE", PLANE)) in (39, 40, 41)
    rig.say(long(511, 30.0, 0.0))
    assert of(rig.run(1.0), "ATTITUDE", PLANE)


def test_set_waypoint_is_seen_in_mission_current_at_once():
    rig = Rig()
    rig.plane.progress.total, rig.plane.progress.state = 5, 2
    rig.run(0.5)
    rig.say(long(224, 3.0))
    heard = rig.run()
    assert acks(heard) == [(224, ACCEPTED)]
    assert of(heard, "MISSION_CURRENT", PLANE)[0].seq == 3


def test_prearm_checks_name_the_reasons():
    rig = Rig()
    rig.run(0.5)
    rig.plane.status.stopped = True
    rig.plane.status.stops.extend([StopEngagement(source="gcs", reason="button")])
    assert "PreArm: STOP ALL is engaged by gcs (button)" in texts(rig.run())
    bit = mav.MAV_SYS_STATUS_PREARM_CHECK
    status = of(rig.run(1.1), "SYS_STATUS", PLANE)[-1]
    assert status.onboard_control_sensors_enabled & bit and not status.onboard_control_sensors_health & bit


def test_a_confirmation_that_does_not_count_up_is_a_new_command():
    rig = Rig()
    rig.say(long(20, confirmation=1))
    assert acks(rig.run()) == [(20, ACCEPTED)] and rig.plane.status.mode == Mode.MODE_RETURN
    rig.plane.status.mode = Mode.MODE_MANUAL
    rig.say(long(20, confirmation=1))
    assert acks(rig.run()) == [(20, ACCEPTED)] and rig.plane.status.mode == Mode.MODE_RETURN


def test_nobody_repeats_a_command_after_many_seconds():
    rig = Rig()
    rig.say(long(20))
    rig.run(5.5)
    rig.plane.status.mode = Mode.MODE_MANUAL
    rig.say(long(20, confirmation=1))
    assert acks(rig.run()) == [(20, ACCEPTED)] and rig.plane.status.mode == Mode.MODE_RETURN


def test_repetitions_three_seconds_apart_are_executed_once():
    rig = Rig()
    for confirmation in range(4):
        rig.say(long(400, 1.0, confirmation=confirmation))
        assert acks(rig.run(3.0)) == [(400, ACCEPTED)]
    assert len(rig.plane.asked) == 1
