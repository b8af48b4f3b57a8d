"""A foreign body as UVF wants it: base_link on the floor under the axle, wheels with plain axes, all else held fast."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import rotate
from uvf.maths.se3 import IDENTITY, Transform, apply, compose, inverse
from uvf.models.importing.drive_wheels import DriveWheels, swivels
from uvf.models.importing.inertia_guess import mended
from uvf.models.importing.robot import Foreign
from uvf.models.importing.steered_wheels import steered_most, steering_of
from uvf.models.importing.wheel_guess import CASTORS, WheelGuess, shapes_below
from uvf.models.shapes.mesh import placed, reach, triangles
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.inertia import joined, moved
from uvf.models.urdf.robot import Inertial, Joint, Link, UrdfModel
from uvf.models.urdf.rules import LIGHTEST_WHEEL, RESERVED, inertial_faults

Floats = NDArray[np.float64]

BASE = "base_link"
DOWN = np.array(((0.0, 0.0, -1.0),))
Y, Z = np.array((0.0, 1.0, 0.0)), np.array((0.0, 0.0, 1.0))
LIGHT = 0.01  # kg, of a steering that weighs nothing in the file
SLIDE = "wheels that neither drive nor swivel became balls that slide"
LOW = 0.004  # m above the floor, within which a shape is meant to touch it
LIFT = 0.0005  # m
CLEAR = 0.008  # m above the floor, of a body that wheels carry
NEAR_FLOOR = 0.35  # of the wheel's radius: what a castor's link may be off the floor


@dataclass
class _Parts:
    """The model in base_link: base_from_link of every link, and what became of them."""

    model: UrdfModel
    wheels: DriveWheels
    poses: dict[str, Transform]
    links: dict[str, Link]
    joints: dict[str, Joint]


def rebuilt(foreign: Foreign, wheels: DriveWheels) -> UrdfModel:
    """The vehicle's model rebuilt to UVF's conventions; notes of what was changed go to ``foreign``."""
    model = foreign.model
    poses = {name: compose(wheels.base_from_root, pose) for name, pose in model.link_poses().items()}
    parts = _Parts(model, wheels, poses, {}, {})
    below = {w.joint.name: [n for n in model.below(w.joint.child) if n in poses] for w in (*wheels.driven, *(wheels.steered or ()))}
    knuckles = {w.joint.name: _knuckle(foreign, w, below[w.joint.name], poses) for w in wheels.steered or ()}
    turning = {name for names in (*below.values(), *knuckles.values()) for name in names}
    rest = [name for name in poses if name not in turning]
    castors = _castors(parts, rest, foreign)
    trunk = _trunk(parts, rest)
    _add_base(parts, trunk, foreign)
    for name in rest:
        if name not in trunk:
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
    held = [j.name for j in model.joints.values() if j.kind != "fixed" and j.child in rest and j.child not in castors]
    if held:
        foreign.notes.add("joints that move but drive nothing, held fast at zero", ", ".join(held))
    _lower_feet(parts, foreign)
    _lift_castors(parts, foreign)
    return UrdfModel(model.path, model.name, _weighed(parts, foreign), parts.joints)


def _weighed(parts: _Parts, foreign: Foreign) -> dict[str, Link]:
    """Links with inertias that there can be. All but the wheels is one body: what its parts tell of their masses is all of it."""
    body = {BASE: IDENTITY, **{j.child: j.parent_from_child for j in parts.joints.values() if j.kind == "fixed"}}
    given = [moved(sound, body[name]) for name in body if (sound := _sound(parts.links[name], foreign)) is not None]
    if not given:
        return {name: mended(link, name == BASE, foreign.notes) for name, link in parts.links.items()}
    shapes = {kind: tuple(placed(s, body[n]) for n in body for s in getattr(parts.links[n], kind)) for kind in ("visuals", "collisions")}
    whole = mended(Link(BASE, joined(given), shapes["visuals"], shapes["collisions"]), True, foreign.notes)
    assert whole.inertial is not None
    least, found = LIGHTEST_WHEEL * whole.inertial.mass, dict(parts.links)
    for name, link in parts.links.items():
        if name in body:
            found[name] = replace(link, inertial=whole.inertial if name == BASE else None)
            continue
        weightless = bool(link.collisions) and link.inertial is not None and link.inertial.mass < least
        found[name] = mended(replace(link, inertial=None) if weightless else link, False, foreign.notes)
    return found


def _sound(link: Link, foreign: Foreign) -> Inertial | None:
    """What a link tells of its mass, its inertia replaced where that is impossible; None where it tells nothing."""
    told = link.inertial
    if told is None or told.mass <= 0:
        return None
    return mended(link, True, foreign.notes).inertial if any(inertial_faults(told)) else told


def _trunk(parts: _Parts, rest: list[str]) -> list[str]:
    """The links that become base_link: the root, an own base_link, and, where these weigh nothing, what carries the wheels."""
    trunk = [parts.model.roots[0], *([BASE] if BASE in rest else [])]
    if all(parts.model.links[n].inertial is None for n in trunk):
        trunk.append(parts.wheels.driven[0].joint.parent)
    return [n for n in dict.fromkeys(trunk) if n in rest]


def _add_base(parts: _Parts, trunk: list[str], foreign: Foreign) -> None:
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


def _add_fixed(parts: _Parts, name: str, castors: dict[str, Solid], foreign: Foreign) -> None:
    """A link as it is, held fast on base_link; of a castor the visual stays and a sphere touches the floor."""
    link, pose = parts.model.links[name], parts.poses[name]
    new = _named(name, parts)
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


def _named(name: str, parts: _Parts) -> str:
    clean = "".join(c if c.isalnum() or c in "_.-" else "_" for c in name).strip("_") or "link"
    return clean if clean not in (*parts.links, *RESERVED) else f"{clean}_{len(parts.links)}"


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


def _add_wheel(parts: _Parts, called: str, wheel: WheelGuess, names: list[str], parent: str = BASE, axis: Floats = Y) -> None:
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


def _add_knuckle(parts: _Parts, called: str, wheel: WheelGuess, turned: tuple[list[str], float]) -> None:
    """A link at the middle of the wheel's tread on an upright joint; turned: the links in it, and by how much it turns at most [rad]."""
    centre = apply(parts.wheels.base_from_root, wheel.centre[None])[0]
    (names, most), name, joint = turned, f"{called}_link", f"{called}_joint"
    masses, looks = _joined_at(parts, centre, names, name)
    light = Inertial(LIGHT, np.zeros(3), np.eye(3) * LIGHT * wheel.radius**2)
    parts.links[name] = Link(name, masses or light, looks, ())
    parts.joints[joint] = Joint(joint, "revolute", BASE, name, Transform(IDENTITY.rotation, centre), Z, (-most, most))


def _joined_at(parts: _Parts, centre: Floats, names: list[str], called: str) -> tuple[Inertial | None, tuple[Solid, ...]]:
    """Mass and looks of links as those of one, which stands at ``centre`` (3,) [m] in the axes of base_link."""
    links = [parts.model.links[n] for n in names]
    frames = {n: compose(Transform(IDENTITY.rotation, -centre), parts.poses[n]) for n in names}
    masses = [moved(link.inertial, frames[link.name]) for link in links if link.inertial is not None]
    looks = tuple(replace(placed(s, frames[k.name]), name=called) for k in links for s in (k.visuals or k.collisions))
    return joined(masses), looks


def _castors(parts: _Parts, rest: list[str], foreign: Foreign) -> dict[str, Solid]:
    """Link -> the ball with which it touches the floor: castors by name or because they turn, and wheels that do not drive."""
    found: dict[str, Solid] = {}
    others = {w.joint.child for w in parts.wheels.others}
    for name in rest:
        link, joint = parts.model.links[name], parts.model.parents.get(name)
        called = any(word in name.lower() for word in CASTORS) or (joint is not None and any(w in joint.name.lower() for w in CASTORS))
        moves = joint is not None and joint.kind != "fixed"
        if name in others or called or moves:
            ball = _ball(link, parts, name in others or called)
            if ball is not None:
                found[name] = ball
    extra = [w.joint.name for w in parts.wheels.others if w.joint.child in found and not swivels(parts.model, w.joint)]
    if len(extra) >= 2:
        foreign.notes.add(SLIDE, ", ".join(extra))
    skidding = {parts.model.joints[name].child for name in extra} if len(extra) >= 2 else set()
    plain = [n for n in found if n not in skidding]
    if plain:
        foreign.notes.add("castors became balls that slide and touch the floor", ", ".join(plain))
    return found


def _ball(link: Link, parts: _Parts, sure: bool) -> Solid | None:
    """None for what does not come near the floor."""
    solids = shapes_below(replace(parts.model, joints={}), link.name, parts.poses)
    if not solids:
        return None
    lows = [-float(reach(s, DOWN)[0]) for s in solids]
    low, high = min(lows), max(float(reach(s, -DOWN)[0]) for s in solids)
    if abs(low) > (NEAR_FLOOR * parts.wheels.radius if sure else LOW):
        return None
    radius = float(np.clip((high - low) / 2, 0.003, parts.wheels.radius))
    corners = triangles(solids[int(np.argmin(lows))])[0]
    lowest = corners[corners[:, 2] <= corners[:, 2].min() + 1e-3]
    x, y = (lowest.min(axis=0) + lowest.max(axis=0))[:2] / 2
    return Solid(link.name, "sphere", (radius,), np.array((x, y, radius)), colour=(0.4, 0.4, 0.4))


def _lower_feet(parts: _Parts, foreign: Foreign) -> None:
    """Shapes of base_link that touch the floor become links of their own, for they slide as castors do."""
    base = parts.links[BASE]
    feet = [s for s in base.collisions if abs(-float(reach(s, DOWN)[0])) <= LOW]
    if feet and len(parts.wheels.driven) + len(parts.wheels.steered or ()) > 2:
        parts.links[BASE] = replace(base, collisions=tuple(_raised(s) if s in feet else s for s in base.collisions))
        foreign.notes.add(
            f"shapes of the body that touch the floor raised to {CLEAR * 1000:g} mm above it, for its wheels carry it", f"{len(feet)}"
        )
        return
    if not feet or len(feet) == len(base.collisions):
        return
    parts.links[BASE] = replace(base, collisions=tuple(s for s in base.collisions if s not in feet))
    for i, foot in enumerate(feet):
        name = f"castor_{i}_link"
        at = Transform(IDENTITY.rotation, foot.position)
        parts.links[name] = Link(name, None, (), (replace(foot, name=name, position=np.zeros(3)),))
        parts.joints[f"castor_{i}_joint"] = Joint(f"castor_{i}_joint", "fixed", BASE, name, at)
    foreign.notes.add("shapes of the body that touch the floor made castors that slide", f"{len(feet)}")


def _raised(solid: Solid) -> Solid:
    """A shape of base_link with its lowest point at ``CLEAR``."""
    low = -float(reach(solid, DOWN)[0])
    return replace(solid, position=solid.position + np.array((0.0, 0.0, CLEAR - low)))


def _lift_castors(parts: _Parts, foreign: Foreign) -> None:
    """A rigid body on castors before and behind its axle leaves its wheels next to no weight: they would slip."""
    low: dict[str, float] = {}  # joint -> x of what touches the floor
    for joint in (j for j in parts.joints.values() if j.kind == "fixed"):
        for solid in (placed(s, joint.parent_from_child) for s in parts.links[joint.child].collisions):
            if -float(reach(solid, DOWN)[0]) < LIFT:
                low[joint.name] = float(solid.position[0])
    if not low or min(low.values()) > -LIFT or max(low.values()) < LIFT:
        return
    for name in low:
        joint = parts.joints[name]
        at = Transform(joint.parent_from_child.rotation, joint.parent_from_child.translation + np.array((0.0, 0.0, LIFT)))
        parts.joints[name] = replace(joint, parent_from_child=at)
    foreign.notes.add(f"castors before and behind the axle lifted by {LIFT * 1000:g} mm, so that the wheels carry weight", ", ".join(low))


def _box_about(solids: tuple[Solid, ...]) -> Solid:
    corners = np.vstack([triangles(s)[0] for s in solids])
    low, high = corners.min(axis=0), corners.max(axis=0)
    x, y, z = (float(v) for v in np.maximum(high - low, 1e-3))
    return Solid(BASE, "box", (x, y, z), (low + high) / 2)
