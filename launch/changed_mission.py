"""``--set``: a mission of which some values are others, as a file that extends it, so that the run can be repeated."""

import os
import re
import tempfile
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

import yaml

from uvf.models.mission.extending import EXTENDS, whole_mission
from uvf.models.scenario import Scenario, load_scenario
from uvf.models.whole_file import write_whole
from uvf.models.yaml_data import BadInput, nearest, parse_yaml

NULL = ("null", "~")
"""What takes a key out."""


def changed_mission(base: Path, settings: list[str], folder: Path) -> Path:
    """Writes a mission like ``base`` with other values (``vehicles.rover.model=burger``) into ``folder``; its path. Raises BadInput.

    A file of that name that is there already stays as it is.
    """
    if not settings:
        return base
    whole: Any = None
    change: dict[str, Any] = {}
    for setting in settings:
        keys, value = _parsed(setting)
        if value is None:
            whole = whole_mission(base) if whole is None else whole
            _check_there(whole, keys, setting)
        _put(change, keys, value)
    path = next(path for path in _names(base, folder) if not path.exists())
    extends = os.path.relpath(base.resolve(), folder.resolve())
    write_whole(path, yaml.safe_dump({EXTENDS: extends, **change}, sort_keys=False).encode())
    return path


def load_changed(base: Path, settings: list[str]) -> Scenario:
    """The mission with those values, before there is a folder for its run. Raises BadInput."""
    if not settings:
        return load_scenario(base)
    with tempfile.TemporaryDirectory() as folder:
        path = changed_mission(base, settings, Path(folder))
        try:
            return load_scenario(path)
        except BadInput as error:
            raise BadInput(re.sub(rf"{re.escape(str(path))}(:\d+)?", f"{base} as --set changes it", str(error))) from error


def _names(base: Path, folder: Path) -> Iterator[Path]:
    yield folder / base.name
    yield from (folder / f"{base.stem}-{n}{base.suffix}" for n in count(1))


def _parsed(setting: str) -> tuple[list[str], Any]:
    """``a.b=1`` -> ["a", "b"], 1. Raises BadInput."""
    keys, equals, text = setting.partition("=")
    names = [name.strip() for name in keys.split(".")]
    if not equals or not all(names):
        raise BadInput(f"--set {setting}: write it as vehicles.rover.model=burger")
    return names, _value(text, keys)


def _put(change: dict[str, Any], keys: list[str], value: Any) -> None:
    """Puts a value into nested mappings; what stood in its place does no more."""
    *outer, last = keys
    for key in outer:
        if not isinstance(change.get(key), dict):
            change[key] = {}
        change = change[key]
    change[last] = value


def _check_there(data: Any, keys: list[str], setting: str) -> None:
    """Raises BadInput where there is nothing that could be taken out."""
    for key in keys:
        if not isinstance(data, dict) or key not in data:
            known = data if isinstance(data, dict) else ()
            raise BadInput(f"--set {setting}: the mission has no '{key}' there; {nearest(key, known)}")
        data = data[key]


def _value(text: str, keys: str) -> Any:
    """What is written behind the ``=``. Raises BadInput."""
    if text.strip() in NULL:
        return None
    if text.lstrip().startswith("#"):
        raise BadInput(f"--set {keys}: a comment begins with '#'; put the text into quotes")
    return parse_yaml(text, f"--set {keys}") if text.strip() else ""
