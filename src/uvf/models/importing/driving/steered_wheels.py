"""Whether a robot is a car: a pair of wheels that are steered, and one that stays straight."""

import re
from collections.abc import Sequence
from dataclasses import replace
from math import atan, tan

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import rotate
from uvf.models.importing.driving.wheel_guess import CASTORS, WHEEL, Pair, WheelGuess, wheel_on
from uvf.models.importing.robot import Foreign
from uvf.models.urdf.robot import Joint, Link, UrdfModel

Floats = NDArray[np.float64]

STEERS = re.compile(r"steer|hinge")
UP = np.array((0.0, 0.0, 1.0))

UPRIGHT = 0.7  # of z, that a steering's axis has at least: a rocker rolls
ACROSS = 0.2  # cosine, of a steering's axis with its wheel's at most
TRAIL = 0.35  # of the radius, by which a wheel may stand behind its steering's axis: castors stand farther
MOST = 0.5  # rad, where the file has no limits


def steering_of(model: UrdfModel, wheel: WheelGuess) -> Joint | None:
    """The joint that steers a wheel; None where nothing does, and of castors, which turn by themselves."""
    fork = model.parents.get(wheel.joint.parent)
    while fork is not None and fork.kind == "fixed":
        fork = model.parents.get(fork.parent)
    poses = model.link_poses()
    if fork is None or fork.kind not in ("revolute", "continuous") or fork.child not in poses:
        return None
    if fork.kind == "continuous" and "steer" not in fork.name.lower():
        return None
    axis, arm = rotate(poses[fork.child].rotation, fork.axis), wheel.centre - poses[fork.child].translation
    trail = abs(float(arm @ np.cross(axis, wheel.axis)))
    if abs(axis[2]) < UPRIGHT:
        return None
    named = any(word in f"{fork.name} {fork.child} {wheel.joint.name}".lower() for word in CASTORS)
    return None if named or abs(axis @ wheel.axis) > ACROSS or trail > TRAIL * wheel.radius else fork


def with_rolling_wheels(model: UrdfModel) -> UrdfModel:
    """The model with a rolling joint for each wheel that hangs on its steering without one, as in files made to be looked at."""
    found = [(joint, axis) for joint in model.joints.values() if (axis := _steered_alone(model, joint)) is not None]
    links, joints = dict(model.links), dict(model.joints)
    for joint, axis in found:
        wheel, below = f"{joint.child}_rolling", model.links[joint.child]
        links |= {joint.child: Link(joint.child, line=below.line), wheel: replace(below, name=wheel)}
        joints |= {n: replace(j, parent=wheel) for n, j in joints.items() if j.parent == joint.child}
        joints[f"{joint.name}_rolling"] = Joint(f"{joint.name}_rolling", "continuous", joint.child, wheel, axis=axis, line=joint.line)
        upright = replace(joint, axis=UP) if joint.kind == "continuous" else joint
        joints[joint.name] = replace(upright, kind="revolute", mimics=None)
    return replace(model, links=links, joints=joints) if found else model


def _steered_alone(model: UrdfModel, joint: Joint) -> Floats | None:
    """The axis (3,) in its link about which a wheel would roll that only a steering turns; None for what is none."""
    called = f"{joint.name} {joint.child}".lower()
    if joint.kind not in ("revolute", "continuous") or not WHEEL.search(called) or joint.child not in (poses := model.link_poses()):
        return None
    axis = rotate(poses[joint.child].rotation, joint.axis)
    narrow = joint.kind == "revolute" and joint.limits is not None and 0.0 < joint.limits[1] - joint.limits[0] < np.pi
    if not (narrow and abs(axis[2]) > UPRIGHT) and not (STEERS.search(called) and wheel_on(model, joint) is None):
        return None
    rolls = any(below.parent == joint.child and below.kind != "fixed" for below in model.joints.values())
    if rolls or any(word in called for word in CASTORS):
        return None
    for across in (np.array((0.0, 1.0, 0.0)), np.array((1.0, 0.0, 0.0))):
        turning = replace(joint, kind="continuous", axis=across)
        wheel = wheel_on(model, turning)
        if wheel is not None and wheel.width < 2 * wheel.radius and abs(wheel.axis[2]) < ACROSS:
            return across
    return None


def car_of(foreign: Foreign, pairs: Sequence[Pair]) -> tuple[Pair, Pair] | None:
    """The pair that stays straight and the one that is steered; None for what is no car."""
    model = foreign.model
    if foreign.drive.has_rollers:
        return None
    steering = {wheel.joint.name: steering_of(model, wheel) for pair in pairs for wheel in pair}
    steered = [pair for pair in pairs if all(steering[wheel.joint.name] is not None for wheel in pair)]
    straight = [pair for pair in pairs if all(steering[wheel.joint.name] is None for wheel in pair)]
    options = [(one, other) for other in steered for one in straight if _apart(one, other)]
    if not options:
        return None
    told = {*foreign.drive.left, *foreign.drive.right}
    best = max(options, key=lambda option: (sum(wheel.joint.name in told for wheel in option[0]), round(option[0][0].radius, 3)))
    if told and not any(wheel.joint.name in told for wheel in best[0]):
        foreign.notes.add("the steered wheels drive it; here the straight ones do")
    forks = ", ".join(joint.name for wheel in best[1] if (joint := steering[wheel.joint.name]) is not None)
    foreign.notes.add("a car: its wheels are steered", forks)
    return best


def _apart(straight: Pair, steered: Pair) -> bool:
    """Whether one axle lies before the other, and neither castors nor toys are taken for one."""
    middles = [(a.centre + b.centre) / 2 for a, b in (straight, steered)]
    away = middles[1] - middles[0]
    ahead = away - (away @ straight[0].axis) * straight[0].axis
    alike = 0.5 < straight[0].radius / steered[0].radius < 2.0
    called = any(word in f"{w.joint.name} {w.joint.child}".lower() for w in straight for word in CASTORS)
    return alike and not called and float(np.linalg.norm(ahead)) > straight[0].radius


def steered_most(foreign: Foreign, steered: Pair) -> float:
    """How far the joints turn that steer a pair of wheels [rad], to either side."""
    joints = [joint for wheel in steered if (joint := steering_of(foreign.model, wheel)) is not None]
    limits = [min(-joint.limits[0], joint.limits[1]) for joint in joints if joint.limits is not None]
    most = min((limit for limit in limits if 0.02 < limit < 1.4), default=None)
    if most is None:
        foreign.notes.add("guessed, for no file states it; set it in vehicle.yaml", "how far it steers")
    return MOST if most is None else most


def middle_steering(most: float, wheelbase: float, track: float) -> float:
    """Angle [rad] of a wheel in the middle when the inner one of a pair that is ``track`` [m] apart is turned by ``most`` [rad]."""
    return atan(wheelbase * tan(most) / (wheelbase + track / 2 * tan(most)))
