"""``docs/reference/keys.md``: every key of mission, world and vehicle files, and the measures of criteria."""

import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

import msgspec

from launch.docs.tables import anchor, keys_of, parts_of, table
from launch.scoring.finding import Finding
from launch.scoring.scores import MEASURES
from launch.scoring.task_measures import TASK_MEASURES
from uvf.models.mission.file import MissionFile
from uvf.models.vehicle.file import VehicleFile
from uvf.models.world.file import WorldFile

HEAD = """# Every key of mission, world and vehicle files

Generated from the types in `src/uvf/models` and the measures in `launch/scoring/scores.py` by `python -m launch.docs.pages`; do not edit.

SI units and radians throughout; the unit of a number stands beside it. Positions are in the `world` frame (ENU: x east, y north, z up)
unless the meaning says otherwise. A key that is not listed here is an error, which names the nearest one that is.
To begin, copy the nearest file in `missions/`, `worlds/` or `vehicles/`.

A mission file may begin with `extends: NAME`, the path of another mission without `.yaml`: then it holds only what differs. Mappings are
merged key by key; lists and values stand for those of the other file, and null takes a key out.
"""
FILES: tuple[tuple[str, type[msgspec.Struct], str], ...] = (
    ("Mission file", MissionFile, "`missions/<name>.yaml`: a world, vehicles with starts and jobs, and criteria."),
    ("World file", WorldFile, "`worlds/<name>/world.yaml`: walls, things, ground, wind, and where on Earth they are."),
    ("Vehicle file", VehicleFile, "`vehicles/<name>/vehicle.yaml`: body, limits, sensors, parameters."),
)


class Measure(NamedTuple):
    """A measure as its docstring describes it."""

    name: str
    meaning: str
    unit: str
    counts: str


def render() -> str:
    """Renders the whole page."""
    links: dict[type, str] = {}
    for _, root, _ in FILES:
        for struct, path in _sections(root, "", set()):
            links.setdefault(struct, path or anchor(root))
    lines, written = [HEAD], set[type]()
    for title, root, about in FILES:
        lines += [f"## {title} {{#{anchor(root)}}}", "", about, ""]
        for struct, _ in _sections(root, "", set()):
            if struct in written:
                continue
            written.add(struct)
            if struct is not root:
                lines += [f"### `{links[struct]}` {{#{anchor(struct)}}}", "", f"{_about(struct)}", ""]
            lines += [*table(struct, links), ""]
    return "\n".join([*lines, *_measures()]) + "\n"


def structs() -> Iterator[type[msgspec.Struct]]:
    """Every struct that a file can hold."""
    for _, root, _ in FILES:
        yield from (struct for struct, _ in _sections(root, "", set()))


def _sections(struct: type[msgspec.Struct], path: str, seen: set[type]) -> Iterator[tuple[type[msgspec.Struct], str]]:
    if struct in seen:
        return
    seen.add(struct)
    yield struct, path
    for key in keys_of(struct):
        for inner in parts_of(key.hint):
            yield from _sections(inner, f"{path}.{key.name}" if path else key.name, seen)


def _about(struct: type[msgspec.Struct]) -> str:
    return " ".join((struct.__doc__ or "").split()).replace("``", "`")


def measures() -> list[Measure]:
    """All measures of vehicles. Raises ValueError for a docstring that does not say unit or time."""
    return [_measure(name, function) for name, function in MEASURES.items()]


def task_measures() -> list[Measure]:
    """All measures of tasks. Raises ValueError as ``measures``."""
    return [_measure(name, function) for name, function in TASK_MEASURES.items()]


def _measure(name: str, function: Callable[..., Finding]) -> Measure:
    said = " ".join((function.__doc__ or "").split())
    found = re.fullmatch(r"(?P<meaning>.*?) \[(?P<unit>[^\]]+)\]\. (?P<counts>Counts .*)", said)
    if found is None:
        raise ValueError(f"measure {name}: its docstring must read 'Meaning [unit].', then 'Counts over ...'")
    return Measure(name, **found.groupdict())


def _measures() -> Iterator[str]:
    yield from ("## Measures {#measures}", "")
    yield from ("What a criterion of a mission can measure. Motion is measured on the truth, not on the vehicle's estimate of it.", "")
    yield from ("| measure | meaning | unit | counts |", "|---|---|---|---|")
    yield from (f"| `{m.name}` | {m.meaning}. | {m.unit} | {m.counts.removeprefix('Counts ')} |" for m in measures())
    yield from ("", "Of a task, named by `task` instead of `vehicle`:", "", "| measure | meaning | unit | counts |", "|---|---|---|---|")
    yield from (f"| `{m.name}` | {m.meaning}. | {m.unit} | {m.counts.removeprefix('Counts ')} |" for m in task_measures())
