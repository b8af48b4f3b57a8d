"""Rubbish on the link: counted, never obeyed, never fatal."""

import itertools
import math
import random
from collections import Counter

import pytest

from schemas.messages import Clock, Mode
from services.autopilot.mavlink.commands.actions import ACTIONS
from services.autopilot.mavlink.commands.guided import GUIDED
from services.autopilot.mavlink.commands.orders import ORDERS
from services.autopilot.mavlink.telemetry.streams import Schedule
from tests.services.autopilot.mavlink.rig import GCS, PLANE, ROVER, Rig, acks, long, of
from tests.services.autopilot.mavlink.storm import KINDS, rage
from uvf.mavlink import dialect as mav
from uvf.mavlink.codec import Codec

BEAT = mav.MAVLink_heartbeat_message(6, 8, 0, 0, 0, 3)


def packet(message, mavlink1=False):
    return message.pack(mav.MAVLink(None, 255, 190), force_mavlink1=mavlink1)


def first(codec, message):
    """The packet to the only peer."""
    ((data, _),) = codec.packets(1, message, [(GCS, None)])
    return data


def test_a_broken_checksum_is_counted_and_the_next_packet_read():
    codec = Codec()
    good = packet(BEAT)
    bad = bytearray(good)
    bad[12] ^= 0xFF
    assert len(codec.parse(bytes(bad) + good)) == 1
    assert (codec.counts.broken, codec.counts.received) == (1, 1)


def test_half_a_packet_does_not_swallow_the_next_datagram():
    codec = Codec()
    assert codec.parse(packet(BEAT)[:9]) == []
    assert len(codec.parse(packet(BEAT))) == 1


def test_mavlink_1_is_understood_and_never_spoken():
    codec = Codec()
    assert len(codec.parse(packet(BEAT, mavlink1=True))) == 1
    assert first(codec, BEAT)[0] == mav.PROTOCOL_MARKER_V2


def test_foreign_messages_are_counted_as_unknown():
    foreign = mav.MAVLink_heartbeat_message(6, 8, 0, 0, 0, 3)
    foreign.get_header().msgId = 54321
    codec = Codec()
    assert codec.parse(packet(foreign)) == []
    assert codec.counts.unknown == 1


def test_a_number_that_does_not_fit_costs_no_sequence_number():
    codec = Codec()
    assert list(codec.packets(1, mav.MAVLink_heartbeat_message(300, 8, 0, 0, 0, 3), [(GCS, None)])) == []
    assert first(codec, BEAT)[4] == 0


@pytest.mark.parametrize("kind", KINDS)
def test_no_kind_of_bad_packet_is_obeyed(kind):
    rng, rig = random.Random(2), Rig()
    rig.run()
    rig.link.incoming += [(kind(rng), GCS) for _ in range(300)]
    heard = rig.run(0.1)
    assert rig.plane.asked == rig.rover.asked == [] and rig.outputs.get("drive") is rig.outputs.get("surfaces") is None
    assert not {m.get_type() for m in heard} & {"COMMAND_ACK", "MISSION_REQUEST_INT", "PARAM_VALUE"}
    rig.say(long(400, 1.0))
    assert acks(rig.run()) == [(400, 0)]


def test_100000_packets_stop_nothing_and_order_nothing():
    rig = Rig()
    rage(rig, random.Random(1), 100_000)
    counts = rig.service.codec.counts
    assert rig.plane.asked == rig.rover.asked == []
    assert counts.broken > 30_000 and counts.unknown > 5_000 and counts.received > 30_000
    rig.say(long(400, 1.0))
    heard = rig.run(1.1)
    assert acks(heard) == [(400, 0)] and of(heard, "HEARTBEAT", PLANE)


@pytest.mark.parametrize(("state", "rate"), [(Clock.PAUSED, 0.0), (Clock.RUNNING, 0.2), (Clock.RUNNING, 10.0)])
def test_heartbeats_answers_and_telemetry_follow_the_wall_however_time_runs(state, rate):
    rig = Rig()
    rig.run(1.0)
    rig.clock.state, rig.rate = state, rate
    beats, answered = [], 0
    for _ in range(500):
        rig.say(long(512, 148.0, confirmation=rig.n % 100))
        heard = rig.run(0.02)
        beats += [rig.t for _ in of(heard, "HEARTBEAT", PLANE)]
        answered += len(of(heard, "COMMAND_ACK"))
    assert len(beats) in (9, 10, 11) and max(b - a for a, b in itertools.pairwise(beats)) <= 1.5
    assert answered == 500


def random_message(rng, number):
    """A sound message of any kind whose fields hold random bytes, often addressed to the plane."""
    kind = mav.mavlink_map[number]
    fields = kind.unpacker.unpack(rng.randbytes(kind.unpacker.size))
    message = Codec().parse(_framed(kind, kind.unpacker.pack(*fields)))[0]
    for name, value in (("target_system", PLANE), ("target_component", 1)):
        if hasattr(message, name) and rng.random() < 0.8:
            setattr(message, name, value)
    return message


def _framed(kind, payload):
    blank = kind.__new__(kind)
    mav.MAVLink_message.__init__(blank, kind.id, kind.msgname)
    return blank._pack(mav.MAVLink(None, 255, 190), kind.crc_extra, payload)


@pytest.mark.parametrize("seed", range(4))
def test_sound_packets_with_random_contents_stop_nothing(seed):
    rng, rig = random.Random(seed), Rig()
    rig.run()
    numbers = [n for n in mav.mavlink_map if n >= 0]
    for _ in range(2000):
        message = random_message(rng, rng.choice(numbers))
        rig.say(message, system=rng.choice((0, 1, 255, 250)), component=rng.randrange(256))
        if rng.random() < 0.05:
            rig.run(0.02)
    assert rig.service.codec.counts.received > 1500
    assert of(rig.run(1.1), "HEARTBEAT", PLANE)


VALUES = (
    *[float("nan")] * 4,
    0.0,
    1.0,
    -1.0,
    -2.0,
    2.0,
    4.0,
    3.0,
    22.0,
    400.0,
    1e30,
    float("inf"),
    float("-inf"),
    50593792.0,
    90.5,
    435.0,
    2**31,
)
NUMBERS = sorted(mav.enums["MAV_CMD"])
MINE = sorted({*ACTIONS, *GUIDED, *ORDERS})
MOVES = {"arm": (400,), "goal": (192,), "orbit": (34,), "go_around": (191,), "set_current": (224, 300, 189)}
"""Which commands may lead to these requests."""


def random_command(rng):
    system, number = rng.choice((PLANE, ROVER)), rng.choice(MINE if rng.random() < 0.7 else NUMBERS)
    p = [rng.choice(VALUES) for _ in range(7)]
    if rng.random() < 0.5:
        return mav.MAVLink_command_long_message(system, 1, number, rng.randrange(3), *p)
    x, y = (rng.choice((0, 2**31 - 1, -(2**31), 407_700_000, 147_900_000)) for _ in range(2))
    return mav.MAVLink_command_int_message(system, 1, rng.choice((0, 3, 5, 6, 10, 255)), number, 0, 0, *p[:4], x, y, p[6])


@pytest.mark.parametrize("seed", range(5))
def test_2000_random_commands_get_one_final_answer_each_and_nothing_is_executed_that_was_not_asked_for(seed):
    rng, rig = random.Random(seed), Rig()
    rig.run()
    for vehicle in rig.service._vehicles.values():
        vehicle.schedule = Schedule({})  # no telemetry, which takes most of the time
    counts = Counter()
    for _ in range(2000):
        command = random_command(rng)
        for vehicle in (rig.plane, rig.rover):
            vehicle.asked.clear()
            vehicle.status.mode = rng.choice((Mode.MODE_HOLD, Mode.MODE_MISSION, Mode.MODE_ORBIT))
        rig.say(command)
        final = final_answers(rig)
        assert [m.command for m in final] == [command.command], command
        asked = [(name, request) for vehicle in (rig.plane, rig.rover) for name, request in vehicle.asked]
        for name, request in asked:
            assert command.command in MOVES.get(name, (command.command,)), command
            assert all(math.isfinite(value) for value in numbers_of(request)), command
        refused = final[0].result in (mav.MAV_RESULT_DENIED, mav.MAV_RESULT_UNSUPPORTED, mav.MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME)
        assert not (asked and refused), command
        counts.update(name for name, _ in asked)
    assert counts["order"] > 8 and counts["set_mode"] > 20


def final_answers(rig, steps=6):
    """Acknowledgements up to a step after the first one."""
    found = []
    for _ in range(steps):
        had = bool(found)
        found += of(rig.run(0.02), "COMMAND_ACK")
        if had:
            break
    return found


def numbers_of(message):
    """All the floating point numbers of a message but a heading, which may be left open."""
    for field, value in message.ListFields():
        if field.message_type is not None:
            yield from numbers_of(value)
        elif isinstance(value, float) and field.name != "yaw":
            yield value


def test_own_packets_that_come_back_are_not_obeyed():
    rig = Rig()
    rig.say(long(400, 1.0), system=PLANE, component=1)
    rig.run()
    assert rig.plane.asked == []
