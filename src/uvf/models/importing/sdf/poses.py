"""Poses and frames of SDF: what stands where in its model (http://sdformat.org/tutorials?tut=pose_frame_semantics)."""

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import from_euler
from uvf.maths.se3 import IDENTITY, Transform, compose, inverse
from uvf.models.importing.notes import Notes
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]
FILE = "uvf_file"
"""Attribute of a model that came from a file of its own."""
HERE = ("", "__model__", "__root__", "world")
"""Names of the frame of the model, or of the world, itself."""


def place_of(element: Any) -> str:
    """Where an element is written, as ``file:line``."""
    owner = element
    while owner is not None and FILE not in owner.attrib:
        owner = owner.getparent()
    return f"{owner.get(FILE) if owner is not None else 'SDF'}:{element.sourceline}"


GLUED = re.compile(r"(?<=[\d.])(?=[-+])")
"""Between two numbers without a space, which C++ streams, and so Gazebo, read as two."""


def numbers(element: Any, count: int | None = None) -> Floats:
    """The numbers (n,) in an element, in its own units. Raises BadInput when there are not ``count`` finite ones."""
    try:
        values = np.array([float(word) for word in GLUED.sub(" ", element.text or "").split()])
    except ValueError as error:
        raise BadInput(f"{place_of(element)}: <{element.tag}>: {error}; write numbers") from error
    if (count is not None and len(values) != count) or not np.isfinite(values).all():
        raise BadInput(f"{place_of(element)}: <{element.tag}> holds '{(element.text or '').strip()}'; write {count} finite numbers")
    return values


def transform(pose: Any) -> Transform:
    """Transform of a <pose> from the frame that it is relative to; identity without one. Raises BadInput."""
    if pose is None or not (pose.text or "").strip():
        return IDENTITY
    if pose.get("rotation_format") == "quat_xyzw":
        x, y, z, *xyzw = numbers(pose, 7)
        length = float(np.linalg.norm(xyzw))
        if length < 1e-9:
            raise BadInput(f"{place_of(pose)}: <pose>: a quaternion of zeros turns nothing; write 0 0 0 1")
        return Transform(np.roll(np.array(xyzw) / length, 1), np.array((x, y, z)))
    x, y, z, *angles = numbers(pose, 6)
    if pose.get("degrees", "false").strip().lower() in ("true", "1"):
        angles = list(np.radians(angles))
    return Transform(from_euler(*(float(a) for a in angles)), np.array((x, y, z)))


def relative_to(pose: Any) -> str:
    """Name of the frame that a <pose> is relative to; SDF up to 1.6 called the attribute ``frame``."""
    return "" if pose is None else str(pose.get("relative_to") or pose.get("frame") or "")


class Scope:
    """The frames of one model, or of the world: links, joints, <frame>s and models in it, found by name when asked for."""

    def __init__(self, element: Any, notes: Notes) -> None:
        self.element = element
        self._notes = notes
        self._entries = {
            child.get("name"): child for child in element if child.tag in ("link", "frame", "joint", "model") and child.get("name")
        }
        self._inner: dict[str, Scope] = {}

    def inner(self, name: str) -> "Scope":
        """The frames of a model that lies in this one."""
        if name not in self._inner:
            self._inner[name] = Scope(self._entries[name], self._notes)
        return self._inner[name]

    def pose(self, name: str, asking: tuple[str, ...] = ()) -> Transform:
        """Transform of a frame in that of this model. Raises BadInput when frames refer to each other in a ring."""
        if name in HERE:
            return IDENTITY
        if name in asking:
            raise BadInput(f"{place_of(self._entries[name])}: frames refer to each other in a ring: {' -> '.join((*asking, name))}; cut it")
        if name not in self._entries:
            return self._elsewhere(name, asking)
        element = self._entries[name]
        pose = element.find("pose")
        own = transform(pose)
        if element.tag == "model" and element.get("placement_frame"):
            own = compose(own, inverse(self.inner(name).pose(element.get("placement_frame"))))
        return compose(self.pose(relative_to(pose) or _default(element), (*asking, name)), own)

    def _elsewhere(self, name: str, asking: tuple[str, ...]) -> Transform:
        """A frame of a model in this one: ``model::frame``, or any of a model merged into this one."""
        first, _, rest = name.partition("::")
        if rest and first in self._entries and self._entries[first].tag == "model":
            return compose(self.pose(first, asking), self.inner(first).pose(rest))
        for inner, element in self._entries.items():
            if element.get("uvf_merged") and element.xpath("*[@name=$name]", name=name):
                return compose(self.pose(inner, asking), self.inner(inner).pose(name))
        self._notes.add("poses relative to frames that are not there, taken from their model's frame", name)
        return IDENTITY


def _default(element: Any) -> str:
    """What a pose without a frame is relative to."""
    if element.tag == "frame":
        return str(element.get("attached_to") or "")
    return str(element.findtext("child") or "").strip() if element.tag == "joint" else ""
