"""Packets that nobody may obey, of every kind that a bad link or a bad neighbour makes; by hand: ``python -m <this> 1000000``."""

import random
import sys
import time

from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, ROVER, Rig, long
from uvf.mavlink import dialect as mav

AT_ONCE = 500  # datagrams in a step
NOBODY = 99
STRANGER = ("203.0.113.7", 9)

_SENDER = mav.MAVLink(None, 255, 190)
ARM = {system: long(400, 1.0, system=system).pack(_SENDER) for system in (PLANE, ROVER, NOBODY)}
ORDERS = [
    *ARM.values(),
    mav.MAVLink_set_mode_message(PLANE, 1, 50593792).pack(_SENDER),
    mav.MAVLink_mission_count_message(PLANE, 1, 3, 0).pack(_SENDER),
    mav.MAVLink_manual_control_message(PLANE, 0, 0, 500, 0, 0).pack(_SENDER),
]
BEAT = mav.MAVLink_heartbeat_message(6, 8, 0, 0, 0, 3)


def noise(rng):
    return rng.randbytes(rng.randrange(300))


def noise_that_begins_well(rng):
    return bytes((rng.choice((mav.PROTOCOL_MARKER_V1, mav.PROTOCOL_MARKER_V2)),)) + rng.randbytes(rng.randrange(300))


def truncated(rng):
    order = rng.choice(ORDERS)
    return order[: rng.randrange(len(order))]


def broken(rng):
    """One to three bits fallen over, somewhere after the marker: the checksum does not fit."""
    data = bytearray(rng.choice(ORDERS))
    for bit in rng.sample(range(8, 8 * len(data)), rng.randrange(1, 4)):
        data[bit // 8] ^= 1 << bit % 8
    return bytes(data)


def foreign(rng):
    """Of another dialect: a number that ours has not, or one whose definition has another checksum."""
    number = rng.choice((rng.randrange(20_000, 2**24), mav.MAVLINK_MSG_ID_COMMAND_LONG))
    payload = rng.randbytes(rng.randrange(1, 60))
    head = bytes((0xFD, len(payload), 0, 0, 0, 255, 190)) + number.to_bytes(3, "little")
    extra = mav.MAVLink_command_long_message.crc_extra ^ rng.randrange(1, 256)
    crc = mav.x25crc(head[1:] + payload + bytes((extra,))).crc
    return head + payload + crc.to_bytes(2, "little")


def for_another(rng):
    """A sound order for a system or component that is not here."""
    order = long(400, 1.0, system=NOBODY) if rng.random() < 0.5 else long(400, 1.0, system=PLANE, component=rng.randrange(2, 256))
    return order.pack(_SENDER)


def from_one_of_us(rng):
    """Orders under our own numbers are our own packets that come back."""
    return long(400, 1.0).pack(mav.MAVLink(None, rng.choice((PLANE, ROVER)), 1))


def of_version_1(rng):
    message = BEAT if rng.random() < 0.5 else long(400, 1.0, system=NOBODY)
    return message.pack(_SENDER, force_mavlink1=True)


KINDS = (noise, noise_that_begins_well, truncated, broken, foreign, for_another, from_one_of_us, of_version_1)


def rage(rig, rng, count):
    """Throws so many datagrams at a rig, of all kinds in turn and from several addresses."""
    for _ in range(count // AT_ONCE):
        rig.link.incoming += [(rng.choice(KINDS)(rng), rng.choice((GCS, OTHER, STRANGER))) for _ in range(AT_ONCE)]
        rig.run(0.02)


if __name__ == "__main__":
    stage, wanted = Rig(), int(sys.argv[1])
    begun = time.process_time()
    rage(stage, random.Random(1), wanted)
    taken, asked = time.process_time() - begun, stage.plane.asked + stage.rover.asked
    sys.stdout.write(f"{wanted} datagrams, {taken:.1f} s, asked: {asked}, {stage.service.codec.counts}\n")
