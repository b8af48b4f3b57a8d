"""Robots of Gazebo (SDF): links, joints, drive plugin, sensors."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from uvf.maths.rotations import inverse as unturned
from uvf.maths.rotations import matrix, rotate
from uvf.maths.se3 import IDENTITY, Transform, compose, inverse
from uvf.models.importing.moved_joints import commanded_joints
from uvf.models.importing.notes import Notes
from uvf.models.importing.robot import UNKNOWN, Foreign, ForeignSensor, drive_of
from uvf.models.importing.sdf.colours import visual_colour
from uvf.models.importing.sdf.models import Models, read_sdf
from uvf.models.importing.sdf.poses import Scope, numbers, place_of, relative_to, transform
from uvf.models.shapes.solid import Colour, Solid
from uvf.models.urdf.robot import Inertial, Joint, Link, UrdfModel
from uvf.models.yaml_data import BadInput

GREY: Colour = (0.6, 0.6, 0.6)
KINDS = {"revolute": "revolute", "continuous": "continuous", "prismatic": "prismatic", "fixed": "fixed"}
NO_LIMIT = 1e3  # rad: limits wider than that are none
BASE = "base_link"


def read_foreign_sdf(path: Path) -> Foreign:
    """The robot that a file describes; of a world's models the first with a drive, else the first with joints. Raises BadInput."""
    root, notes = read_sdf(path), Notes()
    models = Models(path, [], notes)
    for tag in (root, *root.findall("world")):
        models.expand(tag)
    moving = [m for m in root.iter("model") if m.find("joint") is not None]
    if not moving:
        raise BadInput(f"{path}: no <model> with joints in it; a vehicle has wheels that turn")
    driven = next((m for m in moving if any(map(drive_of, m.iter("plugin")))), moving[0])
    return _Reader(path, models, notes, _version(path, root)).read(driven)


def _version(path: Path, root: Any) -> float:
    text = root.get("version") or "1.6"
    try:
        return float(text)
    except ValueError as error:
        raise BadInput(f'{path}:{root.sourceline}: <sdf version="{text}">: write a number, as 1.7') from error


class _Reader:
    def __init__(self, path: Path, models: Models, notes: Notes, version: float) -> None:
        self._path, self._models, self._notes, self._version = path, models, notes, version

    def read(self, model: Any) -> Foreign:
        scope = self._scope = Scope(model, self._notes)
        tags = {tag.get("name", "?"): tag for tag in model.findall("link")}
        if model.findall("model"):
            self._notes.add(
                "models within the model are left out; merge them", ", ".join(m.get("name", "") for m in model.findall("model"))
            )
        joints = [j for j in model.findall("joint") if _text(j, "child") in tags and _text(j, "parent") in tags]
        frames = {name: scope.pose(name) for name in tags}
        turned = {(n := _text(j, "child")): compose(inverse(frames[n]), scope.pose(j.get("name", "?"))) for j in joints}
        frames = {name: compose(pose, turned.get(name, IDENTITY)) for name, pose in frames.items()}
        links = {name: self._link(name, tag, inverse(turned.get(name, IDENTITY))) for name, tag in tags.items()}
        read = {j.get("name", "?"): self._joint(j, scope, frames) for j in joints}
        body = UrdfModel(self._path, model.get("name", "robot"), links, self._tied(links, read, frames))
        found = Foreign(body, notes=self._notes, commanded=commanded_joints(model))
        found.take_plugins(model)
        for name, tag in tags.items():
            for sensor in tag.findall("sensor"):
                at = compose(inverse(turned.get(name, IDENTITY)), self._in_link(name, sensor))
                found.sensors.append(ForeignSensor(sensor.get("type", ""), name, sensor, at))
        return found

    def _tied(self, links: dict[str, Link], joints: dict[str, Joint], frames: dict[str, Transform]) -> dict[str, Joint]:
        """A frame of the model as root, on which hang all links that hang on nothing."""
        below = {j.child for j in joints.values()}
        loose = [name for name in links if name not in below]
        if len(loose) > 1:
            self._notes.add("links without a joint, held fast to the body", ", ".join(loose[1:]))
        root = loose[0] if loose else next(iter(links))
        tied = {f"{n}_fixed": Joint(f"{n}_fixed", "fixed", root, n, compose(inverse(frames[root]), frames[n])) for n in loose[1:]}
        return {**joints, **tied}

    def _link(self, name: str, tag: Any, frame_from_link: Transform) -> Link:
        visuals, collisions = (
            tuple(s for part in tag.findall(kind) for s in self._solids(name, part, frame_from_link)) for kind in ("visual", "collision")
        )
        inertial = tag.find("inertial")
        mass = _inertial(inertial, compose(frame_from_link, self._in_link(name, inertial))) if inertial is not None else None
        return Link(name, mass, visuals, collisions, line=tag.sourceline or 0)

    def _in_link(self, link: str, part: Any) -> Transform:
        """Where a part of a link is in it; its <pose> may name another frame of the model."""
        pose = part.find("pose")
        named = relative_to(pose)
        if named in ("", link):
            return transform(pose)
        return compose(compose(inverse(self._scope.pose(link)), self._scope.pose(named)), transform(pose))

    def _solids(self, link: str, part: Any, frame_from_link: Transform) -> Iterator[Solid]:
        geometry = part.find("geometry")
        shape = next((s for s in geometry if isinstance(s.tag, str)), None) if geometry is not None else None
        if shape is None:
            return
        pose = compose(frame_from_link, self._in_link(link, part))
        colour = visual_colour(part) or GREY
        if shape.tag == "mesh":
            uri, scale = _text(shape, "uri"), shape.find("scale")
            file = self._models.find(uri, shape)
            scales = tuple(float(v) for v in numbers(scale, 3)) if scale is not None else (1.0, 1.0, 1.0)
            yield Solid(link, "mesh", scales, pose.translation, pose.rotation, colour, file or Path(uri))
            return
        size = _size(shape)
        if size is None:
            self._notes.add(f"shapes of a kind that is not taken over ({shape.tag})", link)
            return
        yield Solid(link, size[0], size[1], pose.translation, pose.rotation, colour)  # type: ignore[arg-type]

    def _joint(self, tag: Any, scope: Scope, frames: dict[str, Transform]) -> Joint:
        name, kind = tag.get("name", "?"), KINDS.get(tag.get("type", ""), "floating")
        if kind == "floating":
            self._notes.add(UNKNOWN, f"{name} ({tag.get('type')})")
        parent, child = _text(tag, "parent"), _text(tag, "child")
        axis, limit = tag.find("axis"), tag.find("axis/limit")
        low, high = (_limit(limit, end) for end in ("lower", "upper"))
        free = low is None or high is None or high - low > NO_LIMIT
        return Joint(
            name,
            "continuous" if kind == "revolute" and free else kind,
            parent,
            child,
            compose(inverse(frames[parent]), frames[child]),
            self._axis(axis, scope, frames[child]),
            None if free or low is None or high is None else (low, high),
            speed=max(_limit(limit, "velocity") or 0.0, 0.0),
            effort=max(_limit(limit, "effort") or 0.0, 0.0),
            line=tag.sourceline or 0,
        )

    def _axis(self, axis: Any, scope: Scope, frame: Transform) -> Any:
        """Unit, in the joint's frame; SDF up to 1.4 wrote it in the model's."""
        xyz = axis.find("xyz") if axis is not None else None
        if xyz is None:
            return np.array((0.0, 0.0, 1.0))
        values, within = numbers(xyz, 3), xyz.get("expressed_in")
        if within is not None:
            values = rotate(scope.pose(within).rotation, values)
        if within is not None or _text(axis, "use_parent_model_frame") in ("1", "true") or self._version < 1.5:
            values = rotate(unturned(frame.rotation), values)
        length = float(np.linalg.norm(values))
        return values / length if length > 0 else np.array((0.0, 0.0, 1.0))


def _size(shape: Any) -> tuple[str, tuple[float, ...]] | None:
    """(shape, size) of a Solid; None for kinds there are none of. Raises BadInput."""

    def lengths(tag: str, count: int) -> tuple[float, ...]:
        element = shape.find(tag)
        if element is None:
            raise BadInput(f"{place_of(shape)}: <{shape.tag}> has no <{tag}>; write it")
        return tuple(max(float(v), 1e-4) for v in numbers(element, count))

    if shape.tag == "box":
        return "box", lengths("size", 3)
    if shape.tag == "sphere":
        return "sphere", lengths("radius", 1)
    if shape.tag == "ellipsoid":
        return "sphere", (float(np.mean(lengths("radii", 3))),)
    if shape.tag in ("cylinder", "capsule"):
        (radius,), (length,) = lengths("radius", 1), lengths("length", 1)
        return "cylinder", (radius, length + (2 * radius if shape.tag == "capsule" else 0.0))
    return None


def _inertial(tag: Any, pose: Transform) -> Inertial:
    mass, inertia = tag.find("mass"), tag.find("inertia")
    values = {t: float(numbers(e, 1)[0]) for t in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz") if (e := _child(inertia, t)) is not None}
    xx, xy, xz, yy, yz, zz = (values.get(t, 0.0) for t in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    turn = matrix(pose.rotation)
    tensor = turn @ np.array(((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))) @ turn.T
    return Inertial(float(numbers(mass, 1)[0]) if mass is not None else 0.0, pose.translation, tensor)


def _child(tag: Any, name: str) -> Any:
    return tag.find(name) if tag is not None else None


def _text(tag: Any, name: str) -> str:
    return (tag.findtext(name) or "").strip()


def _limit(limit: Any, end: str) -> float | None:
    element = _child(limit, end)
    if element is None:
        return None
    try:
        value = float(element.text or "nan")
    except ValueError:
        return None
    return value if np.isfinite(value) else None
