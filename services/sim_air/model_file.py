"""Looks through a JSBSim model before the engine does, which ends the process at some mistakes and keeps silent at others."""

import math
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from uvf.runtime.params import BadInput

SECTIONS = ("metrics", "mass_balance", "ground_reactions", "aerodynamics")
ABOVE_ZERO = (
    "metrics/wingarea",
    "metrics/wingspan",
    "metrics/chord",
    *(f"mass_balance/{name}" for name in ("ixx", "iyy", "izz", "emptywt")),
)
READERS = ("property", "independentVar", "input")


def check_model(path: Path) -> None:
    """The file is XML, has the sections without which nothing flies, and mass, inertia and sizes above zero. Raises BadInput."""
    model = read(path)
    if model.tag != "fdm_config":
        raise BadInput(f"{path}: the outermost tag is <{model.tag}>; a JSBSim model begins with <fdm_config>")
    for section in SECTIONS:
        if model.find(section) is None:
            raise BadInput(f"{path}: there is no <{section}> section; add it")
    for tag in ABOVE_ZERO:
        text = (model.findtext(tag) or "").strip()
        if not 0 < _number(text) < math.inf:
            raise BadInput(f"{path}: {tag.replace('/', ': ')} is '{text}'; it must be a number above zero")


def read(path: Path) -> ElementTree.Element:
    """The outermost element. Raises BadInput."""
    try:
        return ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        raise BadInput(f"{path}:{error.position[0]}: not valid XML: {error}; mend the tag there") from error
    except (OSError, ValueError, LookupError) as error:  # a folder, an encoding that there is not
        raise BadInput(f"{path}: cannot be read: {error}") from error


def properties_read(path: Path) -> Iterator[str]:
    """The names of what the model reads. Raises BadInput."""
    model = read(path)
    declared = {id(tag) for section in model for tag in section.findall("property")}  # made here, not read
    for tag in model.iter():
        if tag.tag in READERS and id(tag) not in declared and (name := (tag.text or "").strip().lstrip("-")) and math.isnan(_number(name)):
            yield name


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
