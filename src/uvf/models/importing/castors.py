"""What a foreign body stands on beside its wheels: balls that slide, low enough and not too low."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se3 import IDENTITY, Transform
from uvf.models.importing.driving.drive_wheels import swivels
from uvf.models.importing.driving.wheel_guess import CASTORS, shapes_below
from uvf.models.importing.parts import BASE, Parts
from uvf.models.importing.robot import Foreign
from uvf.models.shapes.mesh import placed, reach, triangles
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.robot import Joint, Link

Floats = NDArray[np.float64]

DOWN = np.array(((0.0, 0.0, -1.0),))
SLIDE = "wheels that neither drive nor swivel became balls that slide"
LOW = 0.004  # m above the floor, within which a shape is meant to touch it
LIFT = 0.0005  # m
CLEAR = 0.008  # m above the floor, of a body that wheels carry
NEAR_FLOOR = 0.35  # of the wheel's radius: what a castor's link may be off the floor


def castors_of(parts: Parts, rest: list[str], foreign: Foreign) -> dict[str, Solid]:
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


def _ball(link: Link, parts: Parts, sure: bool) -> Solid | None:
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


def lower_feet(parts: Parts, foreign: Foreign) -> None:
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


def lift_castors(parts: Parts, foreign: Foreign) -> None:
    """A rigid body on castors before and behind its axle leaves its wheels next to no weight: they would slip."""
    low: dict[str, float] = {}  # joint -> x of what touches the floor
    for joint in parts.fast_on(BASE):
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
