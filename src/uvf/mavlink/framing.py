"""MAVLink 2 frames: a message's payload is made once; header, sequence number, checksum and signature for each peer."""

import struct
from collections.abc import Callable
from typing import NamedTuple

from uvf.mavlink import dialect as mav

HEADER = struct.Struct("<BBBBBBBHB")  # marker, length, incompatible and compatible flags, sequence, system, component, number
SIGNED = mav.MAVLINK_IFLAG_SIGNED

Sign = Callable[[bytes], bytes]
"""The signature block of a packet that is whole but for it."""


class MessageBody(NamedTuple):
    """What a message's packets to all peers have in common.

    number: its id; extra: CRC_EXTRA of its definition, part of the checksum; payload: without its trailing zeros.
    """

    number: int
    extra: int
    payload: bytes


def body(message: mav.MAVLink_message) -> MessageBody:
    """Payload of a message. Raises struct.error or OverflowError when a number does not fit its field."""
    # The dialect's own frames are for one link with one key: only its payload is taken.
    message._pack = lambda framer, extra, payload, **_: payload  # type: ignore[method-assign]
    payload: bytes = message.pack(None)  # type: ignore[arg-type]
    return MessageBody(message.get_msgId(), message.crc_extra, payload.rstrip(b"\0") or payload[:1])


def frame(what: MessageBody, seq: int, source: tuple[int, int], sign: Sign | None = None) -> bytes:
    """A MAVLink 2 packet from ``source`` (system, component) with the sequence number ``seq``; ``sign`` appends a signature."""
    flags = SIGNED if sign is not None else 0
    low, high = what.number & 0xFFFF, what.number >> 16
    head = HEADER.pack(mav.PROTOCOL_MARKER_V2, len(what.payload), flags, 0, seq, *source, low, high)
    checksum = mav.x25crc(head[1:] + what.payload + bytes((what.extra,))).crc
    packet = head + what.payload + checksum.to_bytes(2, "little")
    return packet + sign(packet) if sign is not None else packet
