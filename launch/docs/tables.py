"""Types of files and parameters as rows of a table: key, type, unit, default, limits, meaning."""

import math
from collections.abc import Iterator
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, NamedTuple, Union, get_args, get_origin

import msgspec
from msgspec import Meta

from uvf.models.keys import hints_of, meta_of, unit_of

HEAD = ("| key | value | unit | default | limits | meaning |", "|---|---|---|---|---|---|")
NO_LIMIT, NEXT_TO_ZERO = 1e9, 1e-9
WORDS: dict[Any, str] = {float: "number", int: "whole number", str: "text", bool: "true or false", Any: "any"}


class Key(NamedTuple):
    """One key of a struct. default: None where it must be given."""

    name: str
    hint: Any
    meta: Meta
    default: str | None

    @property
    def is_number(self) -> bool:
        """Whether the key holds a float or an integer."""
        return bare(self.hint) in (float, int)


def keys_of(struct: type[msgspec.Struct]) -> list[Key]:
    """The keys of a struct in the order of its definition."""
    hints = hints_of(struct)
    return [Key(f.name, hints[f.name], meta_of(hints[f.name]), _default(f)) for f in msgspec.structs.fields(struct)]


def bare(hint: Any) -> Any:
    """The type without its annotations, and without None where a key may be left out."""
    while True:
        if get_origin(hint) is Annotated:
            hint = get_args(hint)[0]
        elif get_origin(hint) in (Union, UnionType) and len(inner := [a for a in get_args(hint) if a is not NoneType]) == 1:
            hint = inner[0]
        else:
            return hint


def parts_of(hint: Any) -> Iterator[type[msgspec.Struct]]:
    """The structs that a key holds."""
    kind = bare(hint)
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        yield kind
    elif get_origin(kind) is not Literal:
        for inner in get_args(kind):
            yield from parts_of(inner)


def table(struct: type[msgspec.Struct], links: dict[type, str]) -> list[str]:
    """Lines of a Markdown table; links: where each struct has its section."""
    return [*HEAD, *(_row(key, links) for key in keys_of(struct))]


def _row(key: Key, links: dict[type, str]) -> str:
    default = "must be given" if key.default is None else key.default
    unit = unit_of(key.meta) or ""
    cells = (f"`{key.name}`", _kind(key.hint, links), unit, default, _limits(key.hint), key.meta.description or "")
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


def _kind(hint: Any, links: dict[type, str]) -> str:
    kind = bare(hint)
    origin, inner = get_origin(kind), get_args(kind)
    if origin is Literal:
        return ", ".join(f"`{value}`" for value in inner if value)
    if kind in links:
        return f"[{links[kind]}](#{anchor(kind)})"
    if origin is list:
        return f"list of {_kind(inner[0], links)}"
    if origin is tuple:
        kinds = [_kind(each, links) for each in inner]
        return f"[{', '.join(kinds)}]" if len(set(kinds)) > 1 else f"{len(kinds)} x {kinds[0]}"
    if origin is dict:
        return f"{_kind(inner[1], links)} by name"
    if origin in (Union, UnionType):
        return " or ".join(_kind(each, links) for each in inner if each is not NoneType)
    return WORDS[kind]


def anchor(struct: type) -> str:
    """The name of a struct's section in links."""
    return struct.__name__.lower()


def _limits(hint: Any) -> str:
    while get_origin(hint) in (Union, UnionType):
        hint = next(a for a in get_args(hint) if a is not NoneType)
    inner = next((a for a in get_args(get_args(hint)[0]) if a is not NoneType), None) if _is_optional(hint) else None
    meta, more = meta_of(hint), meta_of(inner)
    low = next((v for v in (meta.ge, meta.gt, more.ge, more.gt) if v is not None), -math.inf)
    high = next((v for v in (meta.le, meta.lt, more.le, more.lt) if v is not None), math.inf)
    open_low = (meta.gt is not None or more.gt is not None) or low == NEXT_TO_ZERO
    low = 0.0 if low == NEXT_TO_ZERO else low
    beginning = "" if low == -math.inf else f"above {low:g}" if open_low else f"{low:g}"
    end = "" if high >= NO_LIMIT else f"below {high:g}" if meta.lt is not None else f"{high:g}"
    if beginning and end:
        return f"{beginning} to {end}" if not open_low else f"{beginning}, up to {end}"
    return beginning if open_low or not beginning else f"from {beginning}"


def _is_optional(hint: Any) -> bool:
    return get_origin(hint) is Annotated and get_origin(get_args(hint)[0]) in (Union, UnionType)


def _default(field: msgspec.structs.FieldInfo) -> str | None:
    if field.required:
        return None
    value = field.default if field.default is not msgspec.NODEFAULT else field.default_factory()
    return _text(value)


def _text(value: Any) -> str:
    if value is None or value == "" or (isinstance(value, float) and not math.isfinite(value)):
        return "left out"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float | int):
        return f"{value:g}"
    if isinstance(value, tuple):
        return f"[{', '.join(_text(v) for v in value)}]"
    if isinstance(value, list | dict):
        return "none"
    return "defaults of its own keys" if isinstance(value, msgspec.Struct) else f"`{value}`"
