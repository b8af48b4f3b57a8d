"""Joints of a ground vehicle beside those of its wheels: what is moved on command, and what gives way on springs."""

from collections.abc import Iterator, Mapping, Sequence
from math import ceil, inf, sqrt
from typing import Annotated, NamedTuple

import msgspec
import numpy as np
from msgspec import Meta

from uvf.maths.se3 import compose, inverse
from uvf.models.keys import key
from uvf.models.quantities import NotNegative
from uvf.models.urdf.inertia import whole
from uvf.models.urdf.robot import Joint, UrdfModel
from uvf.models.vehicle.sensors import Sensors
from uvf.models.yaml_data import BadInput, FileLocation, nearest

Displacement = Annotated[float, Meta(ge=-100, le=100)]
MOVING = ("revolute", "continuous", "prismatic")
STABLE = 0.5
"""Of a spring's frequency times the physics step, squared, and of its damping rate times that step: the largest."""


class Spring(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Of a joint that nothing drives: a suspension, a rocker. Figures are per metre of one that slides, per radian of one that turns."""

    stiffness: Annotated[NotNegative, key("N/m", "Force per displacement from `rest`, N m/rad of a joint that turns; 0: it swings.")]
    damping: Annotated[NotNegative, key("N s/m", "Force per speed, N m s/rad of a joint that turns.")]
    rest: Annotated[Displacement, key("m", "Displacement without a force, rad of a joint that turns.")] = 0.0


class MovedJoint(NamedTuple):
    """Range of a joint [rad, or m of a prismatic one], its largest speed per second, and the torque [N m] or force [N] that moves it."""

    lower: float
    upper: float
    speed: float
    effort: float

    def within(self, position: float) -> float:
        """The nearest position of its range."""
        return min(max(position, self.lower), self.upper)


def moved_joints(model: UrdfModel, names: Sequence[str]) -> dict[str, MovedJoint]:
    """The joints of these names, of which ``joint_faults`` finds no fault."""
    found = {}
    for name in names:
        joint = model.joints[name]
        found[name] = MovedJoint(*(joint.limits or (-inf, inf)), joint.speed, joint.effort)
    return found


def target_fault(joints: Mapping[str, MovedJoint], targets: Mapping[str, float]) -> str:
    """Why these joints cannot go to these positions [rad or m]; "" when they can."""
    if not joints:
        return "it has no joints that are moved on command; list them in its vehicle.yaml under ground: joints"
    if not targets:
        return f"no joint is named; there are: {', '.join(joints)}"
    for name, position in targets.items():
        if name not in joints:
            return f"there is no joint '{name}' that is moved on command; {nearest(name, joints)}"
        joint = joints[name]
        if joint.within(position) != position:
            return f"{name}: {position:g} is beyond its range, {joint.lower:g} to {joint.upper:g}"
    return ""


def check_joints(joints: Sequence[str], springs: Mapping[str, Spring], wheels: Sequence[str], place: FileLocation) -> None:
    """Raises BadInput for a joint that is named twice. wheels: the joints of wheels and steering."""
    for i, name in enumerate(joints):
        if name in (*wheels, *joints[:i]):
            raise BadInput(f"{place.at('joints', i)}: the joint {name} is named twice; it is moved by one thing")
    for name in springs:
        if name in (*wheels, *joints):
            raise BadInput(f"{place.at('springs', name)}: the joint {name} is named twice; what is driven is not on a spring")


def joint_faults(model: UrdfModel, joints: Sequence[str], springs: Mapping[str, Spring], hz: float) -> Iterator[str]:
    """What the URDF lacks of these joints, and springs that are too stiff for ``hz`` [Hz] of physics, a line each."""
    for name in (*joints, *springs):
        joint = model.joints.get(name)
        if joint is None:
            yield f"{model.path}: no joint '{name}' (named in vehicle.yaml); {nearest(name, model.joints)}"
        elif joint.kind not in MOVING:
            yield f"{_at(model, joint)}: joint '{name}' is '{joint.kind}' and does not move; make it one of {', '.join(MOVING)}"
        elif joint.limits is not None and not joint.limits[0] <= 0.0 <= joint.limits[1]:
            low, high = joint.limits
            yield f"{_at(model, joint)}: joint '{name}' goes from {low:g} to {high:g}: every joint begins at zero; let its range hold it"
        elif name in joints and not (joint.speed and joint.effort):
            yield f'{_at(model, joint)}: joint \'{name}\': give its <limit> velocity="..." and effort="..." above zero: that moves it'
        elif name in springs and hz < (least := _least_rate(model, joint, springs[name])):
            yield f"{_at(model, joint)}: joint '{name}': so stiff a spring on so light a part needs physics_hz: {least:g}"


def mount_faults(model: UrdfModel, joints: Sequence[str], sensors: Sensors, place: FileLocation) -> Iterator[str]:
    """Sensors that are carried by joints moved on command and are read as if they stood still, a line each."""
    carried, camera = model.carried_by(joints), sensors.camera
    depth = camera is not None and camera.depth
    for kind in ("lidar", "other_lidars", "imu", "sonars", "rangefinders", *(["camera"] if depth else [])):
        told = getattr(sensors, kind)
        for sensor in told if isinstance(told, list) else [told]:
            if sensor is not None and sensor.mount.link in carried:
                what = "depth pictures are" if kind == "camera" else "it is"
                yield f"{place.at(kind)}: it sits on a link that is moved on command, but {what} read as on the body; mount it there"


def _at(model: UrdfModel, joint: Joint) -> str:
    return f"{model.path}:{joint.line}"


def _least_rate(model: UrdfModel, joint: Joint, spring: Spring) -> float:
    """Hz of physics, from which on this spring is stable with what hangs below the joint; in steps of 100."""
    poses = model.link_poses()
    child_from_base = inverse(poses[joint.child])
    below = {name: compose(child_from_base, poses[name]) for name in model.below(joint.child) if name in poses}
    if (part := whole(model, below)) is None:
        return 0.0
    arm = np.cross(joint.axis, part.com)
    inertia = part.mass if joint.kind == "prismatic" else float(joint.axis @ part.inertia @ joint.axis + part.mass * arm @ arm)
    rate = max(sqrt(spring.stiffness / (STABLE * inertia)), spring.damping / (STABLE * inertia))
    return 100.0 * ceil(rate / 100.0)
