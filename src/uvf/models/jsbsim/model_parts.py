"""The files that a JSBSim model is made of, and the properties that they read."""

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from uvf.models.yaml_data import BadInput

SECTIONS = (
    *("metrics", "mass_balance", "ground_reactions", "external_reactions", "buoyant_forces", "propulsion", "aerodynamics"),
    *("flight_control", "autopilot"),
)
READERS = ("property", "independentVar", "input")
COMPARED = re.compile(r"^\s*-?(/?[A-Za-z][\w/\[\]-]*)\s*(?:==|!=|<=|>=|<|>|\b(?:eq|ne|le|ge|lt|gt)\b)", re.IGNORECASE | re.MULTILINE)
"""What stands on the left of a condition in a <test>."""
OUTSIDE = re.compile(r"-?(/[A-Za-z][\w/\[\]-]*)")
"""A property of a surrounding program, which any tag may name."""


class Unmade(BadInput):
    """A property that the model reads and nothing makes."""

    def __init__(self, text: str, name: str) -> None:
        super().__init__(text)
        self.name = name


class ModelPart(NamedTuple):
    """A file that the file ``by`` refers to in a tag of this ``kind``.

    found: its path, None when it is nowhere; folders: where it may lie, best first.
    """

    kind: str
    name: str
    by: Path
    found: Path | None
    folders: tuple[Path, ...]


def parts(path: Path) -> list[ModelPart]:
    """Files that the model at ``path`` refers to, and those that these refer to. Raises BadInput for what is no XML."""
    gathered: list[ModelPart] = []
    waiting, seen = [path], {path}
    while waiting:
        by = waiting.pop(0)
        for tag in read(by).iter():
            if (name := tag.get("file")) and (folders := _folders(tag.tag, path)):
                gathered.append(part := ModelPart(tag.tag, name, by, _find(name, folders), folders))
                if part.found is not None and part.found not in seen:
                    seen.add(part.found)
                    waiting.append(part.found)
    return gathered


def _folders(kind: str, path: Path) -> tuple[Path, ...]:
    """Where JSBSim looks; with the layout of its own distribution (aircraft/NAME, engine, systems) too."""
    own, around = path.parent, (path.parent.parent, path.parent.parent.parent)
    if kind in ("engine", "thruster"):
        return (*(own / name for name in ("Engines", "engines", "engine")), *(folder / "engine" for folder in around), own)
    if kind == "system":
        return (*(own / name for name in ("Systems", "systems")), *(folder / "systems" for folder in around), own)
    return (own,) if kind in SECTIONS else ()


def _find(name: str, folders: tuple[Path, ...]) -> Path | None:
    plain = name.removesuffix(".xml")
    return next((p for p in (folder / f"{plain}.xml" for folder in folders) if p.is_file()), None)


def read(path: Path) -> ElementTree.Element:
    """Root element of an XML file. Raises BadInput."""
    try:
        return ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        raise BadInput(f"{path}:{error.position[0]}: not valid XML: {error}; mend the tag there") from error
    except (OSError, ValueError, LookupError) as error:  # a folder, an encoding that there is not
        raise BadInput(f"{path}: cannot be read: {error}") from error


def properties_read(path: Path) -> dict[str, Path]:
    """Name of each property that the model reads, and the file that reads it first. Raises BadInput."""
    files = dict.fromkeys([path, *(part.found for part in parts(path) if part.found is not None)])
    names: dict[str, Path] = {}
    for file in files:
        for name in _read_by(read(file)):
            names.setdefault(name, file)
    return names


def _read_by(model: ElementTree.Element) -> Iterator[str]:
    declared = {id(tag) for holder in (model, *model) for tag in holder.findall("property")}  # made here, not read
    for tag in model.iter():
        text = (tag.text or "").strip()
        if tag.tag in READERS and id(tag) not in declared and (name := text.lstrip("-")) and math.isnan(number(name)):
            yield name
        elif outside := OUTSIDE.fullmatch(text):
            yield outside[1]
        if tag.tag == "test":
            yield from COMPARED.findall(text)


def number(text: str) -> float:
    """The number that a text holds, not converted from its tag's unit ([ft], [lbs] ...); nan where it holds none."""
    try:
        return float(text)
    except ValueError:
        return math.nan
