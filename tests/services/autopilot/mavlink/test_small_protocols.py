"""Texts in chunks, sticks, file transfer, ping, time, logs: one small protocol each."""

import pytest

from schemas.messages import Mode
from services.autopilot.mavlink.connection.statustext import TextLimiter, chunks
from services.autopilot.mavlink.telemetry.streams import Schedule
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, ROVER, Rig, of, texts
from uvf.mavlink import dialect as mav
from uvf.models.vehicle.air import CommandProperties


@pytest.mark.parametrize("n", [1, 49, 50, 51, 99, 100, 101, 240])
def test_texts_of_every_length_come_together_again(n):
    text = "".join(chr(ord("a") + i % 26) for i in range(n))
    parts = chunks(4, text, 9)
    wire = mav.MAVLink(None)
    received = [wire.parse_buffer(part.pack(mav.MAVLink(None)))[0] for part in parts]
    assert texts(received) == [text]
    assert all(len(part.text) <= 50 for part in received)


def test_the_same_text_waits_ten_seconds():
    limiter = TextLimiter()
    assert [limiter.admits(t, "x") for t in (0.0, 5.0, 9.9, 10.0, 10.1)] == [True, False, False, True, False]
    assert limiter.admits(5.0, "y")


def test_chunk_numbers_are_never_zero():
    limiter = TextLimiter()
    assert 0 not in {limiter.next_id() for _ in range(70_000)}


def test_a_late_schedule_does_not_catch_up_in_a_burst():
    schedule = Schedule({1: 10.0})
    assert schedule.due(0.0, [GCS]) == [(1, [GCS])]
    times = [t for t in (5.0, 5.02, 5.04, 5.06, 5.08, 5.1) if schedule.due(t, [GCS])]
    assert times == [5.0, 5.1]


def test_wishes_of_a_peer_end_with_it():
    schedule = Schedule({1: 10.0})
    schedule.set_interval(1, OTHER, -1.0)
    assert schedule.interval(1, OTHER) is None
    schedule.forget([GCS])
    assert schedule.interval(1, OTHER) == 0.1
    assert not schedule.set_interval(99, OTHER, 1.0)


def sticks(system, **axes):
    return mav.MAVLink_manual_control_message(system, **{"x": 0, "y": 0, "z": 0, "r": 0, "buttons": 0, **axes})


def drive(rig):
    rig.run(0.02)
    return rig.outputs.get("drive", {})


def test_sticks_drive_a_rover_in_manual_mode():
    rig = Rig()
    rig.rover.status.mode = Mode.MODE_MANUAL
    rig.run()
    rig.say(sticks(ROVER, z=500, r=1000))
    command = drive(rig)["rover"]
    assert (command.linear, command.angular) == (0.25, -2.0)
    rig.say(sticks(ROVER, z=-1000, y=-250))
    command = drive(rig)["rover"]
    assert (command.linear, command.angular) == (-0.5, 0.5)
    assert drive(rig) == {}


@pytest.mark.parametrize("message", [sticks(ROVER, z=32767), sticks(PLANE, z=32767), sticks(77, z=500)])
def test_sticks_that_mean_nobody_drive_nobody(message):
    rig = Rig()
    for vehicle in (rig.rover, rig.plane):
        vehicle.status.mode = Mode.MODE_MANUAL
    rig.run()
    rig.say(message)
    assert drive(rig) == {}
    assert rig.outputs.get("surfaces", {}) == {}


def test_sticks_move_the_surfaces_of_an_aircraft_in_manual_mode_within_its_limits():
    rig = Rig()
    rig.plane.status.mode = Mode.MODE_MANUAL
    rig.run()
    rig.say(sticks(PLANE, x=500, y=1000, z=700, r=-32768))
    rig.run(0.02)
    (command,) = rig.outputs["surfaces"].values()
    limits = CommandProperties()  # the file of the rig's aircraft names none
    assert command.elevator == 0.5 * limits.elevator.limit  # stick forward: trailing edge down, the nose goes down
    assert command.aileron == limits.aileron.limit  # right: rolls right
    assert command.rudder == limits.rudder.limit  # left: yaws left
    assert command.throttle == 0.7
    rig.say(sticks(PLANE, y=32767, r=32767, z=-200))
    rig.run(0.02)
    (command,) = rig.outputs["surfaces"].values()
    assert (command.aileron, command.rudder, command.throttle) == (0.0, 0.0, 0.0)


def test_sticks_at_rest_do_not_disturb_a_mission():
    rig = Rig()
    rig.rover.status.mode = Mode.MODE_MISSION
    rig.run()
    rig.say(sticks(ROVER))
    assert drive(rig) == {}


def test_ping_timesync_and_log_list_are_answered():
    rig = Rig()
    rig.say(mav.MAVLink_ping_message(123, 4, 0, 0))
    rig.say(mav.MAVLink_timesync_message(0, 987654321))
    rig.say(mav.MAVLink_log_request_list_message(PLANE, 1, 0, 0xFFFF))
    heard = rig.run(0.04)
    assert {(m.time_usec, m.seq, m.target_system) for m in of(heard, "PING")} == {(123, 4, 255)}
    assert {m.ts1 for m in of(heard, "TIMESYNC")} == {987654321}
    assert [m.num_logs for m in of(heard, "LOG_ENTRY")] == [0]


def test_an_answered_ping_is_not_answered_again():
    rig = Rig()
    rig.say(mav.MAVLink_ping_message(123, 4, PLANE, 1))
    assert not of(rig.run(), "PING")
