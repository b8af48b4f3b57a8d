"""Typed data from YAML: unknown keys and wrong values end in one line that names the place and the mend."""

import difflib
import itertools
import math
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, NamedTuple, TypeVar, Union, get_args, get_origin

import msgspec
import yaml
from yaml.composer import Composer
from yaml.constructor import SafeConstructor
from yaml.resolver import Resolver

from uvf.models.keys import hints_of
from uvf.models.refused_value import in_words
from uvf.models.renamed import new_name

T = TypeVar("T")
Key = str | int
VALUES = 100_000
"""Most of a YAML file; reading one of so many takes a minute."""

LISTED, KEYS_LISTED, LONGEST_NAME = 10, 40, 100  # names, keys of a section, letters
ALIKE = 0.6  # of the letters, for a name to be meant by another


class BadInput(Exception):
    """Something from outside (file, argument, message) is wrong; the text says what, where and how to mend it.

    In one line: names that it quotes may hold line ends.
    """

    def __init__(self, text: str) -> None:
        super().__init__(" ".join(text.splitlines()))


class FileLocation(NamedTuple):
    """A spot in a file of data. As text: ``file:line: vehicles: burger: job: mission[4]``."""

    file: str
    keys: tuple[Key, ...] = ()

    def at(self, *keys: Key) -> "FileLocation":
        """The spot below this one that ``keys`` lead to."""
        return FileLocation(self.file, (*self.keys, *keys))

    def __str__(self) -> str:
        line = _line(self.file, self.keys)
        text = f"{self.file}:{line}" if line else self.file
        for i, key in enumerate(self.keys):
            text += f"[{key}]" if isinstance(key, int) and i > 0 else f": {key}"
        return text


class _Rules(SafeConstructor, Resolver):
    """YAML 1.2 where 1.1 surprises: ``1e3`` is a number, ``010`` is ten, ``1:30`` not ninety, ``2026-11-28`` a name.

    A key given twice is an error. Aliases cannot make a small file huge.
    """

    def get_single_node(self) -> Any:
        node = super().get_single_node()  # type: ignore[misc]
        if node is not None:
            _count(node, {})
        return node

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        seen = set()
        for key, _ in node.value if isinstance(node, yaml.MappingNode) else ():
            if not isinstance(key, yaml.ScalarNode):
                raise _refused("a key is a list or a mapping; write a name or a number", key)
            if key.value in seen and key.value != "<<":
                raise _refused(f"key '{key.value}' is given twice", key)
            seen.add(key.value)
        return super().construct_mapping(node, deep)


def _integer(loader: yaml.SafeLoader, node: yaml.ScalarNode) -> int:
    text = loader.construct_scalar(node)
    return int(text, 0) if text[:2] in ("0x", "0o") else int(text)


# The numbers of YAML 1.2.2, 10.3.2, and no dates: anything else that looks like one is text.
_INT, _FLOAT, _DATE, _DIGITS = "tag:yaml.org,2002:int", "tag:yaml.org,2002:float", "tag:yaml.org,2002:timestamp", "-+0123456789."
_Rules.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in known if tag not in (_INT, _FLOAT, _DATE)]
    for first, known in Resolver.yaml_implicit_resolvers.items()
}
_Rules.add_implicit_resolver(_INT, re.compile(r"([-+]?\d+|0o[0-7]+|0x[0-9a-fA-F]+)\Z"), list(_DIGITS))
_Rules.add_implicit_resolver(
    _FLOAT, re.compile(r"([-+]?(\.\d+|\d+(\.\d*)?)([eE][-+]?\d+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN))\Z"), list(_DIGITS)
)
_Rules.add_constructor(_INT, _integer)


class _Loader(_Rules, Composer, yaml.CSafeLoader):
    """Parses in C, which is five times as fast, and composes in Python: libyaml's own composer ends the process at a deep nesting."""

    def __init__(self, stream: str) -> None:
        yaml.CSafeLoader.__init__(self, stream)
        Composer.__init__(self)


class _LenientLoader(_Loader):
    """As ROS' parameter servers read: of a key given twice the last counts."""

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        return yaml.SafeLoader.construct_mapping(self, node, deep)


class _ExactLoader(_Rules, yaml.SafeLoader):
    """Parses in Python: it names the line of a mistake where libyaml names the one behind it."""


def _count(node: Any, counts: dict[int, int]) -> int:
    """How many values a node stands for, what is repeated by ``*name`` counted each time; ``counts`` holds those looked at, by id."""
    if id(node) not in counts:
        counts[id(node)] = 0
        entries = node.value if isinstance(node.value, list) else ()
        inner = itertools.chain.from_iterable(entries) if isinstance(node, yaml.MappingNode) else entries
        counts[id(node)] = 1 + sum(_count(each, counts) for each in inner)
    if counts[id(node)] == 0:
        raise _refused("it contains itself; write out what is meant", node)
    if counts[id(node)] > VALUES:
        raise _refused(f"more than {VALUES} values, counting what is repeated by *name or <<; split the file or repeat less", node)
    return counts[id(node)]


def _refused(why: str, node: Any) -> yaml.MarkedYAMLError:
    return yaml.constructor.ConstructorError(None, None, why, node.start_mark)


def load_yaml(path: Path, type_: type[T], fill: Callable[[Any, FileLocation], Any] | None = None) -> T:
    """Reads a YAML file into a msgspec Struct; ``fill`` puts in beforehand what the file only refers to. Raises BadInput."""
    data = read_yaml(path)
    try:
        return convert(fill(data, FileLocation(str(path))) if fill else data, type_, str(path))
    except RecursionError as error:
        raise BadInput(f"{path}: nested too deeply") from error


def read_yaml(path: Path, lenient: bool = False) -> Any:
    """Plain data of a YAML file; lenient: of keys given twice the last counts, as in files of other programs. Raises BadInput."""
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise BadInput(f"{path}: cannot be read: it is not text in UTF-8") from error
    return parse_yaml(text, str(path), lenient)


def parse_yaml(text: str, name: str, lenient: bool = False) -> Any:
    """Plain data of the text of a YAML file called ``name``; lenient: as ``read_yaml``. Raises BadInput."""
    try:
        data = yaml.load(text, _LenientLoader) if lenient else _data(text)
    except RecursionError as error:
        raise BadInput(f"{name}: nested too deeply") from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{name}:{mark.line + 1}" if mark else name
        raise BadInput(f"{place}: not valid YAML: {_one_line(getattr(error, 'problem', None) or error)}") from error
    except (ValueError, TypeError, AttributeError) as error:  # what PyYAML lets through: !!int x, !!timestamp x
        raise BadInput(f"{name}: not valid YAML: {_one_line(error)}") from error
    if data is None:
        raise BadInput(f"{name}: the file is empty")
    return data


def _data(text: str) -> Any:
    try:
        return yaml.load(text, _Loader)
    except yaml.YAMLError:
        return yaml.load(text, _ExactLoader)


def convert(data: Any, type_: type[T], file: str, keys: tuple[Key, ...] = ()) -> T:
    """Converts plain data, which came from ``keys`` of ``file``, into ``type_``. Raises BadInput."""
    data = _with_kinds(data, type_)
    _check(data, type_, FileLocation(file, keys))
    return msgspec.convert(data, type_)


def _with_kinds(data: Any, hint: Any) -> Any:
    """The data of a struct, and of the structs in it, with each kind that may be left out: it is the first of its union."""
    bare = get_args(hint)[0] if get_origin(hint) is Annotated else hint
    if not isinstance(data, dict):
        return data
    if kinds := _kinds(bare):
        data = {_tag_field(kinds): next(iter(kinds)), **data}
        bare = kinds.get(str(data[_tag_field(kinds)]))
    elif get_origin(bare) in (Union, UnionType):
        return _with_kinds(data, next(a for a in get_args(bare) if a is not type(None)))
    if not (isinstance(bare, type) and issubclass(bare, msgspec.Struct)):
        return data
    hints = hints_of(bare)
    return {key: _with_kinds(value, hints[key]) if key in hints else value for key, value in data.items()}


def nearest(name: str, known: Iterable[str], most: int = LISTED) -> str:
    """Hint for an unknown name: ``did you mean 'x'?``, or the list of what there is, ``most`` of it at most."""
    choices = sorted(known)
    if (now := new_name(name)).partition(":")[0] in choices:
        return f"it is called '{now}' now"
    close = difflib.get_close_matches(name, choices, n=1, cutoff=ALIKE)
    return f"did you mean '{_short(close[0])}'?" if close else f"there are: {listed(choices, most) or 'none'}"


def listed(names: Iterable[str], most: int = LISTED) -> str:
    """Names as ``a, b and 3 more``: never too long to be read or to be sent."""
    known = list(names)
    more = f" and {len(known) - most} more" if len(known) > most else ""
    return ", ".join(map(_short, known[:most])) + more


def _short(name: str) -> str:
    return name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 1]}…"


def _check(data: Any, hint: Any, place: FileLocation) -> None:
    """Inner parts first, so that what is refused is named where it stands; no number is not finite."""
    hint = _of_kind(data, hint, place)
    for key, value, inner in _parts(data, hint, place):
        _check(value, inner, place.at(key))
    if isinstance(data, float) and not math.isfinite(data):
        raise BadInput(f"{place}: {data} is no number to work with")
    bare = get_args(hint)[0] if get_origin(hint) is Annotated else hint
    if isinstance(data, str) and get_origin(bare) is Literal and data not in get_args(bare):
        raise BadInput(f"{place}: no '{data}' here; {nearest(data, map(str, get_args(bare)))}")
    try:
        msgspec.convert(data, hint)
    except msgspec.ValidationError as error:
        raise BadInput(f"{place}: {in_words(data, hint, str(error).partition(' - at `')[0])}") from error


def _of_kind(data: Any, hint: Any, place: FileLocation) -> Any:
    """Of a union of structs that one key tells apart (msgspec's tag), the one that this key names; any other type as it is."""
    kinds = _kinds(get_args(hint)[0] if get_origin(hint) is Annotated else hint)
    if not kinds or not isinstance(data, dict):
        return hint
    key = _tag_field(kinds)
    named = str(data.get(key))
    if named not in kinds:
        raise BadInput(f"{place.at(key)}: no '{named}' here; {nearest(named, kinds)}")
    return kinds[named]


def _kinds(bare: Any) -> dict[str, type[msgspec.Struct]]:
    """The structs of a union that a key tells apart, by what it says; empty for any other type."""
    if get_origin(bare) not in (Union, UnionType):
        return {}
    structs = [kind for kind in get_args(bare) if isinstance(kind, type) and issubclass(kind, msgspec.Struct)]
    return {str(kind.__struct_config__.tag): kind for kind in structs} if len(structs) > 1 else {}


def _tag_field(kinds: dict[str, type[msgspec.Struct]]) -> str:
    return str(next(iter(kinds.values())).__struct_config__.tag_field)


def _parts(data: Any, hint: Any, place: FileLocation) -> Iterator[tuple[Any, Any, Any]]:
    """(key, value, type) of what ``data`` consists of, as far as it has the shape of its type."""
    origin = get_origin(hint)
    if origin is Annotated:
        yield from _parts(data, get_args(hint)[0], place)
    elif origin in (Union, UnionType):
        if data is not None:
            yield from _parts(data, next(a for a in get_args(hint) if a is not type(None)), place)
    elif isinstance(data, dict) and isinstance(hint, type) and issubclass(hint, msgspec.Struct):
        hints = hints_of(hint)
        kind = hint.__struct_config__.tag_field
        for key, value in data.items():
            if key == kind:
                continue
            if key not in hints:
                known = [*hints, *([kind] if kind else [])]
                raise BadInput(f"{place.at(key)}: unknown key '{key}'; {nearest(str(key), known, KEYS_LISTED)}")
            yield key, value, hints[key]
    elif isinstance(data, dict) and origin is dict:
        names, values = get_args(hint)
        for key, value in data.items():
            yield key, key, names
            yield key, value, values
    elif isinstance(data, list) and origin in (list, tuple):
        types = get_args(hint)
        whole = origin is tuple and len(types) == len(data) and types[-1] is not Ellipsis
        yield from zip(itertools.count(), data, types if whole else itertools.repeat(types[0]), strict=False)


def _line(file: str, keys: tuple[Key, ...]) -> int:
    """The line of a spot in a YAML file, or of the nearest part about it that is written there; 0 = unknown."""
    try:
        node = yaml.compose(Path(file).read_text(encoding="utf-8"), _Loader)
    except (OSError, ValueError, yaml.YAMLError):
        return 0
    if node is None:
        return 0
    line: int = node.start_mark.line + 1 if keys else 0
    for key in keys:
        found = _inside(node, key)
        if found is None:
            break
        line, node = found
    return line


def _inside(node: Any, key: Key) -> tuple[int, Any] | None:
    """(line, node) of one entry of a mapping or a sequence."""
    if isinstance(node, yaml.MappingNode):
        return next(((k.start_mark.line + 1, v) for k, v in node.value if k.value == str(key)), None)
    if isinstance(node, yaml.SequenceNode) and isinstance(key, int) and key < len(node.value):
        return node.value[key].start_mark.line + 1, node.value[key]
    return None


def _one_line(text: object) -> str:
    return " ".join(str(text).split())
