"""What a JSBSim model's file says of the size of its aircraft; nan, or nothing, where it does not say."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import nan
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]
METRES = {"M": 1.0, "FT": 0.3048, "IN": 0.0254, "CM": 0.01, "MM": 0.001, "KM": 1000.0}
AREAS = {f"{unit}2": length**2 for unit, length in METRES.items()}


@dataclass(frozen=True)
class Thruster:
    """An engine or propeller at ``place`` (3,) [m from the centre of gravity, FLU]; radius of the propeller [m], 0 of a jet."""

    place: Floats
    radius: float


@dataclass(frozen=True)
class Hull:
    """Hull of an airship: middle (3,) [m from the centre of gravity, FLU], and half its length, width and height (3,) [m]."""

    middle: Floats
    radii: Floats


@dataclass(frozen=True)
class Sizes:
    """Measures of an aircraft [m, m^2]; places are from the centre of gravity, FLU; nan where the file does not tell.

    aero: aerodynamic reference point (3,), which the wing's lift is given about; tail_arm: from there to the tail.
    """

    span: float
    area: float  # m^2
    chord: float
    tail_area: float
    tail_arm: float
    fin_area: float
    aero: Floats
    wheels: Floats  # (n, 3), their lowest points; those that are not drawn in
    structure: Floats  # (n, 3), other points that can touch the ground
    thrusters: tuple[Thruster, ...]
    hull: Hull | None


def sizes_of(path: Path) -> Sizes:
    """Measures that a JSBSim model's file tells, ``<folder>/<model>/<model>.xml``. Raises BadInput where it is no XML."""
    model = _root(path)
    metrics = _section(model, "metrics", path)
    cg = _centre_of_gravity(_section(model, "mass_balance", path))
    ground = [_section(model, "ground_reactions", path)]
    return Sizes(
        **{name: _metric(metrics, tag, METRES) for name, tag in (("span", "wingspan"), ("chord", "chord"), ("tail_arm", "htailarm"))},
        **{n: _metric(metrics, t, AREAS) for n, t in (("area", "wingarea"), ("tail_area", "htailarea"), ("fin_area", "vtailarea"))},
        aero=_flu(_named(metrics, "AERORP"), cg),
        wheels=_points((c for g in ground for c in g.findall("contact") if c.get("type") == "BOGEY" and not _retracts(c)), cg),
        structure=_points((c for g in ground for c in g.findall("contact") if c.get("type") != "BOGEY"), cg),
        thrusters=tuple(_thrusters(_section(model, "propulsion", path), path, cg)),
        hull=_hull(model, cg),
    )


def _root(path: Path) -> ElementTree.Element:
    try:
        return ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, OSError, ValueError, LookupError) as error:
        raise BadInput(f"{path}: cannot be read: {error}; 'uvf vehicle check' tells more") from error


def _section(model: ElementTree.Element, name: str, path: Path) -> ElementTree.Element:
    """Empty where there is none; from a file of its own where the model names one."""
    found = model.find(name)
    if found is None:
        return ElementTree.Element(name)
    if (file := found.get("file")) is not None:
        other = path.parent / f"{file.removesuffix('.xml')}.xml"
        return _root(other) if other.is_file() else found
    return found


def _number(text: str | None) -> float:
    try:
        return float(text or "")
    except ValueError:
        return nan


def _metric(metrics: ElementTree.Element, tag: str, units: dict[str, float]) -> float:
    """m or m^2, above zero; without a unit JSBSim takes feet."""
    found = metrics.find(tag)
    value = _number(found.text) * units.get(found.get("unit", "FT" if units is METRES else "FT2"), nan) if found is not None else nan
    return value if 0 < value < np.inf else nan


def _location(place: ElementTree.Element | None) -> Floats:
    """(3,) m in the structural frame: x aft, y right, z up; without a unit JSBSim takes inches."""
    if place is None:
        return np.full(3, nan)
    return np.array([_number(place.findtext(axis)) for axis in "xyz"]) * METRES.get(place.get("unit", "IN"), nan)


def _named(section: ElementTree.Element, name: str) -> Floats:
    return _location(next((place for place in section.findall("location") if place.get("name") == name), None))


def _centre_of_gravity(balance: ElementTree.Element) -> Floats:
    """With the point masses, without fuel; (3,) m, structural. The middle of the frame where nothing is said."""
    places, masses = [_named(balance, "CG")], [_mass(balance.find("emptywt"))]
    for point in balance.findall("pointmass"):
        places.append(_location(point.find("location")))
        masses.append(_mass(point.find("weight")))
    known = [(p, m) for p, m in zip(places, masses, strict=True) if np.isfinite(p).all() and m > 0]
    return np.average([p for p, _ in known], axis=0, weights=[m for _, m in known]) if known else np.zeros(3)


def _mass(weight: ElementTree.Element | None) -> float:
    """kg."""
    return _number(weight.text) * (1.0 if weight.get("unit") == "KG" else 0.45359237) if weight is not None else nan


def _flu(place: Floats, cg: Floats) -> Floats:
    """From the structural frame; the centre of gravity itself where the place is not known."""
    turned: Floats = (place - cg) * (-1.0, -1.0, 1.0)
    return turned if np.isfinite(turned).all() else np.zeros(3)


def _points(contacts: Iterator[ElementTree.Element], cg: Floats) -> Floats:
    places = [_location(contact.find("location")) for contact in contacts]
    return np.array([_flu(place, cg) for place in places if np.isfinite(place).all()]).reshape(-1, 3)


def _retracts(contact: ElementTree.Element) -> bool:
    return (contact.findtext("retractable") or "").strip().upper() in ("1", "RETRACT", "TRUE")


def _thrusters(propulsion: ElementTree.Element, path: Path, cg: Floats) -> Iterator[Thruster]:
    """In the order of the engines."""
    for engine in propulsion.findall("engine"):
        thruster = engine.find("thruster")
        place = _location(thruster.find("location")) if thruster is not None else np.full(3, nan)
        if not np.isfinite(place).all():
            place = _location(engine.find("location"))
        yield Thruster(_flu(place, cg), _radius(thruster.get("file", ""), path) if thruster is not None else 0.0)


def _radius(name: str, path: Path) -> float:
    """m, of a propeller; 0 of what is none or is in no file."""
    folders = (path.parent.parent / "engine", path.parent / "Engines", path.parent / "engines", path.parent / "engine", path.parent)
    found = next((file for f in folders if (file := f / f"{name.removesuffix('.xml')}.xml").is_file()), None)
    if not name or found is None:
        return 0.0
    propeller = _root(found)
    radius = _metric(propeller, "diameter", METRES) / 2
    return radius if propeller.tag == "propeller" and np.isfinite(radius) else 0.0


def _hull(model: ElementTree.Element, cg: Floats) -> Hull | None:
    """About all gas cells; ballonets lie within them."""
    cells = [(_flu(_location(cell.find("location")), cg), _radii(cell)) for cell in model.iterfind("buoyant_forces/gas_cell")]
    known = [(middle, radii) for middle, radii in cells if np.isfinite(radii).all()]
    if not known:
        return None
    low, high = np.min([m - r for m, r in known], axis=0), np.max([m + r for m, r in known], axis=0)
    return Hull((low + high) / 2, (high - low) / 2)


def _radii(cell: ElementTree.Element) -> Floats:
    """(3,) m, half of what it measures along each axis: ellipsoids, and cylinders along one of the axes."""
    halves = []
    for axis in "xyz":
        radius, width = _metric(cell, f"{axis}_radius", METRES), _metric(cell, f"{axis}_width", METRES)
        halves.append(np.nansum((radius, width / 2)) if np.isfinite((radius, width)).any() else nan)
    return np.array(halves)
