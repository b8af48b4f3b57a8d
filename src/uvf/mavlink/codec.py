"""Bytes to MAVLink messages and back: framing, checksums, sequence numbers, and what was wrong, counted."""

import struct
from collections import defaultdict
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from uvf.mavlink import dialect as mav
from uvf.mavlink.endpoint import Peer
from uvf.mavlink.framing import Sign, body, frame

AUTOPILOT = mav.MAV_COMP_ID_AUTOPILOT1


@dataclass
class LinkCounts:
    """Counts of messages on a link: received, and those that were broken, unknown or could not be sent."""

    received: int = 0
    broken: int = 0
    """Bytes that are no packet, or one with a wrong checksum or flags."""
    unknown: int = 0
    """Sound frames of messages that the dialect does not have."""
    unsendable: int = 0
    """Own messages with a number that does not fit its field."""


class Codec:
    """Encoder and decoder of all systems behind one link."""

    def __init__(self, component: int = AUTOPILOT) -> None:
        """component: that its systems speak as."""
        self._component = component
        self.counts = LinkCounts()
        self._mav = mav.MAVLink(None)
        self._mav.robust_parsing = True
        self._seq: defaultdict[tuple[int, Peer], int] = defaultdict(int)
        """The next number of each system to each peer: one who is told less than another misses nothing."""

    def packets(self, system: int, message: mav.MAVLink_message, to: Sequence[tuple[Peer, Sign | None]]) -> Iterator[tuple[bytes, Peer]]:
        """MAVLink 2 packets from a system, for each peer with its own sequence numbers; none when a number does not fit its field."""
        try:
            what = body(message)
        except (struct.error, OverflowError):
            self.counts.unsendable += 1
            return
        for peer, sign in to:
            seq = self._seq[system, peer]
            self._seq[system, peer] = (seq + 1) % 256
            yield frame(what, seq, (system, self._component), sign), peer

    def forget(self, peers: Collection[Peer]) -> None:
        """Drops the sequence numbers of all peers but these."""
        for key in [key for key in self._seq if key[1] not in peers]:
            del self._seq[key]

    def parse(self, datagram: bytes) -> list[mav.MAVLink_message]:
        """The messages of a datagram. A packet never spans two datagrams, so a broken one spoils nothing after it."""
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
