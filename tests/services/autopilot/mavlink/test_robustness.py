"""Rubbish on the link: counted, never obeyed, never fatal."""

import random

import pytest

from services.autopilot.mavlink import dialect as mav
from services.autopilot.mavlink.codec import Codec
from tests.services.autopilot.mavlink.rig import GCS, PLANE, Rig, acks, long, of

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


def random_datagram(rng):
    kind = rng.randrange(4)
    data = bytearray(packet(long(400, 1.0)))
    if kind == 0:
        return rng.randbytes(rng.randrange(300))
    if kind == 1:
        return bytes(data[: rng.randrange(len(data))])
    if kind == 2:
        data[rng.randrange(1, len(data))] ^= rng.randrange(1, 256)
        return bytes(data)
    return bytes((mav.PROTOCOL_MARKER_V2,)) + rng.randbytes(rng.randrange(40))


def test_5000_random_packets_arm_nothing():
    rng, rig = random.Random(1), Rig()
    for _ in range(100):
        rig.link.incoming += [(random_datagram(rng), GCS) for _ in range(50)]
        rig.run(0.02)
    assert rig.plane.asked == rig.rover.asked == []
    assert rig.service.codec.counts.broken > 2000
    rig.say(long(400, 1.0))
    assert acks(rig.run()) == [(400, 0)]


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


@pytest.mark.parametrize("seed", range(4))
def test_commands_with_random_parameters_get_one_answer_each(seed):
    rng, rig = random.Random(seed), Rig()
    rig.run()
    values = (float("nan"), 0.0, 1.0, -1.0, 4.0, 3.0, 1e30, float("inf"), float("-inf"), 50593792.0, 90.5, 435.0, 2**31)
    numbers = (16, 20, 21, 22, 34, 176, 178, 179, 192, 193, 224, 241, 300, 400, 401, 410, 510, 511, 512, 519, 520)
    for _ in range(500):
        p = [rng.choice(values) for _ in range(7)]
        number = rng.choice(numbers)
        rig.say(long(number, *p))
        heard = rig.run(0.06)
        assert [m.command for m in of(heard, "COMMAND_ACK")] == [number], p


def test_own_packets_that_come_back_are_not_obeyed():
    rig = Rig()
    rig.say(long(400, 1.0), system=PLANE, component=1)
    rig.run()
    assert rig.plane.asked == []
