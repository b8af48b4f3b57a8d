"""What the parameters of one vehicle are worth now, and how a value travels: as four bytes in a float field."""

import math
import struct
import zlib
from collections.abc import Mapping, Sequence
from typing import Any

from services.autopilot.mavlink.parameters.parameter_table import WHOLE, Parameter
from uvf.mavlink import dialect as mav


class ParameterValues:
    """The present values of a vehicle's parameters. own: the autopilot's own parameters by name, as far as known."""

    def __init__(self, table: Sequence[Parameter], own: Mapping[str, Any]) -> None:
        self.table = table
        self.by_name = {p.name: p for p in table}
        self._raw = {p.name: encoded(p, p.number(own)) for p in table}

    def raw(self, p: Parameter) -> bytes:
        """The four bytes of a parameter's value."""
        return self._raw[p.name]

    def update(self, own: Mapping[str, Any]) -> list[Parameter]:
        """Updates the values; returns the parameters that have changed."""
        before, self._raw = self._raw, {p.name: encoded(p, p.number(own)) for p in self.table}
        return [p for p in self.table if self._raw[p.name] != before[p.name]]

    @property
    def hash(self) -> int:
        """CRC-32 (start 0, not inverted) over names and values in order, as PX4's ``param_hash_check``."""
        return crc32(b"".join(p.name.encode() + self._raw[p.name] for p in self.table))


def crc32(data: bytes) -> int:
    """CRC-32 as MAVLink defines it for parameters and files: polynomial 0xEDB88320, start 0, not inverted."""
    return zlib.crc32(data, 0xFFFFFFFF) ^ 0xFFFFFFFF


def encoded(p: Parameter, number: float) -> bytes:
    """The four bytes of a value ``number`` [unit of the parameter]; an integer as its own bytes."""
    if p.is_int:
        return struct.pack("<i", min(max(int(number), WHOLE[0]), WHOLE[1]))
    return struct.pack("<f", number)


def decoded(p: Parameter, raw: bytes) -> float:
    """The value [unit of the parameter] of four bytes; NaN when it is not finite."""
    number = struct.unpack("<i" if p.is_int else "<f", raw)[0]
    return float(number) if math.isfinite(number) else math.nan


def raw_of(message: mav.MAVLink_param_set_message) -> bytes:
    """The bytes of the value field: some bit patterns of integers (signalling NaNs) do not survive as a Python float."""
    packet = bytes(message.get_msgbuf() or b"")
    head = mav.HEADER_LEN_V2 if packet[:1] == bytes((mav.PROTOCOL_MARKER_V2,)) else mav.HEADER_LEN_V1
    return packet[head : head + min(4, packet[1])].ljust(4, b"\0")


def param_value(name: str, raw: bytes, type_: int, place: tuple[int, int]) -> mav.MAVLink_param_value_message:
    """PARAM_VALUE with exactly these four bytes; place: (count, index)."""
    message = mav.MAVLink_param_value_message(name.encode(), 0.0, type_, *place)
    message.unpacker = struct.Struct("<4sHH16sB")
    message.param_value = raw  # type: ignore[assignment]
    return message
