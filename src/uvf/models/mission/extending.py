"""``extends:`` of a mission file: another mission, of which only what differs is written down."""

import os
from pathlib import Path
from typing import Any

from uvf.models.yaml_data import BadInput, FileLocation, nearest, read_yaml

EXTENDS = "extends"
REFERENCES = ("track", "program", "known", "continues", "keepout", "speed")
"""Keys whose texts may be paths relative to the mission file's folder."""
LONGEST_CHAIN = 5
ENDINGS = (".yaml", ".yml")


def whole_mission(path: Path) -> Any:
    """Plain data of a mission file, put into that which it extends; paths are relative to the folder of ``path``. Raises BadInput."""
    return _whole(path, ())


def _whole(path: Path, before: tuple[Path, ...]) -> Any:
    data = read_yaml(path)
    if not isinstance(data, dict) or EXTENDS not in data:
        return data
    place = FileLocation(str(path)).at(EXTENDS)
    name = data[EXTENDS]
    if not isinstance(name, str) or not name:
        raise BadInput(f"{place}: name the mission file that is extended, as 'dubins' or '../dubins.yaml'")
    base = (path.parent / (name if name.endswith(ENDINGS) else f"{name}.yaml")).resolve()
    if base in (path.resolve(), *before) or len(before) >= LONGEST_CHAIN:
        raise BadInput(f"{place}: {name} leads round in a circle, or over more than {LONGEST_CHAIN} files")
    if not base.is_file():
        known = [each.stem for each in base.parent.glob("*.yaml")] if base.parent.is_dir() else []
        raise BadInput(f"{place}: no mission '{name}' there; {nearest(base.stem, known)}")
    found = _moved(_whole(base, (*before, path.resolve())), base.parent, path.parent)
    return merge(found, {key: value for key, value in data.items() if key != EXTENDS})


def merge(base: Any, change: Any) -> Any:
    """``change`` put into ``base``: mappings key by key, everything else as a whole; null takes a key out."""
    if not isinstance(base, dict) or not isinstance(change, dict):
        return change
    changed = base | {key: merge(base.get(key), value) for key, value in change.items()}
    return {key: value for key, value in changed.items() if value is not None or key not in change}


def _moved(data: Any, was: Path, now: Path) -> Any:
    """The same data with its paths relative to another folder."""
    if isinstance(data, list):
        return [_moved(each, was, now) for each in data]
    if not isinstance(data, dict):
        return data
    return {key: _path(value, was, now) if key in REFERENCES else _moved(value, was, now) for key, value in data.items()}


def _path(value: Any, was: Path, now: Path) -> Any:
    if isinstance(value, str) and (was / value).is_file():
        return os.path.relpath((was / value).resolve(), now.resolve())
    return _moved(value, was, now)
