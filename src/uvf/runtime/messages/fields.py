"""Fields of messages by dotted names, as tables and plots want them: ``pose.position.x``, ``ranges[10]``, ``pose.orientation.yaw``."""

import json
import re
from collections.abc import Callable
from typing import Any

from google.protobuf.descriptor import FieldDescriptor
from google.protobuf.json_format import MessageToDict

from schemas.messages import Quaternion, Timestamp
from uvf.maths.rotations import to_euler
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.messages.convert import seconds, wxyz
from uvf.runtime.messages.validation import is_repeated

Descriptor = Any  # the stubs have two of them, of which a message type has the other one
Getter = Callable[[Any], Any]
PART = re.compile(r"([A-Za-z_]\w*)(?:\[(\d+)\])?")
NUMBERS = {
    *(FieldDescriptor.CPPTYPE_DOUBLE, FieldDescriptor.CPPTYPE_FLOAT, FieldDescriptor.CPPTYPE_BOOL, FieldDescriptor.CPPTYPE_ENUM),
    *(FieldDescriptor.CPPTYPE_INT32, FieldDescriptor.CPPTYPE_INT64, FieldDescriptor.CPPTYPE_UINT32, FieldDescriptor.CPPTYPE_UINT64),
}
ANGLES = ("roll", "pitch", "yaw")
"""Of a quaternion [rad], besides its w, x, y and z."""


def number_of(message: Descriptor, path: str) -> Callable[[Any], float | None]:
    """What reads one number of a message by a dotted name; None where a list is too short. Times are in seconds. Raises BadInput."""
    steps: list[Getter] = []
    here, whole = message, message.full_name
    for i, part in enumerate(parts := path.split(".")):
        match = PART.fullmatch(part)
        if match is None:
            raise BadInput(f"{whole}: '{part}' is no field; write as pose.position.x, or ranges[10] for an element of a list")
        name, index, last = match[1], match[2], i + 1 == len(parts)
        if here is Quaternion.DESCRIPTOR and name in ANGLES and index is None and last:
            return _composed([*steps, _angle(ANGLES.index(name))])
        field = here.fields_by_name.get(name)
        if field is None:
            raise BadInput(f"{whole}: {here.full_name} has no field '{name}'; {nearest(name, _names(here))}")
        if is_repeated(field) != (index is not None):
            raise BadInput(f"{whole}: {name} is {'a list: choose one of it, as ' + name + '[0]' if index is None else 'no list'}")
        steps.append(_element(name, int(index)) if index is not None else _named(name))
        if last:
            if field.message_type is Timestamp.DESCRIPTOR:
                return _composed([*steps, seconds])
            if field.cpp_type not in NUMBERS:
                inner = f"; {nearest('', number_names(field.message_type))}" if field.message_type is not None else ""
                raise BadInput(f"{whole}: {path} is no number{inner}")
            return _composed([*steps, float])
        if field.message_type is None:
            raise BadInput(f"{whole}: {name} has no fields")
        here = field.message_type
    raise BadInput(f"{whole}: no field is named")


def number_names(message: Descriptor) -> list[str]:
    """The dotted names of all single numbers of a message, and of the angles of its quaternions."""
    if message is Quaternion.DESCRIPTOR:
        return _names(message)
    found: list[str] = []
    for field in _fields(message):
        if is_repeated(field):
            found += [f"{field.name}[0]"] if field.cpp_type in NUMBERS else []
        elif field.message_type is not None and field.message_type is not Timestamp.DESCRIPTOR:
            found += [f"{field.name}.{name}" for name in number_names(field.message_type)]
        elif field.cpp_type in NUMBERS or field.message_type is not None:
            found.append(field.name)
    return found


def columns_of(message: Descriptor) -> dict[str, tuple[type, Getter]]:
    """The columns of a table of such messages: dotted names, each with its type and what reads it.

    Enumerations are given by name, times in seconds, lists of numbers as lists, other lists and maps as JSON; of bytes only the number,
    ``data_size``.
    """
    found: dict[str, tuple[type, Getter]] = {}
    for field in _fields(message):
        name = field.name
        if is_repeated(field):
            found[name] = (list, _listed(name)) if field.cpp_type in NUMBERS else (str, _as_json(name))
        elif field.message_type is Timestamp.DESCRIPTOR:
            found[name] = float, _composed([_named(name), seconds])
        elif field.message_type is not None:
            inner = columns_of(field.message_type)
            found |= {f"{name}.{key}": (kind, _composed([_named(name), get])) for key, (kind, get) in inner.items()}
        elif field.enum_type is not None:
            found[name] = str, _enum_name(field)
        elif field.type == FieldDescriptor.TYPE_BYTES:
            found[f"{name}_size"] = int, _composed([_named(name), len])
        elif field.cpp_type == FieldDescriptor.CPPTYPE_UINT64:  # numbers of things: no table has integers so large
            found[name] = str, _composed([_named(name), str])
        else:
            found[name] = _TYPES.get(field.cpp_type, int), _named(name)
    return found


_TYPES: dict[int, type] = {
    FieldDescriptor.CPPTYPE_DOUBLE: float,
    FieldDescriptor.CPPTYPE_FLOAT: float,
    FieldDescriptor.CPPTYPE_BOOL: bool,
    FieldDescriptor.CPPTYPE_STRING: str,
}


def _names(message: Descriptor) -> list[str]:
    return [*(field.name for field in _fields(message)), *(ANGLES if message is Quaternion.DESCRIPTOR else ())]


def _fields(message: Descriptor) -> list[FieldDescriptor]:
    return list(message.fields)


def _named(name: str) -> Getter:
    return lambda message: getattr(message, name)


def _element(name: str, index: int) -> Getter:
    def get(message: Any) -> Any:
        values = getattr(message, name)
        return values[index] if index < len(values) else None

    return get


def _listed(name: str) -> Getter:
    return lambda message: list(getattr(message, name))


def _angle(which: int) -> Getter:
    return lambda quaternion: to_euler(wxyz(quaternion))[which]


def _composed(steps: list[Getter]) -> Getter:
    def get(value: Any) -> Any:
        for step in steps:
            if value is None:
                return None
            value = step(value)
        return value

    return get


def _enum_name(field: FieldDescriptor) -> Getter:
    assert field.enum_type is not None
    names = {value.number: value.name for value in field.enum_type.values}
    return lambda message: names.get(number := getattr(message, field.name), str(number))


def _as_json(name: str) -> Getter:
    def get(message: Any) -> str:
        values = getattr(message, name)
        if hasattr(values, "items"):
            return json.dumps({str(key): _plain(value) for key, value in values.items()})
        return json.dumps([_plain(value) for value in values])

    return get


def _plain(value: Any) -> Any:
    if isinstance(value, bytes):
        return len(value)
    return MessageToDict(value, preserving_proto_field_name=True) if hasattr(value, "DESCRIPTOR") else value
