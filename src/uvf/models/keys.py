"""What a key of a file or a parameter means and in which unit: said once, in its type, for the reference and for who asks.

``x: Annotated[Metres, key("m", "East of the world's origin.")]``. A number without a unit says so by ``""``.
"""

import functools
from typing import Annotated, Any, get_args, get_origin, get_type_hints

from msgspec import UNSET, Meta

UNIT, ALLOWED = "unit", "allowed"


def key(unit: str, meaning: str) -> Meta:
    """Note of a key that is a number of this unit; its limits, if it has any, are those of its type."""
    return Meta(description=meaning, extra_json_schema={UNIT: unit})


def plain(meaning: str) -> Meta:
    """Note of a key that is no number: a name, a choice, a list, a part of the file."""
    return Meta(description=meaning)


def in_unit(unit: str) -> Meta:
    """Unit of the numbers of a list, whose key has the note of the whole."""
    return Meta(extra_json_schema={UNIT: unit})


def name_like(pattern: str, longest: int, allowed: str) -> Meta:
    """Limits of a name: its pattern, its most letters, and the pattern in words, for who is refused."""
    return Meta(pattern=rf"^{pattern}\Z", max_length=longest, extra_json_schema={ALLOWED: allowed})


@functools.cache
def hints_of(struct: type) -> dict[str, Any]:
    """The type of each key of a struct by its name, ``Annotated`` as it is written."""
    return get_type_hints(struct, include_extras=True)


def meta_of(hint: Any) -> Meta:
    """All notes and limits of a type in one; of two that say the same, the outer one counts."""
    if get_origin(hint) is not Annotated:
        return Meta()
    said: dict[str, Any] = {}
    for meta in get_args(hint)[1:]:
        if isinstance(meta, Meta):
            given = {name: getattr(meta, name, None) for name in ("gt", "ge", "lt", "le", "description", "extra_json_schema")}
            said |= {name: value for name, value in given.items() if value is not None and value is not UNSET}
    return Meta(**said)


def unit_of(meta: Meta) -> str | None:
    """Unit that a note names; None where it names none, empty for a dimensionless number."""
    return (meta.extra_json_schema or {}).get(UNIT)


def allowed_in(meta: Meta) -> str:
    """The words that say what a name may consist of; empty where there are none."""
    return str((meta.extra_json_schema or {}).get(ALLOWED, ""))
