"""A foreign body as UVF wants it: base_link on the floor under the axle, wheels with plain axes, most else held fast."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import rotate
from uvf.maths.se3 import IDENTITY, Transform, apply, compose, inverse
from uvf.models.importing.castors import LIFT, NEAR_FLOOR, castors_of, lift_castors, lower_feet
from uvf.models.importing.driving.drive_wheels import DriveWheels
from uvf.models.importing.driving.steered_wheels import steered_most, steering_of
from uvf.models.importing.driving.wheel_guess import WheelGuess
from uvf.models.importing.inertia_guess import mended
from uvf.models.importing.moved_joints import add_moving, kept_joints
from uvf.models.importing.parts import BASE, LIGHT, Parts, new_name, sound_inertial
from uvf.models.importing.robot import Foreign
from uvf.models.shapes.mesh import placed, triangles
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.inertia import joined, moved
from uvf.models.urdf.robot import Inertial, Joint, Link, UrdfModel
from uvf.models.urdf.rules import LIGHTEST_WHEEL, RESERVED

Floats = NDArray[np.float64]

Y, Z = np.array((0.0, 1.0, 0.0)), np.array((0.0, 0.0, 1.0))


def rebuilt(foreign: Foreign, wheels: DriveWheels) -> UrdfModel:
    """The vehicle's model rebuilt to UVF's conventions; notes of what was changed go to ``foreign``."""
    model = foreign.model
    poses = {name: compose(wheels.base_from_root, pose) for name, pose in model.link_poses().items()}
    parts = Parts(model, wheels, poses, {}, {})
    below = {w.joint.name: [n for n in model.below(w.joint.child) if n in poses] for w in (*wheels.driven, *(wheels.steered or ()))}
    knuckles = {w.joint.name: _knuckle(foreign, w, below[w.joint.name], poses) for w in wheels.steered or ()}
    turning = {name for names in (*below.values(), *knuckles.values()) for name in names}
    rest = [name for name in poses if name not in turning]
    castors = castors_of(parts, rest, foreign)
    trunk = _trunk(parts, rest)
    _add_base(parts, trunk, foreign)
    kept = kept_joints(foreign, {name for name in rest if name not in castors and name not in trunk})
    moving = add_moving(parts, kept, foreign)
    for name in rest:
        if name not in trunk and name not in moving:
            _add_fixed(parts, name, castors, foreign)
    for side, several in (("left", wheels.left), ("right", wheels.right)):
        for name, wheel in zip(wheel_names(side, len(several)), several, strict=True):
            _add_wheel(parts, name, wheel, below[wheel.joint.name])
    for name, wheel in zip(wheel_names("omni", len(wheels.around)), wheels.around, strict=True):
        _add_wheel(parts, name, wheel, below[wheel.joint.name], axis=rotate(wheels.base_from_root.rotation, wheel.axis))
    if wheels.steered is not None:
        most = steered_most(foreign, wheels.steered)
        for side, wheel in zip(("left", "right"), wheels.steered, strict=True):
            lowered = _on_floor(wheel, wheels, foreign)
            _add_knuckle(parts, f"steering_{side}", lowered, (knuckles[wheel.joint.name], most))
            _add_wheel(parts, f"steered_{side}", lowered, below[wheel.joint.name], f"steering_{side}_link")
    foreign.notes.add("wheels touch as balls of their radius: one contact at the middle of the tread")
    held = [j.name for j in model.joints.values() if j.kind != "fixed" and j.child in rest and j.child not in (*castors, *kept)]
    if held:
        foreign.notes.add("joints that move but drive nothing, held fast at zero (to move one, import with --joint NAME)", ", ".join(held))
    lower_feet(parts, foreign)
    lift_castors(parts, foreign)
    return UrdfModel(model.path, model.name, _weighed(parts, foreign), parts.joints)


def _weighed(parts: Parts, foreign: Foreign) -> dict[str, Link]:
    """Links with inertias that there can be. All but the wheels is one body: what its parts tell of their masses is all of it."""
    body = {BASE: IDENTITY, **{j.child: j.parent_from_child for j in parts.fast_on(BASE)}}
    given = [moved(sound, body[name]) for name in body if (sound := sound_inertial(parts.links[name], foreign)) is not None]
    if not given:
        return {name: mended(link, name == BASE, foreign.notes) for name, link in parts.links.items()}
    shapes = {kind: tuple(placed(s, body[n]) for n in body for s in getattr(parts.links[n], kind)) for kind in ("visuals", "collisions")}
    whole = mended(Link(BASE, joined(given), shapes["visuals"], shapes["collisions"]), True, foreign.notes)
    assert whole.inertial is not None
    least, found = LIGHTEST_WHEEL * whole.inertial.mass, dict(parts.links)
    carried = UrdfModel(parts.model.path, "", parts.links, parts.joints).carried_by(foreign.commanded)
    for name, link in parts.links.items():
        if name in carried:
            continue
        if name in body:
            found[name] = replace(link, inertial=whole.inertial if name == BASE else None)
            continue
        weightless = bool(link.collisions) and link.inertial is not None and link.inertial.mass < least
        found[name] = mended(replace(link, inertial=None) if weightless else link, False, foreign.notes)
    return found


def _trunk(parts: Parts, rest: list[str]) -> list[str]:
    """The links that become base_link: the root, an own base_link, and, where these weigh nothing, what carries the wheels."""
    trunk = [parts.model.roots[0], *([BASE] if BASE in rest else [])]
    if all(parts.model.links[n].inertial is None for n in trunk):
        trunk.append(parts.wheels.driven[0].joint.parent)
    return [n for n in dict.fromkeys(trunk) if n in rest]


def _add_base(parts: Parts, trunk: list[str], foreign: Foreign) -> None:
    links = [parts.model.links[n] for n in trunk]
    masses = [moved(link.inertial, parts.poses[link.name]) for link in links if link.inertial is not None]
    shapes = [tuple(placed(s, parts.poses[k.name]) for k in links for s in getattr(k, kind)) for kind in ("visuals", "collisions")]
    visuals, collisions = (tuple(replace(s, name=BASE) for s in kind) for kind in shapes)
    carries = any(link.collisions for name, link in parts.model.links.items() if name in parts.model.rigid_with(trunk[0]))
    if not collisions and visuals and not carries:
        foreign.notes.add("no collision shape in the file: the bounding box of the visual is taken", ", ".join(trunk))
        collisions = (_box_about(visuals),)
    parts.links[BASE] = Link(BASE, joined(masses), visuals, collisions)
    gone = [n for n in trunk if n != BASE]
    if gone:
        foreign.notes.add(f"links made part of {BASE}, which lies on the floor under the axle", ", ".join(gone))


def _add_fixed(parts: Parts, name: str, castors: dict[str, Solid], foreign: Foreign) -> None:
    """A link as it is, held fast on base_link; of a castor the visual stays and a sphere touches the floor."""
    link, pose = parts.model.links[name], parts.poses[name]
    new = new_name(name, parts)
    collisions = tuple(s for s in link.collisions) if name not in castors else ()
    if name in castors:
        ball = castors[name]
        collisions = (replace(ball, name=new, position=apply(inverse(pose), ball.position[None])[0]),)
    bears = any(j.parent == name for j in parts.model.joints.values())
    if not any((link.inertial, link.visuals, collisions)) and (bears or name in RESERVED):
        foreign.notes.add("frames without mass or shape dropped", name)
        return
    parts.links[new] = Link(new, link.inertial, link.visuals, collisions)
    parts.joints[f"{new}_joint"] = Joint(f"{new}_joint", "fixed", BASE, new, pose)


def wheel_names(side: str, count: int) -> list[str]:
    """What the wheels of a side are called, from the front: their joints end in _joint, their links in _link."""
    return [f"wheel_{side}"] if count == 1 else [f"wheel_{side}_{i}" for i in range(1, count + 1)]


def _on_floor(wheel: WheelGuess, wheels: DriveWheels, foreign: Foreign) -> WheelGuess:
    """The same wheel where it touches the floor on which the others stand; what hangs elsewhere stays there, for the check to tell of."""
    gap = float(apply(wheels.base_from_root, wheel.centre[None])[0, 2]) - wheel.radius
    if abs(gap) > NEAR_FLOOR * wheel.radius:
        return wheel
    if abs(gap) > LIFT:
        foreign.notes.add("steered wheels put on the floor", f"{wheel.joint.name} by {-gap * 1000:.1f} mm")
    up = inverse(wheels.base_from_root).rotation
    return replace(wheel, centre=wheel.centre - gap * rotate(up, Z))


def _knuckle(foreign: Foreign, wheel: WheelGuess, turning: list[str], poses: dict[str, Transform]) -> list[str]:
    """The links that a steering turns, beside the wheel's own."""
    joint = steering_of(foreign.model, wheel)
    assert joint is not None
    return [n for n in foreign.model.below(joint.child) if n in poses and n not in turning]


def _add_wheel(parts: Parts, called: str, wheel: WheelGuess, names: list[str], parent: str = BASE, axis: Floats = Y) -> None:
    """A link at the middle of the tread, its axes those of base_link, on a joint about y or another ``axis``.

    ``parent`` stands there, too, or is the base.
    """
    centre = apply(parts.wheels.base_from_root, wheel.centre[None])[0]
    name = f"{called}_link"
    ball = Solid(name, "sphere", (wheel.radius,), np.zeros(3))
    masses, looks = _joined_at(parts, centre, names, name)
    parts.links[name] = Link(name, masses, looks, (ball,))
    joint = f"{called}_joint"
    at = Transform(IDENTITY.rotation, centre) if parent == BASE else IDENTITY
    parts.joints[joint] = Joint(joint, "continuous", parent, name, at, axis)


def _add_knuckle(parts: Parts, called: str, wheel: WheelGuess, turned: tuple[list[str], float]) -> None:
    """A link at the middle of the wheel's tread on an upright joint; turned: the links in it, and by how much it turns at most [rad]."""
    centre = apply(parts.wheels.base_from_root, wheel.centre[None])[0]
    (names, most), name, joint = turned, f"{called}_link", f"{called}_joint"
    masses, looks = _joined_at(parts, centre, names, name)
    light = Inertial(LIGHT, np.zeros(3), np.eye(3) * LIGHT * wheel.radius**2)
    parts.links[name] = Link(name, masses or light, looks, ())
    parts.joints[joint] = Joint(joint, "revolute", BASE, name, Transform(IDENTITY.rotation, centre), Z, (-most, most))


def _joined_at(parts: Parts, centre: Floats, names: list[str], called: str) -> tuple[Inertial | None, tuple[Solid, ...]]:
    """Mass and looks of links as those of one, which stands at ``centre`` (3,) [m] in the axes of base_link."""
    links = [parts.model.links[n] for n in names]
    frames = {n: compose(Transform(IDENTITY.rotation, -centre), parts.poses[n]) for n in names}
    masses = [moved(link.inertial, frames[link.name]) for link in links if link.inertial is not None]
    looks = tuple(replace(placed(s, frames[k.name]), name=called) for k in links for s in (k.visuals or k.collisions))
    return joined(masses), looks


def _box_about(solids: tuple[Solid, ...]) -> Solid:
    corners = np.vstack([triangles(s)[0] for s in solids])
    low, high = corners.min(axis=0), corners.max(axis=0)
    x, y, z = (float(v) for v in np.maximum(high - low, 1e-3))
    return Solid(BASE, "box", (x, y, z), (low + high) / 2)
