"""The parameters of one vehicle: read from ``parameters.yaml``, numbered, and as the bytes that go over the wire."""

import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import msgspec

from services.autopilot.mavlink import dialect as mav
from services.autopilot.mavlink.facts import Facts
from uvf.runtime.params import BadInput, load_yaml, nearest

FILE = Path(__file__).with_name("parameters.yaml")
Value = float | str
Kind = Literal["ground", "fixed_wing"]


class Row(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    type: Literal["int", "real"]
    value: Value
    ground: Value | None = None
    fixed_wing: Value | None = None
    absent: list[Kind] = []


class Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    parameters: dict[str, Row]


@dataclass(frozen=True)
class Parameter:
    """raw: the four bytes of the value; an integer travels as its own bytes in the float field."""

    name: str
    index: int
    type: int
    raw: bytes


def parameters_of(facts: Facts) -> list[Parameter]:
    """In order of name, numbered from 0."""
    rows = {name: row for name, row in load_yaml(FILE, Table).parameters.items() if facts.file.kind not in row.absent}
    return [_parameter(name, index, rows[name], facts) for index, name in enumerate(sorted(rows))]


def _parameter(name: str, index: int, row: Row, facts: Facts) -> Parameter:
    special = row.ground if facts.is_ground else row.fixed_wing
    value = row.value if special is None else special
    if isinstance(value, str):
        if value not in facts.numbers:
            raise BadInput(f"{FILE.name}: {name}: '{value}' is no number of a {facts.file.kind} vehicle; {nearest(value, facts.numbers)}")
        value = facts.numbers[value]
    if row.type == "int":
        return Parameter(name, index, mav.MAV_PARAM_TYPE_INT32, struct.pack("<i", int(value)))
    return Parameter(name, index, mav.MAV_PARAM_TYPE_REAL32, struct.pack("<f", value))


def hash_of(parameters: list[Parameter]) -> int:
    """CRC-32 (start 0, not inverted) over names and values in order, as PX4's ``param_hash_check``."""
    data = b"".join(p.name.encode() + p.raw for p in parameters)
    return zlib.crc32(data, 0xFFFFFFFF) ^ 0xFFFFFFFF


def param_value(name: str, raw: bytes, type_: int, place: tuple[int, int]) -> mav.MAVLink_param_value_message:
    """PARAM_VALUE with exactly these four bytes; place: (count, index).

    Through a Python float some bit patterns of integers (signalling NaNs) would change, so the field is packed as bytes.
    """
    message = mav.MAVLink_param_value_message(name.encode(), 0.0, type_, *place)
    message.unpacker = struct.Struct("<4sHH16sB")
    message.param_value = raw  # type: ignore[assignment]
    return message
