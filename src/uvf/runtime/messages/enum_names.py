"""What the page calls a value of an enum. Anybody may put any number on the bus, also one that a later version has a name for."""

from typing import Any


def enum_name(enum: Any, value: int) -> str:
    """``return`` for ``Mode.MODE_RETURN``, ``no mission`` for ``NO_MISSION``; ``mode 99``, ``state 99`` for a value without a name.

    enum: as protobuf generates it, for example ``Mode`` or ``NavStatus.State``.
    """
    described = enum.DESCRIPTOR
    known = described.values_by_number.get(value)
    if known is None:
        return f"{described.name.lower()} {value}"
    name: str = known.name.removeprefix(f"{described.name.upper()}_").lower().replace("_", " ")
    return name
