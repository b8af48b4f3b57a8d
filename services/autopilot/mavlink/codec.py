"""Bytes to MAVLink messages and back: framing, checksums, sequence numbers, and what was wrong, counted."""

import struct
from collections import defaultdict
from dataclasses import dataclass

from services.autopilot.mavlink import dialect as mav

AUTOPILOT = mav.MAV_COMP_ID_AUTOPILOT1


@dataclass
class Counts:
    received: int = 0
    broken: int = 0
    """Bytes that are no packet, or one with a wrong checksum or flags."""
    unknown: int = 0
    """Sound frames of messages that the dialect does not have."""
    unsendable: int = 0
    """Own messages with a number that does not fit its field."""


class Codec:
    """All systems behind one link."""

    def __init__(self) -> None:
        self.counts = Counts()
        self._mav = mav.MAVLink(None, srcComponent=AUTOPILOT)
        self._mav.robust_parsing = True
        self._seq: defaultdict[int, int] = defaultdict(int)

    def pack(self, system: int, message: mav.MAVLink_message) -> bytes:
        """One MAVLink 2 packet from a system's autopilot; empty when a number does not fit."""
        self._mav.srcSystem = system
        self._mav.seq = self._seq[system]
        try:
            packet: bytes = message.pack(self._mav)
        except (struct.error, OverflowError):
            self.counts.unsendable += 1
            return b""
        self._seq[system] = (self._seq[system] + 1) % 256
        return packet

    def parse(self, datagram: bytes) -> list[mav.MAVLink_message]:
        """The messages of a datagram. A packet never spans two, so a broken one spoils nothing after it."""
        self._mav.buf, self._mav.buf_index, self._mav.expected_length = bytearray(), 0, mav.HEADER_LEN_V1 + 2
        good = []
        for message in self._mav.parse_buffer(datagram) or ():
            if isinstance(message, mav.MAVLink_bad_data):
                self.counts.broken += 1
            elif isinstance(message, mav.MAVLink_unknown):
                self.counts.unknown += 1
            else:
                self.counts.received += 1
                good.append(message)
        return good
