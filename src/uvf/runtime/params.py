"""Typed data from YAML: unknown keys and wrong values end in one line that names the place and the mend."""

import difflib
import math
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

import msgspec
import yaml

T = TypeVar("T")


class BadInput(Exception):
    """Something from outside (file, argument, message) is wrong; the text says what, where and how to mend it."""


class _Loader(yaml.SafeLoader):
    """YAML 1.2 where 1.1 surprises: ``1e3`` is a number, and a key given twice is an error."""

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        keys = [key.value for key, _ in node.value]
        for key in keys:
            if keys.count(key) > 1 and key != "<<":
                raise yaml.constructor.ConstructorError(None, None, f"key '{key}' is given twice", node.start_mark)
        return super().construct_mapping(node, deep)


_Loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)[eE][-+]?\d+$"), list("-+0123456789."))


def load_yaml(path: Path, type_: type[T]) -> T:
    """Reads a YAML file into a msgspec Struct. Raises BadInput."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"{path}: cannot be read: {error}") from error
    try:
        data = yaml.load(text, _Loader)
    except RecursionError as error:
        raise BadInput(f"{path}: nested too deeply") from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{path}:{mark.line + 1}" if mark else str(path)
        raise BadInput(f"{place}: not valid YAML: {getattr(error, 'problem', error)}") from error
    return convert(data if data is not None else {}, type_, str(path))


def convert(data: Any, type_: type[T], place: str) -> T:
    """Plain data into ``type_``; ``place`` begins the error's line. Raises BadInput."""
    _refuse_unknown(data, type_, place)
    try:
        return msgspec.convert(data, type_)
    except msgspec.ValidationError as error:
        raise BadInput(f"{place}: {error}") from error


def nearest(name: str, known: Iterable[str]) -> str:
    """``; did you mean 'x'?`` or the list of what there is."""
    choices = sorted(known)
    close = difflib.get_close_matches(name, choices, n=1, cutoff=0.5)
    return f"did you mean '{close[0]}'?" if close else f"there are: {', '.join(choices) or 'none'}"


def _refuse_unknown(data: Any, type_: Any, place: str) -> None:
    """msgspec names an unknown key but not the right one: walk the data beside the types first. No number is not finite."""
    if isinstance(data, float) and not math.isfinite(data):
        raise BadInput(f"{place}: {data} is no number to work with")
    origin = get_origin(type_)
    if isinstance(type_, type) and issubclass(type_, msgspec.Struct) and isinstance(data, dict):
        hints = get_type_hints(type_)
        for key, value in data.items():
            if key not in hints:
                raise BadInput(f"{place}: unknown key '{key}'; {nearest(str(key), hints)}")
            _refuse_unknown(value, hints[key], f"{place}: {key}")
    elif origin is dict and isinstance(data, dict):
        for key, value in data.items():
            _refuse_unknown(value, get_args(type_)[1], f"{place}: {key}")
    elif origin in (list, tuple) and isinstance(data, list):
        for index, value in enumerate(data):
            _refuse_unknown(value, get_args(type_)[0], f"{place}[{index}]")
    elif origin is not None:
        for argument in get_args(type_):
            if isinstance(argument, type) and (issubclass(argument, msgspec.Struct) or isinstance(data, float)):
                _refuse_unknown(data, argument, place)
