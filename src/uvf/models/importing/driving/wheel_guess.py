"""What may be a wheel: a joint that turns with something round on it."""

import re
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import rotate
from uvf.maths.se3 import Transform
from uvf.models.importing.robot import Foreign
from uvf.models.shapes.mesh import placed, reach
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.robot import Joint, UrdfModel

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class WheelGuess:
    """A joint that may be a driven wheel, in the root's frame: centre (3,) [m] on the axis at the middle of the tread, axis (3,).

    radius, width: of the tread [m].
    """

    joint: Joint
    centre: Floats
    axis: Floats
    radius: float
    width: float


Pair = tuple[WheelGuess, WheelGuess]
WHEEL = re.compile(r"wheel|whl|tyre|tire")
LEVEL = 0.3  # of an axis' z
CASTORS = ("cast", "swivel", "ball", "skid", "support")


def may_turn(joint: Joint, is_called_wheel: bool) -> bool:
    """Whether a joint can turn for ever; of one with limits its name tells, too."""
    wide = joint.limits is None or joint.limits[1] - joint.limits[0] > 2 * np.pi or joint.limits == (0.0, 0.0)
    return joint.kind == "continuous" or (joint.kind == "revolute" and (wide or is_called_wheel))


def wheel_on(model: UrdfModel, joint: Joint) -> WheelGuess | None:
    """The wheel on a joint; None where nothing round hangs on it."""
    poses = model.link_poses()
    if joint.child not in poses:
        return None
    solids = shapes_below(model, joint.child, poses)
    if not solids:
        return None
    pose = poses[joint.child]
    axis = rotate(pose.rotation, joint.axis)
    across = _across(axis)
    spans = np.max([reach(s, across) for s in solids], axis=0) - across @ pose.translation
    ends = np.max([reach(s, np.array((axis, -axis))) for s in solids], axis=0)
    offset = (ends[0] - ends[1]) / 2 - float(axis @ pose.translation)
    radius = float(np.median(spans))
    if radius <= 0 or spans.max() > 1.25 * radius or spans.min() < 0.75 * radius:
        return None
    return WheelGuess(joint, pose.translation + offset * axis, axis, float(spans.max()), float(ends.sum()))


def loosened_wheels(foreign: Foreign) -> dict[str, Joint]:
    """Fixed joints with something round on them that is called a wheel, as joints that turn about its level axis."""
    found, poses = {}, foreign.model.link_poses()
    for name, joint in foreign.model.joints.items():
        called = f"{name} {joint.child}".lower()
        if joint.kind != "fixed" or not WHEEL.search(called) or any(word in called for word in CASTORS) or joint.child not in poses:
            continue
        for axis in np.eye(3)[[1, 2, 0]]:
            turning = replace(joint, kind="continuous", axis=axis)
            level = abs(float(rotate(poses[joint.child].rotation, axis)[2])) < LEVEL
            if level and (wheel := wheel_on(foreign.model, turning)) is not None and wheel.width < 2 * wheel.radius:
                found[name] = turning
                break
    return found


def shapes_below(model: UrdfModel, link: str, poses: dict[str, Transform]) -> list[Solid]:
    """The collision shapes, else the visuals, of a link and all below it, in the root's frame."""
    links = [model.links[n] for n in model.below(link) if n in model.links and n in poses]
    shapes = [(n.name, s) for n in links for s in n.collisions] or [(n.name, s) for n in links for s in n.visuals]
    return [placed(s, poses[name]) for name, s in shapes]


def _across(axis: Floats) -> Floats:
    """(36, 3) unit directions at right angles to an axis."""
    first = np.cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.7 else (0.0, 1.0, 0.0))
    first /= np.linalg.norm(first)
    angles = np.linspace(0, 2 * np.pi, 36, endpoint=False)
    directions: Floats = np.outer(np.cos(angles), first) + np.outer(np.sin(angles), np.cross(axis, first))
    return directions
