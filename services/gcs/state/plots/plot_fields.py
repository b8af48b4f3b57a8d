"""Which numbers a message holds, by paths such as ``position.x``, and how they are taken out of it."""

from collections.abc import Iterator
from functools import lru_cache
from math import degrees, hypot
from typing import Any, NamedTuple

from google.protobuf.descriptor import Descriptor, FieldDescriptor
from google.protobuf.message import Message

from schemas.units import units
from uvf.maths.rotations import to_euler
from uvf.runtime.messages.convert import wxyz
from uvf.runtime.messages.validation import is_repeated

DEEPEST = 4
MOST_FIELDS = 120
MOST_ITEMS = 16
"""Of a repeated field, by index or by their ``name``."""
NUMBERS = {
    FieldDescriptor.CPPTYPE_DOUBLE,
    FieldDescriptor.CPPTYPE_FLOAT,
    FieldDescriptor.CPPTYPE_INT32,
    FieldDescriptor.CPPTYPE_INT64,
    FieldDescriptor.CPPTYPE_UINT32,
    FieldDescriptor.CPPTYPE_UINT64,
    FieldDescriptor.CPPTYPE_BOOL,
    FieldDescriptor.CPPTYPE_ENUM,
}
ANGLES = ("roll", "pitch", "yaw")
DERIVED: dict[str, tuple[str, ...]] = {"foxglove.Quaternion": ANGLES, "foxglove.Vector3": ("norm",)}
TIMES = ("google.protobuf.Timestamp", "google.protobuf.Duration")


class PlotField(NamedTuple):
    """A number that a message of a type always has."""

    path: str
    unit: str


@lru_cache(maxsize=256)
def plot_fields(kind: Descriptor) -> tuple[PlotField, ...]:
    """The numbers of a type of message, without those in repeated fields, whose number only a message tells."""
    return tuple(found for found, _ in zip(_walk(kind, "", "", 0), range(MOST_FIELDS), strict=False))


def _walk(kind: Descriptor, before: str, unit: str, depth: int) -> Iterator[PlotField]:
    yield from (PlotField(f"{before}{name}", "deg" if name in ANGLES else unit) for name in DERIVED.get(kind.full_name, ()))
    for field in kind.fields:
        mine = units().get((kind.full_name, field.name), unit)
        if is_repeated(field):
            continue
        if field.cpp_type in NUMBERS:
            yield PlotField(before + field.name, mine)
        elif (inner := field.message_type) is not None and depth < DEEPEST and inner.full_name not in TIMES:
            yield from _walk(inner, f"{before}{field.name}.", mine, depth + 1)


def repeated_fields(message: Message) -> tuple[PlotField, ...]:
    """The numbers in the repeated fields of a message, as ``joints[left_wheel].position``."""
    found = [one for field in message.DESCRIPTOR.fields if is_repeated(field) for one in _of_items(message, field)]
    return tuple(found[:MOST_FIELDS])


def _of_items(message: Message, field: Any) -> Iterator[PlotField]:
    if field.message_type is not None and field.message_type.GetOptions().map_entry:
        return
    unit = units().get((message.DESCRIPTOR.full_name, field.name), "")
    for i, item in enumerate(list(getattr(message, field.name))[:MOST_ITEMS]):
        name = getattr(item, "name", "") or str(i)
        if field.cpp_type in NUMBERS:
            yield PlotField(f"{field.name}[{i}]", unit)
        elif isinstance(item, Message):
            yield from (PlotField(f"{field.name}[{name}].{one.path}", one.unit or unit) for one in plot_fields(item.DESCRIPTOR))


def value_at(message: Message, path: str) -> float | None:
    """The number at a path; None where this message has none. Angles of quaternions are in degrees, in the frame of the message."""
    at: Any = message
    parts = path.split(".")
    for i, part in enumerate(parts):
        name, bracket, index = part.partition("[")
        if isinstance(at, Message) and name in DERIVED.get(at.DESCRIPTOR.full_name, ()):
            return None if i + 1 < len(parts) else _derived(at, name)
        if not isinstance(at, Message) or name not in at.DESCRIPTOR.fields_by_name:
            return None
        at = getattr(at, name)
        if bracket:
            at = _item(at, index.removesuffix("]"))
        elif at is not None and not isinstance(at, Message | bool | int | float):
            return None
    return float(at) if isinstance(at, bool | int | float) else None


def _item(items: Any, index: str) -> Any:
    try:
        named = (item for item in list(items)[:MOST_ITEMS] if getattr(item, "name", None) == index)
        found = next(named, None)
        return items[int(index)] if found is None and index.isdecimal() and int(index) < len(items) else found
    except TypeError:
        return None


def _derived(message: Any, name: str) -> float:
    if name == "norm":
        return hypot(message.x, message.y, message.z)
    return degrees(to_euler(wxyz(message))[ANGLES.index(name)])
