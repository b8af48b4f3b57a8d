"""A hostile MAVLink client against the link, the real autopilot and JSBSim.

By hand: ``python -m tests.hostile.mavlink_client SECONDS [SEED]``.
Every message of the dialect in any order, each field at the ends of its type, frames that are broken, many addresses and numbers. Its dice
are those of ``random`` or of hypothesis.
"""

import random
import struct
import sys
import time
from collections import Counter

from tests.services.autopilot.mavlink.airborne import Airborne
from tests.services.autopilot.mavlink.rig import GCS, long
from tests.services.autopilot.mavlink.station_in_flight import in_the_air
from tests.services.autopilot.mavlink.test_two_stations import sizes
from uvf.mavlink import dialect as mav
from uvf.mavlink.codec import Codec

OURS = 1
ANSWERED_WITHIN = 6.0  # s, three questions of 1.9 s to the autopilot, one after the other
TO_ONE, TO_ALL = 0.8, 0.1
WHOLE = {"b": 8, "B": 8, "h": 16, "H": 16, "i": 32, "I": 32, "q": 64, "Q": 64}
FLOATS = [float("nan"), float("inf"), float("-inf"), 0.0, -0.0, 1.0, -1.0, 2.0, 1e30, -1e30, 3.4e38, 1e-45, 90.5, 400.0, 5e7]
NUMBERS = sorted(mav.enums["MAV_CMD"])
KINDS = [kind for number, kind in sorted(mav.mavlink_map.items()) if number >= 0]
COMMANDS = (mav.MAVLINK_MSG_ID_COMMAND_LONG, mav.MAVLINK_MSG_ID_COMMAND_INT)
_EAR = (*COMMANDS, 4, 11, 20, 21, 23, *range(38, 48), 48, 51, 69, 70, 73, 82, 84, 86, 110, 111, 117, 119, 126, 243, 256)
SPOKEN = [mav.mavlink_map[number] for number in _EAR if number in mav.mavlink_map]
"""Those that the link has an ear for."""
NAMES = [b"_HASH_CHECK", b"NAV_LOITER_RAD", b"BAT_LOW_THR", b"SYS_AUTOSTART", b"", b"\xff" * 16, b"NAV_DLL_ACT"]
ACKNOWLEDGEMENT = mav.MAVLINK_MSG_ID_COMMAND_ACK.to_bytes(3, "little")
STRANGERS = [("203.0.113.7", 9), ("127.0.0.1", 1), *(("203.0.113.8", 1000 + n) for n in range(200))]
ASKERS = [("203.0.113.9", 2000 + n) for n in range(4)]
"""Addresses whose commands are counted: they set no signing up, after which unsigned ones are refused."""


def _whole(dice, code):
    bits, signed = WHOLE[code], code.islower()
    low, high = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
    return dice.choice((low, high, 0, 1, 2, 3, high - 1, dice.randrange(low, high + 1)))


def _field(dice, name, code, count):
    """The bytes of one field."""
    if code == "c":
        return (dice.choice(NAMES) if dice.random() < 0.7 else bytes(dice.randrange(256) for _ in range(4))).ljust(count, b"\0")[:count]
    if code in "fd":
        return struct.pack(f"<{count}{code}", *(dice.choice(FLOATS) for _ in range(count)))
    values = [_whole(dice, code) for _ in range(min(count, 4))]
    if name in ("target_system", "target") and dice.random() < TO_ONE + TO_ALL:
        values = [OURS if dice.random() < TO_ONE else 0]
    elif name == "target_component" and dice.random() < TO_ONE + TO_ALL:
        values = [1 if dice.random() < TO_ONE else 0]
    elif name == "command" and dice.random() < 0.9:
        values = [dice.choice(NUMBERS)]
    elif name in ("mission_type", "seq", "count", "start_index", "frame") and dice.random() < 0.8:
        values = [dice.choice((0, 1, 2, 3, 5, 6))]
    return struct.pack(f"<{count}{code}", *(values * count)[:count])


def payload(dice, kind):
    codes = bytes(kind.native_format).decode().lstrip("<")
    counts = [length or 1 for length in kind.array_lengths]
    return b"".join(_field(dice, *one) for one in zip(kind.ordered_fieldnames, codes, counts, strict=True))


def framed(kind, content, system, component):
    blank = kind.__new__(kind)
    mav.MAVLink_message.__init__(blank, kind.id, kind.msgname)
    return bytes(blank._pack(mav.MAVLink(None, system, component), kind.crc_extra, content))


def spoilt(dice, packet):
    """Truncated, too long, with bits fallen over, flags of another kind, twice, or as it was."""
    what, at = dice.randrange(8), dice.randrange(len(packet))
    if what == 0:
        return packet[:at]
    if what == 1:
        return packet + bytes(dice.randrange(256) for _ in range(20))
    if what == 2:
        return packet[:at] + bytes((packet[at] ^ 1 << dice.randrange(8),)) + packet[at + 1 :]
    if what == 3:
        return packet[:2] + bytes((dice.randrange(256),)) + packet[3:]
    if what == 4:
        return packet[at:] + packet[:at]
    return packet * 2 if what == 5 else b"\xfd" * 300 if what == 6 else packet[:1] + b"\xff" + packet[2:]


class Hostile(Airborne):
    """Throws packets at the link of an aircraft in the air, counts the answers, and asks what a good station asks."""

    def __init__(self):
        super().__init__(in_the_air())
        self.sent = 0
        self.open = {}
        """Commands that wait for their answer: (address, system, component, number) -> since when [s]."""
        self.answers = Counter()
        self._answered = set()
        self._asked = 0
        self._codec = Codec()

    def burst(self, dice, count):
        """Some packets in one step, then a good station's question."""
        for _ in range(count):
            self.sent += 1
            if dice.random() < 0.25:
                self._command(dice)
            else:
                self._anything(dice)
        self._good_question()
        self._check()

    def _anything(self, dice):
        kind = dice.choice(SPOKEN if dice.random() < 0.6 else KINDS)
        system, component = dice.choice((255, 255, 0, 1, 245, dice.randrange(256))), dice.choice((190, 0, 1, dice.randrange(256)))
        content = payload(dice, kind)
        packet = framed(kind, content, system, component)
        peer = dice.choice(STRANGERS if dice.random() < 0.5 or kind.id == mav.MAVLINK_MSG_ID_SETUP_SIGNING else [*ASKERS, GCS])
        if peer == GCS:
            packet = framed(kind, content, 254, component)  # not under the good station's own number
        self.link.incoming.append((spoilt(dice, packet) if dice.random() < 0.2 else packet, peer))

    def _command(self, dice):
        """Under numbers of its own, so that it is no repetition; its one answer is counted."""
        kind = mav.mavlink_map[dice.choice(COMMANDS)]
        self._asked += 1
        peer, system, component = dice.choice(ASKERS), 3 + self._asked % 240, 2 + self._asked // 240 % 250
        content = bytearray(payload(dice, kind))
        message = self._codec.parse(framed(kind, bytes(content), system, component))[0]
        message.target_system, message.target_component = OURS, dice.choice((0, 1))
        self.open[peer, system, component, message.command] = self.t
        self._answered.discard((peer, system, component, message.command))
        self.link.incoming.append((message.pack(mav.MAVLink(None, system, component)), peer))

    def _good_question(self):
        self.say(long(512, 148.0, confirmation=self.sent % 200))
        assert self.hears("COMMAND_ACK", 0.2, lambda m: (m.command, m.target_system) == (512, 255))[1].result == mav.MAV_RESULT_ACCEPTED
        self.heard.clear()

    def _check(self):
        late = [who for who, since in self.open.items() if self.t - since > ANSWERED_WITHIN]
        assert late == [], "no answer to these commands"
        most = {"links": 2 + 32, "stations": 64, "keys": 600, "commands": 64 * 32, "files": 96, "lists": 34, "texts": 256, "plans": 64}
        assert {what: n for what, n in sizes(self.service, self.link, self.t).items() if n > most.get(what, 1500)} == {}

    def end(self):
        """Time for the last answers; the link still beats."""
        self.fly(ANSWERED_WITHIN + 0.5, step=0.5)
        self._check()
        assert self.open == {} and any(m.get_type() == "HEARTBEAT" for _, m in self.heard)

    def _hear(self, t):
        """Answers to commands, each the only one."""
        super()._hear(t)
        for data, peer in self.link.outgoing:
            if data[7:10] != ACKNOWLEDGEMENT or peer not in ASKERS:
                continue
            (ack,) = self._codec.parse(data)
            who = (peer, ack.target_system, ack.target_component, ack.command)
            if who in self.open:
                del self.open[who]
                self.answers[ack.result] += 1
                self._answered.add(who)
            else:
                assert who not in self._answered, f"a second answer to {who}"


if __name__ == "__main__":
    seconds, seed = float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    chance, client = random.Random(seed), Hostile()
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        client.burst(chance, chance.choice((1, 10, 60, 300)))
    client.end()
    sys.stdout.write(f"{client.sent} packets, {client.t:.0f} s of flight, answers to commands: {dict(client.answers)}\n")
