"""A model as plain URDF: no xacro, no packages."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from lxml import etree

from uvf.maths.rotations import to_euler
from uvf.maths.se3 import Transform
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.robot import Inertial, Joint, Link, UrdfModel

NameMesh = Callable[[Path], str]
EFFORT, SPEED = 100.0, 10.0  # of a joint of which nothing is told: the format wants something there


def urdf_text(model: UrdfModel, name_mesh: NameMesh, comment: str = "") -> str:
    """Text of a model as a plain URDF. name_mesh: how a mesh's file is written there."""
    robot = etree.Element("robot", name=model.name)
    if comment:
        robot.append(etree.Comment(f" {comment} "))
    for link in model.links.values():
        robot.append(_link(link, name_mesh))
    for joint in model.joints.values():
        robot.append(_joint(joint))
    return '<?xml version="1.0"?>\n' + str(etree.tostring(robot, pretty_print=True, encoding="unicode"))


def _link(link: Link, name_mesh: NameMesh) -> Any:
    tag = etree.Element("link", name=link.name)
    if link.inertial is not None:
        tag.append(_inertial(link.inertial))
    if link.contact:
        contact = etree.SubElement(tag, "contact")
        for name, value in link.contact:
            etree.SubElement(contact, name, value=_row((value,)))
    for kind, solids in (("visual", link.visuals), ("collision", link.collisions)):
        for solid in solids:
            part = etree.SubElement(tag, kind)
            part.append(_origin(Transform(solid.orientation, solid.position)))
            etree.SubElement(etree.SubElement(part, "geometry"), solid.shape, _sizes(solid, name_mesh))
            if kind == "visual":
                colour = "_".join(f"{round(255 * c):02x}" for c in solid.colour)
                material = etree.SubElement(part, "material", name=f"colour_{colour}")
                etree.SubElement(material, "color", rgba=_row((*solid.colour, 1.0)))
    return tag


def _sizes(solid: Solid, name_mesh: NameMesh) -> dict[str, str]:
    if solid.shape == "mesh":
        return {"filename": name_mesh(solid.mesh or Path("?")), "scale": _row(solid.size)}
    if solid.shape == "box":
        return {"size": _row(solid.size)}
    return dict(zip(("radius", "length"), (_row((s,)) for s in solid.size), strict=False))


def _inertial(inertial: Inertial) -> Any:
    tag = etree.Element("inertial")
    etree.SubElement(tag, "origin", xyz=_row(inertial.com))
    etree.SubElement(tag, "mass", value=_row((inertial.mass,)))
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = inertial.inertia
    values = {"ixx": xx, "ixy": xy, "ixz": xz, "iyy": yy, "iyz": yz, "izz": zz}
    etree.SubElement(tag, "inertia", {key: _row((value,)) for key, value in values.items()})
    return tag


def _joint(joint: Joint) -> Any:
    tag = etree.Element("joint", name=joint.name, type=joint.kind)
    etree.SubElement(tag, "parent", link=joint.parent)
    etree.SubElement(tag, "child", link=joint.child)
    tag.append(_origin(joint.parent_from_child))
    if joint.kind != "fixed":
        etree.SubElement(tag, "axis", xyz=_row(joint.axis))
        etree.SubElement(tag, "dynamics", damping=_row((joint.damping,)), friction=_row((joint.friction,)))
    if joint.limits is not None or joint.speed or joint.effort:
        strength = {"effort": _row((joint.effort or EFFORT,)), "velocity": _row((joint.speed or SPEED,))}
        ends = {} if joint.limits is None else {"lower": _row(joint.limits[:1]), "upper": _row(joint.limits[1:])}
        etree.SubElement(tag, "limit", ends | strength)
    return tag


def _origin(at: Transform) -> Any:
    return etree.Element("origin", xyz=_row(at.translation), rpy=_row(to_euler(at.rotation)))


def _row(values: Any) -> str:
    return " ".join(f"{float(v) + 0.0:.12g}" for v in values)
