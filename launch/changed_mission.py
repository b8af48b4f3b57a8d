"""``--set``: a mission of which some values are others, as a file that extends it, so that the run can be repeated."""

import os
from pathlib import Path
from typing import Any

import yaml

from uvf.models.mission.extending import EXTENDS, merge
from uvf.models.whole_file import write_whole
from uvf.models.yaml_data import BadInput, parse_yaml

NULL = ("null", "~")
"""What takes a key out."""


def changed_mission(base: Path, settings: list[str], folder: Path) -> Path:
    """Writes a mission like ``base`` with other values (``vehicles.rover.model=burger``) into ``folder``; its path. Raises BadInput."""
    if not settings:
        return base
    change: Any = {}
    for setting in settings:
        change = merge(change, _change(setting))
    path = folder / base.name
    extends = os.path.relpath(base.resolve().with_suffix(""), folder.resolve())
    write_whole(path, yaml.safe_dump({EXTENDS: extends, **change}, sort_keys=False).encode())
    return path


def _change(setting: str) -> dict[str, Any]:
    """``a.b=1`` -> {"a": {"b": 1}}. Raises BadInput."""
    keys, equals, text = setting.partition("=")
    names = keys.strip().split(".")
    if not equals or not all(names):
        raise BadInput(f"--set {setting}: write it as vehicles.rover.model=burger")
    *outer, last = names
    found: dict[str, Any] = {last: _value(text, keys)}
    for name in reversed(outer):
        found = {name: found}
    return found


def _value(text: str, keys: str) -> Any:
    """What is written behind the ``=``. Raises BadInput."""
    if text.strip() in NULL:
        return None
    return parse_yaml(text, f"--set {keys}") if text.strip() else ""
