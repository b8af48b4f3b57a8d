"""Numbers that no computation survives, found in a message at the border of a service, so that none of them has to look.

The fields to look at are worked out once for each type; then one message costs a few calls into C.
"""

from collections.abc import Callable
from functools import cache
from math import hypot
from operator import attrgetter
from typing import Any

from google.protobuf.descriptor import Descriptor, FieldDescriptor
from google.protobuf.message import Message

from schemas.messages import Grid

LARGEST = 1e12  # of any unit; beyond it squares lose the rest, and indices leave their integers
OPEN = {
    "foxglove.LaserScan": {"ranges", "intensities"},  # no return may be written as infinite
    "uvf.v1.GoalRequest": {"yaw"},  # NaN = any
    "uvf.v1.Param": {"min", "max"},  # infinite = no limit
}
"""Fields in which anything may stand."""

_FLOATS = (FieldDescriptor.TYPE_DOUBLE, FieldDescriptor.TYPE_FLOAT)


def fault(message: Message) -> str:
    """What is wrong with the numbers of a message; empty when nothing is."""
    if not _is_sound(message.DESCRIPTOR)(message):
        return f"a number that is not finite or above {LARGEST:g}"
    return _grid_fault(message) if isinstance(message, Grid) else ""


def _grid_fault(grid: Grid) -> str:
    """Cells of one byte in whole rows, as ``occupancy_cells`` reads them."""
    if not (grid.cell_size.x > 0 and grid.cell_size.y > 0):
        return "cells without size"
    if grid.column_count == 0 or not grid.data or len(grid.data) % grid.column_count:
        return f"{len(grid.data)} cells do not make rows of {grid.column_count}"
    return ""


@cache
def _is_sound(type_: Descriptor) -> Callable[[Any], bool]:
    """The test of one message type, with those of the messages inside it."""
    fields = [f for f in type_.fields if f.name not in OPEN.get(type_.full_name, ())]
    single = [f.name for f in fields if f.type in _FLOATS and not _is_repeated(f)]
    values = attrgetter(*single, single[0]) if single else None  # one name twice: a tuple even of one
    lists = [attrgetter(f.name) for f in fields if f.type in _FLOATS and _is_repeated(f)]
    messages = [f for f in fields if f.message_type and not f.message_type.GetOptions().map_entry and _has_numbers(f.message_type)]
    inner = [(attrgetter(f.name), _is_sound(f.message_type)) for f in messages if not _is_repeated(f)]
    rows = [(attrgetter(f.name), _is_sound(f.message_type)) for f in messages if _is_repeated(f)]

    def test(message: Any) -> bool:
        if values is not None and not hypot(*values(message)) < LARGEST:
            return False
        for get, sound in inner:
            if not sound(get(message)):
                return False
        return all(hypot(*get(message)) < LARGEST for get in lists) and all(all(map(sound, get(message))) for get, sound in rows)

    return test


def _has_numbers(type_: Descriptor) -> bool:
    return any(f.type in _FLOATS or (f.message_type and _has_numbers(f.message_type)) for f in type_.fields)


def _is_repeated(field: FieldDescriptor) -> bool:
    return bool(field.label == FieldDescriptor.LABEL_REPEATED)  # type: ignore[attr-defined]  # the stubs are of a newer release
