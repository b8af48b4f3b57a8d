"""Messages checked at the border of a service against the limits of the schema, so that none of them has to look.

What there is to look at is worked out once for each type; then a good message costs a few calls into C. Only of a bad one
is it found out where it is bad.
"""

import re
from collections.abc import Callable, Iterator
from functools import cache
from math import hypot, isfinite
from operator import attrgetter
from typing import Any

from google.protobuf.descriptor import Descriptor, EnumDescriptor, FieldDescriptor
from google.protobuf.message import Message

from schemas.limits import BYTES, ENTRIES, GRID_CELL, GRID_SIDE, INTEGER, LENGTHS, MOST, NUMBER, OPEN, PATTERNS, RANGES, TEXT
from schemas.messages import Grid, Quaternion, Timestamp, Vector3

Test = Callable[[Any], bool]
_FLOATS = (FieldDescriptor.TYPE_DOUBLE, FieldDescriptor.TYPE_FLOAT)
_LONG = (FieldDescriptor.TYPE_INT64, FieldDescriptor.TYPE_UINT64, FieldDescriptor.TYPE_SINT64)
_BREAKS = str.maketrans("\n\t", "  ")
LAST_SECOND = 10**11
UNIT_WITHIN = 0.1
"""How far the length of a quaternion may be from 1."""
IDS = {"uvf.v1.StopCommand.id", "uvf.v1.StopEngagement.id"}
"""Integers that nobody counts with."""


def error_in(message: Message) -> str:
    """What is wrong with the content of a message, by field; empty when nothing is."""
    if not _test_of(message.DESCRIPTOR)(message):
        return next(_errors(message, ""), "")
    return _error_in_grid(message) if isinstance(message, Grid) else ""


def _error_in_grid(grid: Grid) -> str:
    """Cells of one byte in whole rows, as ``occupancy_cells`` reads them."""
    (low, high), columns, count = GRID_CELL, grid.column_count, len(grid.data)  # asked once: the cells are copied for it
    if not (low <= grid.cell_size.x <= high and low <= grid.cell_size.y <= high):
        return f"cell_size: cells are of {low:g} to {high:g} m"
    if columns == 0 or count == 0 or count % columns:
        return f"{count} cells do not make rows of {columns}"
    if columns > GRID_SIDE or count // columns > GRID_SIDE:
        return f"more than {GRID_SIDE} cells along a side"
    return ""


def _is_time(stamp: Timestamp) -> bool:
    return 0 <= stamp.seconds < LAST_SECOND and 0 <= stamp.nanos < 1_000_000_000


def _is_rotation(q: Quaternion) -> bool:
    """Of about unit length, or left out."""
    length = hypot(q.w, q.x, q.y, q.z)
    return length == 0.0 or abs(length - 1.0) < UNIT_WITHIN


def _size(value: float | Vector3) -> float:
    return hypot(value.x, value.y, value.z) if isinstance(value, Vector3) else abs(value)


def is_text(text: str, longest: int = TEXT) -> bool:
    """Whether a text is short enough and free of what a terminal, a log or a page would obey: control characters, changes of direction."""
    return len(text) <= longest and (text.isprintable() or text.translate(_BREAKS).isprintable())


def legible(text: str, most: int = TEXT) -> str:
    """Any text as one line that ``is_text`` accepts: without control characters and changes of direction, cut to ``most`` characters."""
    kept = "".join(letter if letter.isprintable() else " " for letter in text[: most + 1]).strip()
    return kept if len(kept) <= most else f"{kept[: most - 1]}…"


def escaped(text: str) -> str:
    """Any text on one line, with what would steer a terminal or turn the text round written out: ``\\x1b``."""
    return "".join(letter if letter.isprintable() else ascii(letter)[1:-1] for letter in text)


@cache
def _test_of(type_: Descriptor) -> Test:
    """True for a message of this type that is within all limits, with those inside it."""
    if type_.full_name == Timestamp.DESCRIPTOR.full_name:
        return _is_time
    if type_.full_name == Quaternion.DESCRIPTOR.full_name:
        return _is_rotation
    tests = [test for test in (_numbers(type_), *map(_field_test, type_.fields)) if test is not None]
    if not tests:
        return _anything
    if len(tests) == 1:
        return tests[0]

    def test(message: Any) -> bool:
        for each in tests:  # noqa: SIM110  # a generator would cost as much as the tests
            if not each(message):
                return False
        return True

    return test


def _anything(_: Any) -> bool:
    return True


def _numbers(type_: Descriptor) -> Test | None:
    """All single floats of a message at once."""
    names = [f.name for f in type_.fields if f.type in _FLOATS and not is_repeated(f) and not _is_open(f)]
    if not names:
        return None
    values = attrgetter(*names, names[0])  # one name twice: a tuple even of one
    return lambda message: hypot(*values(message)) < NUMBER


def _field_test(field: FieldDescriptor) -> Test | None:
    """Of one field, unless there is nothing to look at."""
    one = _value_test(field)
    get = attrgetter(field.name)
    if not is_repeated(field):
        is_told = field.type in _FLOATS and field.full_name not in MOST  # by ``_numbers``
        return None if one is None or is_told else lambda message: one(get(message))
    most = LENGTHS.get(field.full_name, ENTRIES)
    if field.type in _FLOATS and not _is_open(field):
        return lambda message: len(get(message)) <= most and hypot(*get(message)) < NUMBER
    if one is None or field.type in _FLOATS:
        return lambda message: len(get(message)) <= most
    if _is_map(field):
        return lambda message: len(get(message)) <= most and all(is_text(key) for key in get(message))
    return lambda message: len(get(message)) <= most and all(map(one, get(message)))


def _value_test(field: FieldDescriptor) -> Test | None:
    if field.full_name in PATTERNS:
        whole = re.compile(PATTERNS[field.full_name]).fullmatch
        return lambda text: whole(text) is not None
    if field.type == FieldDescriptor.TYPE_STRING:
        longest = LENGTHS.get(field.full_name, TEXT) if not is_repeated(field) else TEXT
        return lambda text: is_text(text, longest)
    if field.full_name in BYTES:
        size = BYTES[field.full_name]
        return lambda data: len(data) in (0, size)
    if field.type == FieldDescriptor.TYPE_ENUM:
        return frozenset(_enum(field).values_by_number).__contains__
    if field.full_name in RANGES:
        low, high = RANGES[field.full_name]
        return lambda number: low <= number <= high
    if field.type in _LONG and field.full_name not in IDS:
        return lambda number: -INTEGER <= number <= INTEGER
    if field.full_name in MOST:
        most = MOST[field.full_name]
        return lambda value: _size(value) <= most
    if field.type in _FLOATS:
        return lambda number: abs(number) < NUMBER
    if _is_map(field):
        return _anything
    if field.message_type is not None:
        inner = _test_of(field.message_type)
        return None if inner is _anything else inner
    return None


def _errors(message: Message, place: str) -> Iterator[str]:
    """``items[3].speed: inf``, for each field that is beyond its limits."""
    fields: Any = message.DESCRIPTOR.fields
    for field in fields:
        name, value = f"{place}{field.name}", getattr(message, field.name)
        test = _value_test(field)
        if is_repeated(field) and len(value) > LENGTHS.get(field.full_name, ENTRIES):
            yield f"{name}: {len(value)} entries, {LENGTHS.get(field.full_name, ENTRIES)} at most"
        elif test is None or _is_open(field):
            continue
        elif _is_map(field):
            yield from (f"{name}: {_described(field, key)}" for key in value if not is_text(key))
        else:
            entries = [(f"{name}[{i}]", entry) for i, entry in enumerate(value)] if is_repeated(field) else [(name, value)]
            for where, entry in entries:
                if not test(entry):
                    inner = list(_errors(entry, f"{where}.")) if _is_parent(entry) else []
                    yield from inner or (f"{where}: {_described(field, entry)}",)


def _is_parent(value: object) -> bool:
    return isinstance(value, Message) and not isinstance(value, (Timestamp, Quaternion))


def _described(field: FieldDescriptor, value: Any) -> str:
    """What is wrong with one value."""
    if isinstance(value, Timestamp):
        return f"{value.seconds} s {value.nanos} ns is no time"
    if isinstance(value, Quaternion):
        return f"({value.w:g}, {value.x:g}, {value.y:g}, {value.z:g}) is no unit quaternion"
    if field.type == FieldDescriptor.TYPE_ENUM:
        return f"{value} is none of {', '.join(_enum(field).values_by_name)}"
    if field.full_name in PATTERNS:
        return f"{value[:60]!a} is no name: letters, digits, - and _"
    if field.full_name in MOST and isfinite(_size(value)):
        return f"{_size(value):g} is more than {MOST[field.full_name]:g}"
    if isinstance(value, bytes):
        return f"{len(value)} bytes where {BYTES[field.full_name]} are due"
    if isinstance(value, str):
        longest = LENGTHS.get(field.full_name, TEXT)
        return f"{len(value)} characters, {longest} at most" if len(value) > longest else "holds control characters"
    if field.full_name in RANGES:
        low, high = RANGES[field.full_name]
        return f"{value} is not within {low} to {high}"
    return f"{value:g} is not finite or beyond {NUMBER:g}" if isinstance(value, float) else f"{value} is beyond {INTEGER}"


def _enum(field: FieldDescriptor) -> EnumDescriptor:
    assert field.enum_type is not None
    return field.enum_type


def _is_open(field: FieldDescriptor) -> bool:
    return field.containing_type is not None and field.name in OPEN.get(field.containing_type.full_name, ())


def _is_map(field: FieldDescriptor) -> bool:
    return bool(field.message_type and field.message_type.GetOptions().map_entry)


def is_repeated(field: Any) -> bool:
    """Whether a field of a message type has any number of values."""
    return bool(field.label == FieldDescriptor.LABEL_REPEATED)  # Any: the stubs are of a newer release
