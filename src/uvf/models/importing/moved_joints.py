"""Joints that the makers of a robot move on command: which of them stay joints, and how fast and strong they are."""

from collections.abc import Collection
from dataclasses import replace
from typing import Any

import numpy as np

from uvf.maths.se3 import IDENTITY, compose, inverse
from uvf.models.importing.inertia_guess import mended
from uvf.models.importing.parts import BASE, LIGHT, Parts, new_name, sound_inertial
from uvf.models.importing.robot import Foreign
from uvf.models.shapes.mesh import placed
from uvf.models.urdf.inertia import joined, moved
from uvf.models.urdf.robot import Inertial, Joint, Link
from uvf.models.vehicle.joints import MOVING

INTERFACES = ("position", "effort")
"""By which a place is commanded; by a speed wheels are."""
PLUGINS = ("jointposition", "jointtrajectory", "jointpose")
SPEED, SLIDING, EFFORT = 1.0, 0.1, 100.0  # rad/s, m/s, and N m or N, where the file gives none
SMALL = 0.05  # m, radius of gyration of a part that weighs nothing in the file


def commanded_joints(robot: Any) -> set[str]:
    """Names of the joints that transmissions, ros2_control or Gazebo's plugins below an element move to a place."""
    found = set()
    for transmission in robot.iter("transmission"):
        interfaces = [(tag.text or "").lower() for tag in transmission.iter("hardwareInterface")]
        if any(word in text for text in interfaces for word in INTERFACES):
            found |= {joint.get("name", "") for joint in transmission.findall("joint")}
    for joint in (joint for control in robot.iter("ros2_control") for joint in control.findall("joint")):
        if any(command.get("name") in INTERFACES for command in joint.findall("command_interface")):
            found.add(joint.get("name", ""))
    for plugin in robot.iter("plugin"):
        name = f"{plugin.get('filename', '')}{plugin.get('name', '')}".lower().replace("_", "").replace("-", "")
        if any(word in name for word in PLUGINS):
            found |= {(tag.text or "").strip() for tag in plugin if tag.tag in ("joint_name", "jointName")}
    return found


def kept_joints(foreign: Foreign, links: Collection[str]) -> dict[str, Joint]:
    """Those that stay joints, by the link behind each, with a speed and an effort; from now on these alone count as commanded.

    links: that may move, no wheels and no castors.
    """
    found = {}
    for joint in foreign.model.joints.values():
        if joint.name not in foreign.commanded or joint.kind not in MOVING or joint.mimics or joint.child not in links:
            continue
        if any(name not in links for name in foreign.model.below(joint.child)):
            continue
        if joint.limits is not None and not joint.limits[0] <= 0.0 <= joint.limits[1]:
            foreign.notes.add("joints whose range does not hold zero, held there all the same", joint.name)
            continue
        if not (joint.speed and joint.effort):
            foreign.notes.add("guessed: speed and effort of joints that are moved on command; set them in the URDF's <limit>", joint.name)
        speed = joint.speed or (SLIDING if joint.kind == "prismatic" else SPEED)
        found[joint.child] = replace(joint, speed=speed, effort=joint.effort or EFFORT)
    foreign.commanded = {joint.name for joint in found.values()}
    if found:
        foreign.notes.add("joints that are moved on command", ", ".join(joint.name for joint in found.values()))
    return found


def add_moving(parts: Parts, kept: dict[str, Joint], foreign: Foreign) -> set[str]:
    """The links behind joints that are moved on command, and what hangs fast on them. Returns all of these."""
    model, called = parts.model, {}
    carriers: dict[str, str] = {}
    for name in parts.poses:  # from the root outwards
        above = model.parents[name].parent if name in model.parents else ""
        carrier = name if name in kept else carriers.get(above)
        if carrier is None:
            continue
        carriers[name] = carrier
        link, called[name] = model.links[name], new_name(name, parts)
        parts.links[called[name]] = Link(called[name], link.inertial, link.visuals, link.collisions)
        held_by = carriers.get(above) if name == carrier else carrier
        parent, base_from_parent = (BASE, IDENTITY) if held_by is None else (called[held_by], parts.poses[held_by])
        at = compose(inverse(base_from_parent), parts.poses[name])
        fast = Joint(f"{called[name]}_joint", "fixed", parent, called[name], at)
        joint = replace(kept[name], parent=parent, child=called[name], parent_from_child=at) if name == carrier else fast
        parts.joints[joint.name] = joint
    for name in kept:
        parts.links[called[name]] = replace(parts.links[called[name]], inertial=_carried_mass(parts, called[name], foreign))
    return set(carriers)


def _carried_mass(parts: Parts, link: str, foreign: Foreign) -> Inertial:
    """Of a link and all that is fast on it, which then have none of their own."""
    fast = {link: IDENTITY} | {j.child: j.parent_from_child for j in parts.fast_on(link)}
    told = [moved(inertial, at) for name, at in fast.items() if (inertial := sound_inertial(parts.links[name], foreign)) is not None]
    shapes = tuple(placed(s, at) for name, at in fast.items() for s in parts.links[name].collisions or parts.links[name].visuals)
    for name in fast:
        parts.links[name] = replace(parts.links[name], inertial=None)
    whole = mended(Link(link, joined(told), collisions=shapes), True, foreign.notes).inertial
    return whole if whole is not None else Inertial(LIGHT, np.zeros(3), np.eye(3) * LIGHT * SMALL**2)
