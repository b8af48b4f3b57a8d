"""The elements of a URDF as a model; what cannot be read is noted with its line and a stand-in taken, so that all faults show at once."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import from_euler, matrix
from uvf.maths.se3 import Transform
from uvf.models.shapes.solid import Colour, Solid
from uvf.models.urdf.marked import LINE
from uvf.models.urdf.packages import find_mesh
from uvf.models.urdf.robot import JOINT_KINDS, Inertial, Joint, Link, ModelFault, UrdfModel
from uvf.models.yaml_data import nearest

Floats = NDArray[np.float64]
GREY: Colour = (0.6, 0.6, 0.6)
SHAPES = ("box", "capsule", "cylinder", "mesh", "sphere")


def read_model(path: Path, robot: Any) -> UrdfModel:
    """Model of a URDF. robot: the root element as ``source.read_xml`` gives it; path: where it came from, for meshes and messages."""
    return _Reader(path).model(robot)


class _Reader:
    def __init__(self, path: Path) -> None:
        self._path = path
        self._faults: list[ModelFault] = []
        self._colours: dict[str, Colour] = {}

    def model(self, robot: Any) -> UrdfModel:
        links, joints = robot.findall("link"), robot.findall("joint")
        for kind, tags in (("link", links), ("joint", joints)):
            self._doubled(kind, tags)
        for material in robot.iter("material"):
            self._learn(material)
        read_links = [self._link(tag) for tag in links]
        read_joints = [self._joint(tag) for tag in joints]
        name = robot.get("name") or self._path.stem
        return UrdfModel(self._path, name, {k.name: k for k in read_links}, {j.name: j for j in read_joints}, tuple(self._faults))

    def _fault(self, tag: Any, text: str) -> None:
        path, line = _place(tag)
        self._faults.append(ModelFault(Path(path) if path else self._path, line, text))

    def _doubled(self, kind: str, tags: list[Any]) -> None:
        seen: set[str] = set()
        for tag in tags:
            name = tag.get("name")
            if not name:
                self._fault(tag, f"a {kind} has no name; give it one")
            elif name in seen:
                self._fault(tag, f"{kind} '{name}' is given twice; names are for one each")
            seen.add(name or "")

    def _learn(self, material: Any) -> None:
        colour = material.find("color")
        if colour is not None and material.get("name"):
            r, g, b, *_ = (*self._row(colour, "rgba", 4, (*GREY, 1.0)),)
            self._colours[material.get("name")] = (float(r), float(g), float(b))

    def _row(self, tag: Any, attribute: str, count: int, default: tuple[float, ...]) -> Floats:
        """The numbers of an attribute; a tag or an attribute that is not there means the default."""
        text = tag.get(attribute) if tag is not None else None
        if text is None:
            return np.array(default)
        values = numbers(text)
        if len(values) == count:
            return np.array(values)
        words = {1: "a number", 3: "three numbers"}.get(count, f"{count} numbers")
        example = "; write it as '0 0 1'" if count == 3 else ""
        self._fault(tag, f'<{tag.tag} {attribute}="{text}">: {words} must stand there{example}')
        return np.array(default)

    def _origin(self, tag: Any) -> Transform:
        origin = tag.find("origin") if tag is not None else None
        zero = (0.0, 0.0, 0.0)
        return Transform(from_euler(*self._row(origin, "rpy", 3, zero)), self._row(origin, "xyz", 3, zero))

    def _link(self, tag: Any) -> Link:
        name = tag.get("name") or "?"
        inertial = tag.find("inertial")
        visuals, collisions = (tuple(s for part in tag.findall(kind) for s in self._solids(name, part)) for kind in ("visual", "collision"))
        mass = self._inertial(name, inertial) if inertial is not None else None
        return Link(name, mass, visuals, collisions, tuple(self._contact(tag)), _place(tag)[1])

    def _contact(self, link: Any) -> Iterator[tuple[str, float]]:
        for tag in link.iterfind("contact/*[@value]"):
            yield str(tag.tag), float(self._row(tag, "value", 1, (0.0,))[0])

    def _inertial(self, link: str, tag: Any) -> Inertial:
        mass, inertia = tag.find("mass"), tag.find("inertia")
        if mass is None or inertia is None:
            self._fault(tag.getparent(), f"link '{link}': give it <inertial> with <mass> and <inertia>")
        origin = self._origin(tag)
        xx, xy, xz, yy, yz, zz = (float(self._row(inertia, f"i{a}", 1, (0.0,))[0]) for a in ("xx", "xy", "xz", "yy", "yz", "zz"))
        turn = matrix(origin.rotation)
        tensor = turn @ np.array(((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))) @ turn.T
        return Inertial(float(self._row(mass, "value", 1, (0.0,))[0]), origin.translation, tensor)

    def _solids(self, link: str, tag: Any) -> Iterator[Solid]:
        geometry = tag.find("geometry")
        shapes = [s for s in geometry if isinstance(s.tag, str)] if geometry is not None else []
        if not shapes or shapes[0].tag not in SHAPES:
            found = f"<{shapes[0].tag}>; {nearest(str(shapes[0].tag), SHAPES)}" if shapes else "nothing"
            self._fault(tag.getparent(), f"link '{link}': a <{tag.tag}> needs a shape in <geometry>, but there is {found}")
            return
        material = tag.find("material")
        colour = self._colours.get(material.get("name"), GREY) if material is not None else GREY
        if material is not None and material.find("color") is not None:
            r, g, b, _ = self._row(material.find("color"), "rgba", 4, (*GREY, 1.0))
            colour = (float(r), float(g), float(b))
        yield from self._shaped(link, shapes[0], self._origin(tag), colour)

    def _shaped(self, link: str, shape: Any, at: Transform, colour: Colour) -> Iterator[Solid]:
        def size(attribute: str, count: int = 1) -> tuple[float, ...]:
            return self._size(link, shape, attribute, count)

        if shape.tag == "mesh":
            yield self._mesh(link, shape, at, colour)
        elif shape.tag == "box":
            yield Solid(link, "box", size("size", 3), at.translation, at.rotation, colour)
        elif shape.tag == "sphere":
            yield Solid(link, "sphere", size("radius"), at.translation, at.rotation, colour)
        else:
            radius, length = size("radius")[0], size("length")[0]
            yield Solid(link, "cylinder", (radius, length), at.translation, at.rotation, colour)
            if shape.tag == "capsule":
                ends = (at.translation + side * length / 2 * matrix(at.rotation)[:, 2] for side in (-1.0, 1.0))
                yield from (Solid(link, "sphere", (radius,), end, at.rotation, colour) for end in ends)

    def _size(self, link: str, shape: Any, attribute: str, count: int) -> tuple[float, ...]:
        values = numbers(shape.get(attribute) or "")
        if len(values) == count and all(v > 0 for v in values):
            return tuple(values)
        owner = next(a for a in shape.iterancestors() if a.tag == "link")
        self._fault(owner, f"link '{link}': <{shape.tag} {attribute}=\"{shape.get(attribute)}\">: {count} number(s) above zero")
        return (0.01,) * count

    def _mesh(self, link: str, shape: Any, at: Transform, colour: Colour) -> Solid:
        name = shape.get("filename") or "?"
        file = find_mesh(self._path, name)
        if file is None:
            owner = next(a for a in shape.iterancestors() if a.tag == "link")
            self._fault(owner, f"link '{link}': no mesh file '{name}' beside the URDF; put it there or mend its name")
        scale = self._row(shape, "scale", 3, (1.0, 1.0, 1.0))
        x, y, z = (float(s) for s in scale)
        return Solid(link, "mesh", (x, y, z), at.translation, at.rotation, colour, file or Path(name))

    def _joint(self, tag: Any) -> Joint:
        name, kind = tag.get("name") or "?", tag.get("type") or ""
        if kind not in JOINT_KINDS:
            self._fault(tag, f"joint '{name}': type '{kind}'; {nearest(kind, JOINT_KINDS)}")
        axis = self._row(tag.find("axis"), "xyz", 3, (1.0, 0.0, 0.0))
        if not axis.any():
            if kind != "fixed":  # exporters write zeros there for joints that do not move
                self._fault(tag, f"joint '{name}': an axis of no direction; a wheel's is mostly xyz=\"0 1 0\"")
            axis = np.array((0.0, 1.0, 0.0))
        parent, child = (tag.find(end).get("link", "") if tag.find(end) is not None else "" for end in ("parent", "child"))
        limit, mimic = tag.find("limit"), tag.find("mimic")
        low, high = (float(self._row(limit, end, 1, (0.0,))[0]) for end in ("lower", "upper"))
        speed, effort = (_strength(limit, of) for of in ("velocity", "effort"))
        damping, friction = (float(self._row(tag.find("dynamics"), of, 1, (0.0,))[0]) for of in ("damping", "friction"))
        return Joint(
            name,
            kind,
            parent,
            child,
            self._origin(tag),
            axis / np.linalg.norm(axis),
            (low, high) if kind in ("revolute", "prismatic") and limit is not None else None,
            mimic.get("joint") if mimic is not None else None,
            damping,
            friction,
            speed,
            effort,
            _place(tag)[1],
        )


def numbers(text: str) -> list[float]:
    """The finite numbers of a text, in the URDF's units ([m], [rad], [kg] ...); empty where anything else stands in it."""
    try:
        values = [float(part) for part in text.split()]
    except ValueError:
        return []
    return values if all(map(math.isfinite, values)) else []


def _strength(limit: Any, of: str) -> float:
    """0 where it is not told: whoever needs it says so."""
    told = numbers(limit.get(of) or "") if limit is not None else []
    return max(told[0], 0.0) if len(told) == 1 else 0.0


def _place(tag: Any) -> tuple[str, int]:
    """File and line of the nearest tag about it that knows them."""
    mark = next((m for t in (tag, *tag.iterancestors()) if (m := t.get(LINE))), None)
    if mark is None:
        return "", tag.sourceline or 0
    path, _, line = mark.rpartition(":")
    return path, int(line)
