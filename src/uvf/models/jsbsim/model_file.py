"""Looks through a JSBSim model before the engine does, which ends the process at some mistakes and keeps silent at others."""

import math
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from uvf.models.jsbsim.model_parts import number, parts, read
from uvf.models.yaml_data import BadInput, nearest

SECTIONS = ("metrics", "mass_balance", "ground_reactions", "aerodynamics")
ABOVE_ZERO = (
    "metrics/wingarea",
    "metrics/wingspan",
    "metrics/chord",
    *(f"mass_balance/{name}" for name in ("ixx", "iyy", "izz", "emptywt")),
)
ROUGH = 0.5  # share by which published inertias miss what is possible; the engine flies them
MASS = {"LBS": 0.45359237, "KG": 1.0}  # kg
CASTER = 360.0  # deg, of a wheel that turns freely
CASTER = 360.0  # deg, of a wheel that turns freely
FT2 = 0.3048**2  # m^2
SLUG_FT2 = 1.3558179619  # kg m^2


def check_model(path: Path) -> None:
    """Checks a JSBSim model. Raises BadInput with the first of its faults."""
    for fault in model_faults(path):
        raise BadInput(fault)


def burns_fuel(path: Path) -> bool:
    """Whether a model has tanks of fuel that its engines empty. Raises BadInput for no XML."""
    return any(tank.get("type", "").upper() == "FUEL" for tank in read(path).iter("tank"))


def model_faults(path: Path) -> Iterator[str]:
    """Faults of a model: missing sections, sizes, mass and inertia that no body has, missing engines. Raises BadInput for no XML."""
    model = read(path)
    if model.tag != "fdm_config":
        yield f"{path}: the outermost tag is <{model.tag}>; a JSBSim model begins with <fdm_config>"
        return
    for section in SECTIONS:
        if model.find(section) is None:
            yield f"{path}: there is no <{section}> section; add it"
    for tag in ABOVE_ZERO:
        section, name = tag.split("/")
        if (there := model.find(section)) is not None and there.get("file") is None and not 0 < _value(model, tag) < math.inf:
            text = (model.findtext(tag) or "").strip()
            yield f"{_at(path, f'<{name}')}: {section}: {name} is '{text}'; it must be a number above zero"
    yield from _inertia_faults(path, model)
    try:
        yield from _part_faults(path)
    except BadInput as error:
        yield str(error)


def _inertia_faults(path: Path, model: ElementTree.Element) -> Iterator[str]:
    """Of a rigid body the moments about two axes are together at least that about the third."""
    moments = sorted((_moment(model, name), name) for name in ("ixx", "iyy", "izz"))
    (one, first), (other, second), (most, third) = moments
    if all(0 < m < math.inf for m in (one, other, most)) and one + other < most * (1 - ROUGH):
        where = _at(path, f"<{third}")
        yield f"{where}: mass_balance: {third} is {most:g}, more than {first} + {second} = {one + other:g}; no body has such inertia"


def _part_faults(path: Path) -> Iterator[str]:
    for part in parts(path):
        if part.found is None and part.by == path:
            name = part.name.removesuffix(".xml")
            near = nearest(name, (p.stem for folder in part.folders if folder != path.parent for p in folder.glob("*.xml")))
            place = {"thruster": "engine", "engine": "engine", "system": "systems"}.get(part.kind, path.parent.name)
            yield f"{_at(path, part.name)}: no {place}/{name}.xml for the {part.kind}; {near}"


def _at(path: Path, text: str) -> str:
    """With the line in which ``text`` stands first."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    return next((f"{path}:{i}" for i, line in enumerate(lines, 1) if text in line), str(path))


def _value(model: ElementTree.Element, tag: str) -> float:
    """nan where there is no number."""
    return number((model.findtext(tag) or "").strip())


def _moment(model: ElementTree.Element, name: str) -> float:
    """kg m^2."""
    tag = model.find(f"mass_balance/{name}")
    metric = tag is not None and tag.get("unit") == "KG*M2"
    return _value(model, f"mass_balance/{name}") * (1.0 if metric else SLUG_FT2)


def contact_names(path: Path, number: int) -> list[str]:
    """Names of the ``number`` contacts in the order of the file; numbered where the model has them in a file of its own."""
    named = [tag.get("name", "").strip() for tag in read(path).findall("ground_reactions/contact")]
    return [name or f"contact {i}" for i, name in enumerate(named)] if len(named) == number else [f"contact {i}" for i in range(number)]


def steers_by_brakes(path: Path) -> bool:
    """Whether no wheel of it follows the rudder, and it has brakes on the left and on the right: it is steered by them."""
    wheels = [contact for contact in read(path).findall("ground_reactions/contact") if contact.get("type") == "BOGEY"]
    steered = [abs(number(wheel.findtext("max_steer", "0").strip())) for wheel in wheels]
    groups = {wheel.findtext("brake_group", "").strip() for wheel in wheels}
    return bool(wheels) and not any(0 < angle < CASTER for angle in steered) and {"LEFT", "RIGHT"} <= groups


def weight_and_wing(path: Path) -> tuple[float, float]:
    """Mass [kg], empty with what is loaded and the tanks as full as the file has them, and wing area [m^2]. Raises BadInput."""
    model = _whole(path)
    mass = _mass(model, "mass_balance/emptywt") + _mass(model, "mass_balance/pointmass/weight")
    fuel = _mass(model, "propulsion/tank/contents")
    area = model.find("metrics/wingarea")
    wing = number((area.text or "").strip()) * (1.0 if area.get("unit") == "M2" else FT2) if area is not None else math.nan
    if not (mass > 0 and wing > 0):
        raise BadInput(f"{path}: its weight or the area of its wing is not told; complete <mass_balance> and <metrics>")
    return mass + (fuel if fuel > 0 else 0.0), wing


def _mass(model: ElementTree.Element, tags: str) -> float:
    """kg, of all of them together."""
    return sum(number((tag.text or "").strip()) * MASS.get(tag.get("unit", "LBS"), MASS["LBS"]) for tag in model.iterfind(tags))


def _whole(path: Path) -> ElementTree.Element:
    """With the sections that stand in files of their own put in."""
    model = read(path)
    for part in parts(path):
        section = model.find(part.kind)
        if part.by == path and part.found is not None and section is not None and section.get("file") == part.name:
            section.extend(list(read(part.found)))
    return model
