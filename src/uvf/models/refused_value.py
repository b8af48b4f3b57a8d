"""Why a value of a file or a parameter is refused, in words: what it is, what it has to be, how to write it."""

import math
import re
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from uvf.models.keys import allowed_in, hints_of, meta_of, unit_of

SHOWN = 60  # letters of a text
LARGEST = 1e300  # that is written as a number
NEXT_TO_ZERO = 1e-9  # a lower limit that stands for: above zero
UNITS = {"s": "seconds", "m": "metres", "rad": "radians", "deg": "degrees", "Hz": "hertz", "m/s": "metres per second"}
KINDS = {
    "float": "is not a number",
    "int": "is not a whole number",
    "str": "is not text; put it in quotes",
    "bool": "is neither true nor false",
    "object": "is not a mapping; write 'key: value' lines, or {key: value}",
    "array": "is not a list; write [...]",
}
SIGNS = {"<=": "is above", "<": "is not below", ">=": "is below", ">": "is not above"}
AMOUNTS = {"": "", ">= ": "at least ", "<= ": "at most "}
FEW = {"array": "entr{}", "object": "entr{}", "str": "character{}"}

MISSING = re.compile(r"Object missing required field `(?P<key>\w+)`")
KIND = re.compile(r"Expected `(?P<kind>float|int|str|bool|object|array)(?: \| null)?`(?:, got `\w+`)?")
LIMIT = re.compile(r"Expected `(?:float|int)(?: \| null)?` (?P<sign>[<>]=?) (?P<limit>\S+)")
LENGTH = re.compile(r"Expected `(?P<kind>str|array|object)(?: \| null)?` of length (?P<sign>(?:[<>]= )?)(?P<length>\d+)(?:, got \d+)?")
PATTERN = re.compile(r"Expected `str(?: \| null)?` matching regex .*", re.DOTALL)
IN_DEGREES = re.compile(r"\s*(?P<number>[-+]?\d+(?:\.\d*)?)\s*(?:deg|degrees?|°)\s*")


def in_words(data: Any, hint: Any, said: str) -> str:
    """What msgspec ``said`` about ``data``, which was to become ``hint``, as people say it."""
    if found := MISSING.fullmatch(said):
        return _missing(found["key"], _bare(hint))
    if found := KIND.fullmatch(said):
        return _other_kind(data, hint, found["kind"])
    if found := LIMIT.fullmatch(said):
        return _beyond(data, hint, found["sign"], float(found["limit"]))
    if found := LENGTH.fullmatch(said):
        what = FEW[found["kind"]]
        wanted = int(found["length"])
        return f"it has {_counted(len(data), what)}; give {AMOUNTS[found['sign']]}{_counted(wanted, what)}"
    if PATTERN.fullmatch(said):
        return f"{_shown(data)} is not allowed here; {allowed_in(meta_of(hint)) or 'give another name'}"
    return "the number is too large" if said.endswith("out of range") else said


def _missing(name: str, struct: Any) -> str:
    meta = meta_of(hints_of(struct)[name])
    sentence = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", meta.description or "").replace("`", "")
    sentence = re.split(r"[.;:] |\.$", sentence)[0]
    if not sentence:
        return f"key '{name}' is missing"
    begins_like_a_sentence = not sentence[1:2].isupper()
    unit = unit_of(meta)
    meaning = (sentence[0].lower() if begins_like_a_sentence else sentence[0]) + sentence[1:]
    return f"key '{name}' is missing: {meaning}" + (f" [{unit}]" if unit and unit in UNITS else "")


def _other_kind(data: Any, hint: Any, kind: str) -> str:
    if data is None:
        return "nothing is given; write a value, or leave the key out"
    count = len(get_args(_bare(hint)))
    if kind == "array" and get_origin(_bare(hint)) is tuple:
        return f"{_shown(data)} is not a list of {count}; write [{', '.join('...' for _ in range(count))}]"
    text = f"{_shown(data)} {KINDS[kind]}"
    unit = unit_of(meta_of(hint))
    if not isinstance(data, str) or kind not in ("float", "int") or not unit:
        return text
    if unit == "rad" and (found := IN_DEGREES.fullmatch(data)):
        return f"{text}; give radians without a unit ({_degrees(float(found['number']))})"
    return f"{text}; give {UNITS[unit]} without a unit" if unit in UNITS else f"{text}; give it without a unit"


def _beyond(data: Any, hint: Any, sign: str, limit: float) -> str:
    unit = unit_of(meta_of(hint))
    if sign == ">=" and 0 < limit <= NEXT_TO_ZERO:
        sign, limit = ">", 0.0
    text = f"{_shown(data)} {SIGNS[sign]} {limit:.12g}"
    if unit == "rad" and 0 < abs(data) <= 360 and abs(data) > abs(limit):
        return f"{text}: it is in radians ({_degrees(data)})"
    return f"{text} {unit}" if unit in UNITS and limit else text


def _degrees(number: float) -> str:
    return f"{number:g} deg = {math.radians(number):.4g}"


def _shown(data: Any) -> str:
    """A value as a file has it, in short."""
    if isinstance(data, bool):
        return str(data).lower()
    if isinstance(data, int | float):
        return f"{data:.12g}" if abs(data) < LARGEST else "the number"
    if isinstance(data, str):
        return f"'{data if len(data) <= SHOWN else data[: SHOWN - 1] + '…'}'"
    return "a mapping" if isinstance(data, dict) else "a list" if isinstance(data, list) else f"'{data}'"


def _counted(count: int, what: str) -> str:
    one, more = ("y", "ies") if what.startswith("entr") else ("", "s")
    return f"{count} {what.format(one if count == 1 else more)}"


def _bare(hint: Any) -> Any:
    """The type without its notes, and without None."""
    while True:
        if get_origin(hint) is Annotated:
            hint = get_args(hint)[0]
        elif get_origin(hint) in (Union, UnionType):
            hint = next(a for a in get_args(hint) if a is not NoneType)
        else:
            return hint
