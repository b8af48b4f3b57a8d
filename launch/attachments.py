"""The files that a log brings along, so that it can be replayed alone: mission, recorded drives, programs, world, vehicles."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from uvf.models.mission.extending import EXTENDS, whole_mission
from uvf.models.mission.tasks import walk
from uvf.models.scenario import Scenario
from uvf.models.vehicle.layers import folders_of

COMMON = "common"  # in vehicles/: parts that several vehicles include


def attachments(site: Scenario) -> dict[str, bytes]:
    """The files that define the run (mission, world, vehicles) by their paths below the project's folder."""
    named = _named_files(site)
    files: dict[str, Path] = {}
    folders = {f"worlds/{site.mission.world}": site.world_folder}
    vehicles = {folder for member in site.members.values() for folder in (*folders_of(member.folder), member.folder.parent / COMMON)}
    folders |= {f"vehicles/{folder.name}": folder for folder in sorted(vehicles)}
    for name, folder in folders.items():
        files |= {f"{name}/{path.relative_to(folder)}": path for path in sorted(folder.rglob("*")) if path.is_file()}
    mission = {f"missions/{site.mission_path.name}": _mission_text(site, named)}
    return mission | {name: path.read_bytes() for name, path in {**files, **named}.items()}


def _named_files(site: Scenario) -> dict[str, Path]:
    """The recorded drives and the programs of a mission, by the names that they have as attachments."""
    tracks = {task.drive.track for task in walk(site.mission.tasks) if task.drive is not None}
    programs = {member.entry.program for member in site.members.values() if member.entry.program is not None}
    return {
        f"{folder}/{n}-{Path(name).name}": site.mission_path.parent / name
        for folder, names in (("tracks", tracks), ("programs", programs))
        for n, name in enumerate(sorted(names))
    }


def _mission_text(site: Scenario, named: Mapping[str, Path]) -> bytes:
    """As it is written; one that extends another, or names files, as a whole that finds them beside it."""
    text = site.mission_path.read_bytes()
    if not named and EXTENDS not in yaml.safe_load(text):
        return text
    data = whole_mission(site.mission_path)
    places = {os.path.normpath(path): f"../{name}" for name, path in named.items()}
    whole: str = yaml.safe_dump(_renamed(data, site.mission_path.parent, places), sort_keys=False)
    return whole.encode()


def _renamed(data: Any, folder: Path, places: Mapping[str, str]) -> Any:
    if isinstance(data, list):
        return [_renamed(each, folder, places) for each in data]
    if isinstance(data, dict):
        return {key: _renamed(value, folder, places) for key, value in data.items()}
    return places.get(os.path.normpath(folder / data), data) if isinstance(data, str) and data else data
