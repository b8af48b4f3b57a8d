"""Checks a URDF before an engine sees it, so that a mistake ends in one line that names the file and the mend."""

from collections.abc import Iterable
from pathlib import Path
from xml.etree import ElementTree

from uvf.runtime.params import BadInput, nearest


def check_urdf(path: Path, wheel_joints: Iterable[str]) -> None:
    """The file is there, is XML, its meshes exist, each link has mass, the wheel joints turn. Raises BadInput."""
    robot = _read(path)
    turning = {j.get("name", ""): j.get("type") for j in robot.iter("joint") if j.get("type") is not None}
    for name in wheel_joints:
        if name not in turning:
            raise BadInput(f"{path}: no joint '{name}' (named in vehicle.yaml); {nearest(name, turning)}")
        if turning[name] != "continuous":
            raise BadInput(f"{path}: joint '{name}' is '{turning[name]}', but a wheel needs type=\"continuous\"")
    for link in robot.findall("link"):
        _check_link(path, link)
    _check_tree(path, robot)


def _read(path: Path) -> ElementTree.Element:
    if not path.is_file():
        raise BadInput(f"{path}: no such file; {nearest(path.name, (p.name for p in path.parent.glob('*.urdf')))}")
    try:
        robot = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        raise BadInput(f"{path}: not valid XML: {error}; mend the tag there") from error
    if robot.tag != "robot":
        raise BadInput(f"{path}: the outermost tag is <{robot.tag}>; a URDF begins with <robot>")
    return robot


def _check_link(path: Path, link: ElementTree.Element) -> None:
    name = link.get("name", "?")
    mass = link.find("inertial/mass")
    inertia = link.find("inertial/inertia")
    if mass is None or inertia is None:
        raise BadInput(f"{path}: link '{name}': give it <inertial> with <mass> and <inertia>")
    values = [mass.get("value"), *(inertia.get(axis) for axis in ("ixx", "iyy", "izz"))]
    if not all(_is_positive(value) for value in values):
        raise BadInput(f"{path}: link '{name}': mass, ixx, iyy and izz must be numbers above zero")
    for mesh in link.iter("mesh"):
        if not (path.parent / mesh.get("filename", "")).is_file():
            raise BadInput(f"{path}: link '{name}': no mesh file '{mesh.get('filename')}' beside the URDF")


def _check_tree(path: Path, robot: ElementTree.Element) -> None:
    """Every joint ties two known links, and one link alone hangs on no joint."""
    roots = {link.get("name", "?") for link in robot.findall("link")}
    links = frozenset(roots)
    for joint in robot.findall("joint"):
        for end in ("parent", "child"):
            tag = joint.find(end)
            name = tag.get("link", "") if tag is not None else ""
            if name not in links:
                raise BadInput(f"{path}: joint '{joint.get('name')}': no {end} link '{name}'; {nearest(name, links)}")
            if end == "child":
                roots.discard(name)
    if len(roots) != 1:
        raise BadInput(f"{path}: one link must be the root, but without a parent joint are: {', '.join(sorted(roots)) or 'none'}")


def _is_positive(text: str | None) -> bool:
    try:
        return float(text or "") > 0
    except ValueError:
        return False
