"""Which two joints drive a vehicle, which way is up and which is forward: guessed from axes, places and names."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import from_matrix, rotate
from uvf.maths.se3 import Transform, inverse
from uvf.models.importing.robot import Foreign
from uvf.models.shapes.mesh import placed, reach
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.robot import Joint, UrdfModel
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]

PARALLEL = 0.97
ALIKE = 0.12  # share by which the radii of a pair may differ
PASSIVE = re.compile(r"cast[eo]r|swivel|passive|idler|fork|steer|pivot|omni|follow", re.I)
DRIVEN = re.compile(r"wheel|whl|tire|tyre|ruota|rueda|roue|rad\b|drive|motor|trac", re.I)
LEFT = re.compile(
    r"left|izq|sinist|gauche|link?s|(^|[_\-.0-9])l([_\-.0-9]|$)|^l(w|wheel|m)|wheel_?l($|_)|wl($|_)|(?-i:[a-z]L($|[_A-Z]))",
    re.I,
)
RIGHT = re.compile(
    r"right|der(echa)?_|destr|droit|recht|(^|[_\-.0-9])r([_\-.0-9]|$)|^r(w|wheel|m)|wheel_?r($|_)|wr($|_)|(?-i:[a-z]R($|[_A-Z]))",
    re.I,
)


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


@dataclass(frozen=True)
class DrivePair:
    """The driven wheels, left and right as the vehicle drives, and the other wheels.

    base_from_root: to the floor under the axle's middle, x forward, z up.
    """

    left: WheelGuess
    right: WheelGuess
    others: tuple[WheelGuess, ...]
    base_from_root: Transform

    @property
    def radius(self) -> float:
        """Mean radius of the two driven wheels [m]."""
        return (self.left.radius + self.right.radius) / 2

    @property
    def track(self) -> float:
        """Distance between the centres of the two driven wheels [m]."""
        return float(np.linalg.norm(self.left.centre - self.right.centre))


def find_pair(foreign: Foreign) -> DrivePair:
    """The pair of joints that drives a vehicle. Raises BadInput, with what a person must do, where there is none."""
    model = foreign.model
    wheels = [w for joint in model.joints.values() if _may_turn(joint) and (w := _wheel(model, joint)) is not None]
    pairs = [(a, b) for a, b in combinations(wheels, 2) if _opposite(a, b)]
    if not pairs:
        found = ", ".join(w.joint.name for w in wheels) or "none"
        fixed = ", ".join(name for name, joint in model.joints.items() if not _may_turn(joint) and "wheel" in name.lower())
        held = f"; wheels that are fixed: {fixed}" if fixed else ""
        raise BadInput(
            f"{model.path}: no two wheels of one size on one axis; joints that turn: {found}{held}. "
            "UVF drives two wheels on one axle: make their joints continuous, give both a shape, name them ..._left... and ..._right..."
        )
    middle = np.mean([p.translation for p in model.link_poses().values()], axis=0)
    best = max(pairs, key=lambda pair: _score(pair, foreign, middle))
    return _oriented(best, tuple(w for w in wheels if w not in best), foreign)


def _may_turn(joint: Joint) -> bool:
    wide = joint.limits is None or joint.limits[1] - joint.limits[0] > 2 * np.pi or joint.limits == (0.0, 0.0)
    return joint.kind == "continuous" or (joint.kind == "revolute" and (wide or bool(DRIVEN.search(joint.name))))


def _wheel(model: UrdfModel, joint: Joint) -> WheelGuess | None:
    """None where nothing round hangs on the joint."""
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


def _opposite(a: WheelGuess, b: WheelGuess) -> bool:
    """On one axis, of one size, apart."""
    apart = a.centre - b.centre
    distance = float(np.linalg.norm(apart))
    if distance < 0.5 * a.radius or abs(a.radius - b.radius) > ALIKE * a.radius or abs(a.axis @ b.axis) < PARALLEL:
        return False
    return bool(abs(apart @ a.axis) / distance > PARALLEL)


def _score(pair: tuple[WheelGuess, WheelGuess], foreign: Foreign, middle: Floats) -> tuple[float, ...]:
    names = [w.joint.name + " " + w.joint.child for w in pair]
    told = {*foreign.drive.left, *foreign.drive.right}
    score = 10.0 * all(w.joint.name in told for w in pair)
    score += 2.0 * all(DRIVEN.search(n) for n in names) - 5.0 * any(PASSIVE.search(n) for n in names)
    score += 2.0 * (any(LEFT.search(n) for n in names) and any(RIGHT.search(n) for n in names))
    score -= 3.0 * any(w.joint.mimics is not None for w in pair)
    between = (pair[0].centre + pair[1].centre) / 2
    return score, round(pair[0].radius, 3), -round(float(np.linalg.norm(between - middle)), 3)


def _oriented(pair: tuple[WheelGuess, WheelGuess], others: tuple[WheelGuess, ...], foreign: Foreign) -> DrivePair:
    a, b = pair
    lateral = (a.centre - b.centre) / np.linalg.norm(a.centre - b.centre)
    up = _up(foreign, lateral, a)
    left_is_a = _left_is_first(pair, foreign, up)
    left, right = (a, b) if left_is_a else (b, a)
    side = lateral if left_is_a else -lateral
    forward = np.cross(side, up)
    forward /= np.linalg.norm(forward)
    root_from_base = Transform(
        from_matrix(np.column_stack((forward, np.cross(up, forward), up))),
        (left.centre + right.centre) / 2 - up * (left.radius + right.radius) / 2,
    )
    if abs(forward[0]) < 0.99 or up[2] < 0.99:
        foreign.notes.add(f"axes turned: forward was {_row(forward)} and up {_row(up)} in the file's root")
    return DrivePair(left, right, others, inverse(root_from_base))


def _up(foreign: Foreign, lateral: Floats, wheel: WheelGuess) -> Floats:
    """z unless the axle is upright then; else the direction in which the wheels are lowest."""
    best = np.array((0.0, 0.0, 1.0))
    if abs(lateral[2]) >= 0.3:
        options = [d for d in _six() if abs(d @ lateral) < 0.3]
        poses = foreign.model.link_poses()
        everything = [s for name in foreign.model.roots[:1] for s in shapes_below(foreign.model, name, poses)]
        lows = [max(float(reach(s, -d[None])[0]) for s in everything) + float(wheel.centre @ d) for d in options]
        best = options[int(np.argmin(lows))]
    level = best - (best @ lateral) * lateral
    up: Floats = level / np.linalg.norm(level)
    return up


def _six() -> Iterator[Floats]:
    for sign in (1.0, -1.0):
        yield from sign * np.eye(3)[::-1]


def _left_is_first(pair: tuple[WheelGuess, WheelGuess], foreign: Foreign, up: Floats) -> bool:
    """x forward counts (REP-103); where x is no way to drive, names or the plugin say what is left."""
    a, b = pair
    forward = np.cross((a.centre - b.centre) / np.linalg.norm(a.centre - b.centre), up)
    by_names = _by_names(a, b, foreign)
    if abs(forward[0]) > 0.7:
        if by_names is not None and by_names != (forward[0] > 0):
            foreign.notes.add("left and right exchanged: by their places with x forward the wheels are on the other sides than named")
        return bool(forward[0] > 0)
    if by_names is None:
        foreign.notes.add("guessed which wheel is left: neither x nor the names tell; check the direction of driving")
        return bool(forward[np.argmax(np.abs(forward))] > 0)
    return by_names


def _by_names(a: WheelGuess, b: WheelGuess, foreign: Foreign) -> bool | None:
    """Whether the first is called left; None = not told."""
    for wheel, if_left in ((a, True), (b, False)):
        if wheel.joint.name in foreign.drive.left:
            return if_left
    names = [w.joint.name + " " + w.joint.child for w in (a, b)]
    lefts = [bool(LEFT.search(n)) and not RIGHT.search(n) for n in names]
    rights = [bool(RIGHT.search(n)) and not LEFT.search(n) for n in names]
    if (lefts[0] and not lefts[1]) or (rights[1] and not rights[0]):
        return True
    if (lefts[1] and not lefts[0]) or (rights[0] and not rights[1]):
        return False
    return None


def _row(values: NDArray[Any]) -> str:
    return "(" + ", ".join(f"{round(float(v), 2) + 0.0:g}" for v in values) + ")"
