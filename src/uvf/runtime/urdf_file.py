"""Checks a URDF before an engine sees it, so that a mistake ends in one line that names the file and the mend."""

import math
from collections.abc import Iterable
from pathlib import Path
from xml.etree import ElementTree

from uvf.runtime.params import BadInput, nearest

JOINT_KINDS = ("continuous", "fixed", "floating", "planar", "prismatic", "revolute")
SIZES = {"box": ("size", 3), "cylinder": ("radius", 1), "sphere": ("radius", 1), "capsule": ("radius", 1)}


def check_urdf(path: Path, wheel_joints: Iterable[str]) -> None:
    """The file is XML, its meshes exist, each link has mass, shapes have a size, the wheel joints turn. Raises BadInput."""
    robot = _read(path)
    _check_numbers(path, robot)
    turning = {j.get("name", ""): j.get("type") for j in robot.iter("joint") if j.get("type") is not None}
    for name in wheel_joints:
        if name not in turning:
            raise BadInput(f"{path}: no joint '{name}' (named in vehicle.yaml); {nearest(name, turning)}")
        if turning[name] != "continuous":
            raise BadInput(f"{path}: joint '{name}' is '{turning[name]}', but a wheel needs type=\"continuous\"")
    for link in robot.findall("link"):
        _check_link(path, link)
    for joint in robot.findall("joint"):
        _check_joint(path, joint)
    _check_tree(path, robot)


def _read(path: Path) -> ElementTree.Element:
    if not path.is_file():
        raise BadInput(f"{path}: no such file; {nearest(path.name, (p.name for p in path.parent.glob('*.urdf')))}")
    try:
        robot = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        raise BadInput(f"{path}: not valid XML: {error}; mend the tag there") from error
    except (OSError, ValueError, LookupError) as error:
        raise BadInput(f"{path}: cannot be read: {error}") from error
    if robot.tag != "robot":
        raise BadInput(f"{path}: the outermost tag is <{robot.tag}>; a URDF begins with <robot>")
    return robot


def _check_numbers(path: Path, robot: ElementTree.Element) -> None:
    """Positions, angles and axes are three finite numbers each."""
    for tag in robot.iter():
        for attribute in ("xyz", "rpy"):
            text = tag.get(attribute)
            if text is not None and len(_numbers(text)) != 3:
                raise BadInput(f"{path}: <{tag.tag} {attribute}=\"{text}\">: three numbers must stand there, as in '0 0 1'")


def _check_link(path: Path, link: ElementTree.Element) -> None:
    name = link.get("name", "?")
    mass = link.find("inertial/mass")
    inertia = link.find("inertial/inertia")
    if mass is None or inertia is None:
        raise BadInput(f"{path}: link '{name}': give it <inertial> with <mass> and <inertia>")
    values = [mass.get("value"), *(inertia.get(axis) for axis in ("ixx", "iyy", "izz"))]
    if not all(_are_positive(value, 1) for value in values):
        raise BadInput(f"{path}: link '{name}': mass, ixx, iyy and izz must be numbers above zero")
    for geometry in link.iter("geometry"):
        _check_shape(path, name, geometry)


def _check_shape(path: Path, link: str, geometry: ElementTree.Element) -> None:
    for shape in geometry:
        if shape.tag == "mesh" and not (path.parent / shape.get("filename", "?")).is_file():
            raise BadInput(f"{path}: link '{link}': no mesh file '{shape.get('filename')}' beside the URDF")
        attribute, count = SIZES.get(shape.tag, ("", 0))
        if count and not _are_positive(shape.get(attribute), count):
            raise BadInput(f"{path}: link '{link}': <{shape.tag} {attribute}=\"{shape.get(attribute)}\">: {count} number(s) above zero")
        if shape.tag in ("cylinder", "capsule") and not _are_positive(shape.get("length"), 1):
            raise BadInput(f"{path}: link '{link}': <{shape.tag} length=\"{shape.get('length')}\">: a number above zero")


def _check_joint(path: Path, joint: ElementTree.Element) -> None:
    name, kind, axis = joint.get("name"), joint.get("type", ""), joint.find("axis")
    if not name:
        raise BadInput(f"{path}: a joint has no name; give it one")
    if kind not in JOINT_KINDS:
        raise BadInput(f"{path}: joint '{name}': type '{kind}'; {nearest(kind, JOINT_KINDS)}")
    if axis is not None and not any(_numbers(axis.get("xyz", "0 0 0"))):
        raise BadInput(f"{path}: joint '{name}': an axis of no direction; a wheel's is mostly xyz=\"0 1 0\"")


def _check_tree(path: Path, robot: ElementTree.Element) -> None:
    """Names are given once, every joint ties two known links, every link but one hangs on one joint, and all hang together."""
    for kind in ("link", "joint"):
        names = [tag.get("name", "?") for tag in robot.findall(kind)]
        if twice := [name for name in names if names.count(name) > 1]:
            raise BadInput(f"{path}: {kind} '{twice[0]}' is given twice; names are for one each")
    links = [link.get("name", "?") for link in robot.findall("link")]
    parents: dict[str, str] = {}
    for joint in robot.findall("joint"):
        parent, child = (_end(path, joint, end, links) for end in ("parent", "child"))
        if child in parents:
            raise BadInput(f"{path}: link '{child}' is the child of two joints; one is enough")
        parents[child] = parent
    roots = sorted(set(links) - set(parents))
    if len(roots) != 1:
        raise BadInput(f"{path}: one link must be the root, but without a parent joint are: {', '.join(roots) or 'none'}")
    _check_rings(path, parents)


def _end(path: Path, joint: ElementTree.Element, end: str, links: list[str]) -> str:
    tag = joint.find(end)
    name = tag.get("link", "") if tag is not None else ""
    if name not in links:
        raise BadInput(f"{path}: joint '{joint.get('name')}': no {end} link '{name}'; {nearest(name, links)}")
    return name


def _check_rings(path: Path, parents: dict[str, str]) -> None:
    for link in parents:
        above = link
        for _ in parents:
            above = parents.get(above, "")
        if above:
            raise BadInput(f"{path}: link '{link}' hangs on itself in a ring of joints; cut it")


def _numbers(text: str) -> list[float]:
    """The finite numbers of a text; empty where anything else stands in it."""
    try:
        values = [float(part) for part in text.split()]
    except ValueError:
        return []
    return values if all(map(math.isfinite, values)) else []


def _are_positive(text: str | None, count: int) -> bool:
    values = _numbers(text or "")
    return len(values) == count and all(value > 0 for value in values)
