"""Limits of speed and acceleration that a robot's makers state: in the controllers' YAML beside its description."""

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

from uvf.models.importing.robot import StatedLimits, stated
from uvf.models.yaml_data import BadInput, read_yaml

PACKAGE = "package.xml"
FOLDERS = ("config", "param", "params")
MOST_FILES, LARGEST = 200, 200_000  # bytes
WHEELS = (
    *("left_wheel", "right_wheel", "left_wheel_names", "right_wheel_names"),
    *("left_wheels_names", "right_wheels_names", "left_wheel_name", "right_wheel_name"),
)
"""Keys under which ROS' controllers for differential drive name the joints."""
SUBSTITUTED = re.compile(r"\$\([^)]*\)")
"""What roslaunch would put in, such as the prefix of a robot's joints: none, by default."""


def limits_of_controllers(description: Path, joints: Sequence[str]) -> StatedLimits:
    """The limits of the controller that drives one of these joints, of those in the packages beside that of the description."""
    for path in _files(description):
        try:
            data = read_yaml(path)
        except BadInput:
            continue  # of another program, with tags of its own
        for controller in _sections(data):
            if set(joints) & set(_wheels(controller)):
                return _limits(controller, path.name)
    return StatedLimits()


def _files(description: Path) -> Iterator[Path]:
    """YAML files for parameters, of the description's package first, then of those beside it."""
    package = next((folder for folder in description.resolve().parents if (folder / PACKAGE).is_file()), None)
    if package is None:
        return
    beside = sorted(folder.parent for folder in package.parent.glob(f"*/{PACKAGE}") if folder.parent != package)
    found = (path for folder in (package, *beside) for name in FOLDERS for path in sorted((folder / name).rglob("*.yaml")))
    yield from (path for path in islice(found, MOST_FILES) if path.stat().st_size <= LARGEST)


def _sections(data: Any) -> Iterator[Mapping[str, Any]]:
    """Every mapping in it, the inner ones first."""
    if isinstance(data, dict):
        for value in data.values():
            yield from _sections(value)
        yield data


def _wheels(controller: Mapping[str, Any]) -> Iterator[str]:
    for key in WHEELS:
        named = controller.get(key)
        yield from (SUBSTITUTED.sub("", str(name)) for name in (named if isinstance(named, list) else [named] if named else []))


def _limits(controller: Mapping[str, Any], source: str) -> StatedLimits:
    linear, angular, fast, spinning = (
        _limit(controller, axis, kind) for kind in ("velocity", "acceleration") for axis in ("linear.x", "angular.z")
    )
    return StatedLimits(linear, angular, fast, spinning, source)


def _limit(controller: Mapping[str, Any], axis: str, kind: str) -> float | None:
    """Of ``linear: {x: {max_velocity: 1}}`` as in ROS 1, or ``linear.x.max_velocity: 1`` as in ROS 2; None where it is not in force."""
    outer, inner = axis.split(".")
    nested = controller.get(outer)
    section = nested.get(inner) if isinstance(nested, dict) else None
    told = section if isinstance(section, dict) else {}
    in_force = told.get(f"has_{kind}_limits", controller.get(f"{axis}.has_{kind}_limits", True))
    return stated(told.get(f"max_{kind}", controller.get(f"{axis}.max_{kind}"))) if in_force is not False else None
