"""Which joints drive a vehicle, which way is up and which is forward: guessed from axes, places and names."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import from_matrix, rotate
from uvf.maths.se3 import IDENTITY, Transform, apply, inverse
from uvf.maths.wheels.scrubbing import Scrubbing, scrubbing, shared_loads
from uvf.models.importing.driving.omni_wheels import meeting_point, ring_of
from uvf.models.importing.driving.steered_wheels import UPRIGHT, car_of, steering_of, with_rolling_wheels
from uvf.models.importing.driving.wheel_guess import CASTORS, Pair, WheelGuess, loosened_wheels, may_turn, wheel_on
from uvf.models.importing.driving.which_way import LEFT, RIGHT, left_is_first, names_of, row, up_of
from uvf.models.importing.robot import Foreign
from uvf.models.urdf.inertia import whole
from uvf.models.urdf.robot import Joint, UrdfModel
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]

PARALLEL = 0.97
LEVEL, OFF_FLOOR = 0.3, 0.35  # of an axis' z, and of a radius
ROCKS = 0.7  # cosine between the axes of a rocker and its wheel, at least
MIDDLE = 0.3  # of the radius, that a wheel may be off the middle of an axle of which it stands for both ends
ALIKE = 0.12  # share by which the radii of a pair may differ, and the tracks of pairs that drive together
MECANUM = re.compile(r"mecan|omni.?wheel|swedish", re.I)
PASSIVE = re.compile(r"cast[eo]r|swivel|passive|idler|fork|steer|pivot|omni|follow", re.I)
DRIVEN = re.compile(r"wheel|whl|tire|tyre|ruota|rueda|roue|rad\b|drive|motor|trac", re.I)


@dataclass(frozen=True)
class DriveWheels:
    """The driven wheels, left and right as the vehicle drives, from the front, and the other wheels.

    base_from_root: to the floor under the point about which the vehicle turns, x forward, z up; turning_track: track of the two wheels
    on the axle through it that turn as all of them do [m]; kind: of drive, as in vehicle.yaml; steered: of a car.
    """

    left: tuple[WheelGuess, ...]
    right: tuple[WheelGuess, ...]
    others: tuple[WheelGuess, ...]
    base_from_root: Transform
    turning_track: float
    kind: str = "differential"
    steered: Pair | None = None
    around: tuple[WheelGuess, ...] = ()
    """Of an omni drive, which has neither left nor right ones."""

    @property
    def wheelbase(self) -> float:
        """Distance between the foremost and the rearmost driven wheels' axles, or of a car between both axles [m]."""
        if self.steered is not None:
            return float(abs(apply(self.base_from_root, np.array([wheel.centre for wheel in self.steered]))[:, 0].mean()))
        ends = np.array([wheel.centre for side in (self.left, self.right) for wheel in (side[0], side[-1])])
        ahead = apply(self.base_from_root, ends)[:, 0]
        return float(ahead[::2].mean() - ahead[1::2].mean())

    @property
    def steered_track(self) -> float:
        """Of a car: distance between the steered wheels [m]."""
        return _track(self.steered[:1], self.steered[1:]) if self.steered is not None else 0.0

    @property
    def driven(self) -> tuple[WheelGuess, ...]:
        """All of them, the left side first."""
        return self.left + self.right + self.around

    @property
    def radius(self) -> float:
        """Mean radius of the driven wheels [m]."""
        return float(np.mean([wheel.radius for wheel in self.driven]))

    @property
    def track(self) -> float:
        """Mean distance between the wheels of a pair [m]; of an omni drive, diameter of the ring of wheels."""
        if self.around:
            return self.turning_track
        return _track(self.left, self.right)


def _track(left: tuple[WheelGuess, ...], right: tuple[WheelGuess, ...]) -> float:
    return float(np.mean([np.linalg.norm(a.centre - b.centre) for a, b in zip(left, right, strict=True)]))


def find_wheels(foreign: Foreign) -> DriveWheels:
    """The joints that drive a vehicle. Raises BadInput, with what a person must do, where there are none."""
    model = foreign.model = with_rolling_wheels(foreign.model)
    turning = [joint for joint in model.joints.values() if may_turn(joint, _is_called_wheel(joint))]
    wheels = [wheel for joint in turning if (wheel := wheel_on(model, joint)) is not None]
    if ring := ring_of(wheels):
        return _omni(ring, wheels, foreign)
    pairs = [(a, b) for a, b in combinations(wheels, 2) if _opposite(a, b)]
    if virtual := [wheel.joint for wheel in wheels if any(_in_the_middle(wheel, pair) for pair in pairs)]:
        foreign.notes.add("wheels in the middle of an axle, which stand for both at its ends, left out", ", ".join(j.name for j in virtual))
        foreign.model = _without(model, virtual)
        return find_wheels(foreign)
    only_steered = all(steering_of(model, wheel) is not None for pair in pairs for wheel in pair)
    if only_steered and (loosened := loosened_wheels(foreign)):
        foreign.notes.add("wheels that are fixed in the file are taken to turn; check what drives it", ", ".join(loosened))
        foreign.model = replace(model, joints=model.joints | loosened)
        return find_wheels(foreign)
    if not pairs:
        found = ", ".join(w.joint.name for w in wheels) or "none"
        fixed = ", ".join(name for name, joint in model.joints.items() if joint not in turning and "wheel" in name.lower())
        held = f"; wheels that are fixed: {fixed}" if fixed else ""
        raise BadInput(
            f"{model.path}: no two wheels of one size on one axis; joints that turn: {found}{held}. "
            "UVF drives two wheels on one axle: make their joints continuous, give both a shape, name them ..._left... and ..._right..."
        )
    if (car := car_of(foreign, pairs)) is not None:
        straight, steered = car
        return with_steering(_oriented([straight], wheels, foreign), steered)
    alone = [wheel.joint.name for wheel in wheels if steering_of(model, wheel) is not None and not any(wheel in pair for pair in pairs)]
    if alone:
        foreign.notes.add(
            "a wheel that is steered alone, as of a tricycle or a forklift, is not simulated: it only slides along", ", ".join(alone)
        )
    middle = np.mean([p.translation for p in model.link_poses().values()], axis=0)
    lowest = min(_bottom(pair) for pair in pairs)
    best = max(pairs, key=lambda pair: _score(pair, foreign, (middle, lowest)))
    return _oriented([best, *_more_pairs(best, pairs, foreign)], wheels, foreign)


def _in_the_middle(wheel: WheelGuess, pair: Pair) -> bool:
    """Whether a wheel stands halfway between two like it."""
    a, b = pair
    apart = float(np.linalg.norm(wheel.centre - (a.centre + b.centre) / 2))
    return apart < MIDDLE * wheel.radius and abs(wheel.radius - a.radius) <= ALIKE * a.radius and wheel.joint not in (a.joint, b.joint)


def _without(model: UrdfModel, joints: Iterable[Joint]) -> UrdfModel:
    """The model without these joints and all that hangs on them."""
    gone = {name for joint in joints for name in model.below(joint.child)}
    kept = {name: joint for name, joint in model.joints.items() if joint.child not in gone}
    return replace(model, links={name: link for name, link in model.links.items() if name not in gone}, joints=kept)


def _omni(ring: tuple[WheelGuess, ...], wheels: list[WheelGuess], foreign: Foreign) -> DriveWheels:
    """base_link lies under the point in which the axes meet, x as in the file."""
    names = ", ".join(wheel.joint.name for wheel in ring)
    foreign.notes.add("omni wheels: rollers across each, so that it drives sideways, too", names)
    middle, radius = meeting_point(ring), float(np.mean([wheel.radius for wheel in ring]))
    root_from_base = Transform(IDENTITY.rotation, middle - (0.0, 0.0, radius))
    diameter = 2 * float(np.mean([np.hypot(*(wheel.centre - middle)[:2]) for wheel in ring]))
    below = {wheel.joint.name for wheel in wheels if any(wheel.joint.child in foreign.model.below(each.joint.child) for each in ring)}
    others = tuple(wheel for wheel in wheels if wheel not in ring and wheel.joint.name not in below)
    return DriveWheels((), (), others, inverse(root_from_base), diameter, "omni", around=ring)


def with_steering(wheels: DriveWheels, steered: Pair) -> DriveWheels:
    """The same as a car's, whose other wheels are steered."""
    left, right = sorted(steered, key=lambda wheel: -float(apply(wheels.base_from_root, wheel.centre[None])[0, 1]))
    others = tuple(wheel for wheel in wheels.others if wheel not in steered)
    return replace(wheels, others=others, kind="ackermann", steered=(left, right))


def _has_rollers(foreign: Foreign, wheels: Iterable[WheelGuess]) -> bool:
    """Whether a drive of four such wheels has rollers: a plugin tells so, or what they, their links or their shapes are called."""
    links = [foreign.model.links[wheel.joint.child] for wheel in wheels]
    meshes = [s.mesh.stem for link in links for s in (*link.visuals, *link.collisions) if s.mesh is not None]
    return foreign.drive.has_rollers or any(MECANUM.search(name) for name in (*meshes, *(link.name for link in links)))


def _is_called_wheel(joint: Joint) -> bool:
    return bool(DRIVEN.search(joint.name))


def _more_pairs(best: Pair, pairs: list[Pair], foreign: Foreign) -> list[Pair]:
    """With skid steer: the other pairs of such wheels that cannot be steered, if they are driven, too.

    Wheels with rollers are not steered, even where their forks have joints (KUKA's youBot).
    """
    told, slide = {*foreign.drive.left, *foreign.drive.right}, _has_rollers(foreign, best)
    found: list[Pair] = []
    for pair in pairs:
        taken = {w.joint.name for p in (best, *found) for w in p}
        called = _called_driven(pair) or not _called_driven(best)
        passive = _is_passive(pair) and not _is_passive(best)
        drives = all(w.joint.name in told for w in pair) if told else called and not passive
        steered = not slide and any(swivels(foreign.model, w.joint) for w in pair)
        if any(w.joint.name in taken for w in pair) or not _alike(best, pair):
            continue
        if drives and not steered:
            found.append(pair)
        elif called and not told:
            names = ", ".join(w.joint.name for w in pair)
            foreign.notes.add(
                "wheels like those that drive, taken for castors; name them in a plugin or controller if they drive, too", names
            )
    return found


def _is_passive(pair: Pair) -> bool:
    return any(PASSIVE.search(name) for name in names_of(pair))


def _called_driven(pair: Pair) -> bool:
    return all(DRIVEN.search(name) for name in names_of(pair))


def _alike(a: Pair, b: Pair) -> bool:
    """Of one size, on parallel axes, as far apart."""
    tracks = [float(np.linalg.norm(first.centre - second.centre)) for first, second in (a, b)]
    return (
        abs(a[0].radius - b[0].radius) <= ALIKE * a[0].radius
        and bool(abs(a[0].axis @ b[0].axis) > PARALLEL)
        and abs(tracks[0] - tracks[1]) <= ALIKE * tracks[0]
    )


def swivels(model: UrdfModel, joint: Joint) -> bool:
    """Whether a wheel hangs in a fork that turns too, or is called a castor. A rocker turns as the wheel does or rolls, a spring slides."""
    if any(word in f"{joint.name} {joint.child}".lower() for word in CASTORS):
        return True
    fork, poses = model.parents.get(joint.parent), model.link_poses()
    if fork is None or fork.kind not in ("revolute", "continuous") or not {fork.child, joint.child} <= poses.keys():
        return False
    axes = [rotate(poses[each.child].rotation, each.axis) for each in (fork, joint)]
    return abs(float(axes[0] @ axes[1])) < ROCKS and abs(float(axes[0][2])) > UPRIGHT


def _opposite(a: WheelGuess, b: WheelGuess) -> bool:
    """On one axis, of one size, apart."""
    apart = a.centre - b.centre
    distance = float(np.linalg.norm(apart))
    if distance < 0.5 * a.radius or abs(a.radius - b.radius) > ALIKE * a.radius or abs(a.axis @ b.axis) < PARALLEL:
        return False
    return bool(abs(apart @ a.axis) / distance > PARALLEL)


def _bottom(pair: Pair) -> float:
    """Height [m] of the lowest point of a pair, where z is up; of one on an upright axis none."""
    return min(float(w.centre[2]) - w.radius if abs(w.axis[2]) < LEVEL else 0.0 for w in pair)


def _score(pair: Pair, foreign: Foreign, about: tuple[Floats, float]) -> tuple[float, ...]:
    """about: the middle of the links (3,) [m], and the height of the lowest pair [m]. Wheels that do not reach the floor drive nothing."""
    middle, lowest = about
    names = names_of(pair)
    told = {*foreign.drive.left, *foreign.drive.right}
    score = 10.0 * all(w.joint.name in told for w in pair)
    score += 2.0 * _called_driven(pair) - 5.0 * any(PASSIVE.search(n) for n in names)
    score += 2.0 * (any(LEFT.search(n) for n in names) and any(RIGHT.search(n) for n in names))
    score -= 3.0 * any(w.joint.mimics is not None for w in pair) + 4.0 * any(swivels(foreign.model, w.joint) for w in pair)
    between = (pair[0].centre + pair[1].centre) / 2
    stands = _bottom(pair) < lowest + OFF_FLOOR * pair[0].radius
    return score, stands, round(pair[0].radius, 3), -round(float(np.linalg.norm(between - middle)), 3)


def _oriented(pairs: list[Pair], wheels: list[WheelGuess], foreign: Foreign) -> DriveWheels:
    a, b = pairs[0]
    lateral = (a.centre - b.centre) / np.linalg.norm(a.centre - b.centre)
    up = up_of(foreign, lateral, a)
    side = lateral if left_is_first(pairs[0], foreign, up) else -lateral
    forward = np.cross(side, up)
    forward /= np.linalg.norm(forward)
    pairs = sorted(pairs, key=lambda pair: -float((pair[0].centre + pair[1].centre) @ forward))
    sides = [sorted(pair, key=lambda wheel: -float(wheel.centre @ side)) for pair in pairs]
    left, right = (tuple(pair[k] for pair in sides) for k in (0, 1))
    driven = left + right
    middle, radius = np.mean([w.centre for w in driven], axis=0), float(np.mean([w.radius for w in driven]))
    axes = np.column_stack((forward, np.cross(up, forward), up))
    kind, turning = _turning(pairs, driven, (middle, axes), foreign)
    root_from_base = Transform(from_matrix(axes), middle + axes @ np.array((*turning.pivot, -radius)))
    if abs(forward[0]) < 0.99 or up[2] < 0.99:
        foreign.notes.add(f"axes turned: forward was {row(forward)} and up {row(up)} in the file's root")
    return DriveWheels(left, right, tuple(w for w in wheels if w not in driven), inverse(root_from_base), turning.track, kind)


def _turning(pairs: list[Pair], driven: tuple[WheelGuess, ...], frame: tuple[Floats, Floats], foreign: Foreign) -> tuple[str, Scrubbing]:
    """The kind of drive, and how it turns; frame: the wheels' middle (3,) [m] and axes (3, 3), columns forward, left, up."""
    middle, axes = frame
    places = np.array([(wheel.centre - middle) @ axes for wheel in driven])[:, :2]
    if len(pairs) == 1:
        return "differential", Scrubbing(float(np.ptp(places[:, 1])), (0.0, 0.0))
    if len(pairs) == 2 and _has_rollers(foreign, driven):
        foreign.notes.add("mecanum wheels: rollers at 45 degrees whose axes form an X from above; it drives sideways, too")
        return "mecanum", Scrubbing(float(np.ptp(places[:, 0]) + np.ptp(places[:, 1])), (0.0, 0.0))
    mass = whole(foreign.model, foreign.model.link_poses())
    loads = shared_loads(places, ((mass.com - middle) @ axes)[:2]) if mass is not None else np.ones(len(places))
    found = scrubbing(places, loads)
    foreign.notes.add(
        f"skid steer: it turns as two wheels do that are {found.track:.3g} m apart, about ({found.pivot[0]:.3f}, {found.pivot[1]:.3f}) m "
        "from the middle of the wheels, where base_link is put"
    )
    return "skid_steer", found
