"""What a robot's makers state in the controllers' YAML beside its description: which joints drive it, how, and how fast."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

from uvf.models.importing.robot import ImportedDrive, StatedLimits, stated
from uvf.models.urdf.packages import enclosing_package
from uvf.models.yaml_data import BadInput, read_yaml

PACKAGE = "package.xml"
FOLDERS = ("config", "param", "params")
MOST_FILES, LARGEST = 200, 200_000  # bytes
SUBSTITUTED = re.compile(r"\$\([^)]*\)|\$\{[^}]*\}")
"""What a launch file would put in, such as the prefix of a robot's joints."""


def _keys(side: str) -> tuple[str, ...]:
    """Under which ROS' controllers name the joints of a side's wheels: of two-sided drives, then of mecanum wheels."""
    corners = [f"{end}_{side}_wheel" for end in ("front", "back", "rear")]
    both = (f"{side}_wheel", f"{side}_wheels_names", f"{side}_wheel_names", f"{side}_wheel_name")
    return (*both, *(f"{corner}{ending}" for corner in corners for ending in ("_joint", "_command_joint_name", "_joint_name", "")))


LEFT, RIGHT = _keys("left"), _keys("right")


class _Section(NamedTuple):
    """A mapping of a file, and the keys under which it stands."""

    keys: tuple[str, ...]
    data: Mapping[str, Any]


def drive_of_controllers(description: Path, joints: Sequence[str]) -> ImportedDrive:
    """The controller that drives one of these joints, of those in the packages beside that of the description."""
    general: StatedLimits | None = None
    for path in _files(description):
        try:
            sections = list(_sections(read_yaml(path, lenient=True)))
        except BadInput:
            continue  # of another program, with tags of its own
        for section in sections:
            left, right = (tuple(_named(section.data, keys, joints)) for keys in (LEFT, RIGHT))
            if left or right:
                sideways = "mecanum" in " ".join((*section.keys, str(section.data.get("type", "")))).lower()
                limits = _limits(section.data, path.name).filled_by(general or StatedLimits())
                return ImportedDrive(left, right, limits=limits, has_rollers=sideways)
            general = general or _general_limits(section.data, path.name)
    return ImportedDrive()


def with_controllers(drive: ImportedDrive, stated_there: ImportedDrive) -> ImportedDrive:
    """A plugin's drive, completed by what the controllers state."""
    limits = drive.limits.filled_by(stated_there.limits)
    joints = (drive.left, drive.right) if drive.left or drive.right else (stated_there.left, stated_there.right)
    return replace(drive, left=joints[0], right=joints[1], limits=limits, has_rollers=drive.has_rollers or stated_there.has_rollers)


def _files(description: Path) -> Iterator[Path]:
    """YAML files for parameters, of the description's package first, then of those beside it."""
    package = enclosing_package(description.resolve())
    if package is None:
        return
    beside = sorted(folder.parent for folder in package.parent.glob(f"*/{PACKAGE}") if folder.parent != package)
    found = (path for folder in (package, *beside) for path in sorted(folder.rglob("*.yaml")) if _is_parameters(path, folder))
    yield from (path for path in islice(found, MOST_FILES) if path.stat().st_size <= LARGEST)


def _is_parameters(path: Path, package: Path) -> bool:
    return path.is_file() and any(part in FOLDERS for part in path.relative_to(package).parts[:-1])


def _sections(data: Any, keys: tuple[str, ...] = ()) -> Iterator[_Section]:
    """Every mapping in it, the inner ones first."""
    if isinstance(data, dict):
        for key, value in data.items():
            yield from _sections(value, (*keys, str(key)))
        yield _Section(keys, data)


def _named(controller: Mapping[str, Any], keys: Sequence[str], joints: Sequence[str]) -> Iterator[str]:
    """Those of the robot's joints that it names; what a launch file puts before a name may be anything."""
    for key in keys:
        named = controller.get(key)
        for name in named if isinstance(named, list) else [named] if isinstance(named, str) else []:
            rest = SUBSTITUTED.sub("", str(name))
            own = [joint for joint in joints if joint == rest] or [j for j in joints if rest and rest != str(name) and j.endswith(rest)]
            yield from own[:1]


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


def _general_limits(data: Mapping[str, Any], source: str) -> StatedLimits | None:
    """Of a section that states them for the robot as a whole."""
    linear, angular = stated(data.get("linear_speed_limit")), stated(data.get("angular_speed_limit"))
    return None if linear is None and angular is None else StatedLimits(linear, angular, source=source)
