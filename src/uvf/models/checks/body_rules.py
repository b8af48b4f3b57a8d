"""A ground vehicle's URDF against its vehicle.yaml and against the floor it is to stand on."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from uvf.maths.kinematics import Twist
from uvf.maths.rotations import rotate
from uvf.maths.wheels.scrubbing import scrubbing, shared_loads
from uvf.maths.wheels.steered import wheel_steering
from uvf.models.checks.sensor_rules import sensor_faults, sensor_notes
from uvf.models.checks.size_rules import size_faults
from uvf.models.shapes.mesh import placed, reach, triangles
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.inertia import whole
from uvf.models.urdf.robot import Joint, UrdfModel
from uvf.models.urdf.rules import LIGHTEST_WHEEL
from uvf.models.vehicle.drive import AckermannFile, MecanumFile, OmniFile, OneAxle, SkidSteerFile
from uvf.models.vehicle.file import GroundBody, VehicleFile
from uvf.models.yaml_data import BadInput, FileLocation

Floats = NDArray[np.float64]

TOUCH = 0.003  # m: what is no higher touches the floor when the wheels have sunk into their contacts
SINK = 0.003  # m below the floor at the start, which physics pushes out gently
LEVEL = 1e-4  # m
SAME = 0.03  # share by which wheel radius and track may be off
OFF_CENTRE = 0.005  # m, axle's middle from base_link
ALONG = np.cos(np.radians(5.0))
LOW_MARGIN = 0.1  # of the track, from the centre of mass to the edge of the supports
DOWN = np.array(((0.0, 0.0, -1.0),))
ROUND = np.column_stack(
    (np.cos(np.linspace(0, 2 * np.pi, 180, endpoint=False)), np.sin(np.linspace(0, 2 * np.pi, 180, endpoint=False)), np.zeros(180))
)


class CheckedWheel(NamedTuple):
    """A wheel: its joint, what to call it, and the direction in which it rolls [rad]."""

    joint: Joint
    side: str
    rolls_to: float


class CheckedBody:
    """A ground vehicle's links and collision shapes, where they are in base_link at rest."""

    def __init__(self, model: UrdfModel, ground: GroundBody) -> None:
        self.model, self.ground = model, ground
        self.poses = model.link_poses()
        self.mass = whole(model, self.poses)
        drive = ground.drive
        self.wheels = [
            CheckedWheel(joint, "left" if on_left else "right", rolls_to)
            for name, on_left, rolls_to in zip(drive.joints, drive.on_left, drive.rolls_to, strict=True)
            if (joint := model.joints[name]).child in self.poses and joint.parent in self.poses
        ]
        self.steered = [
            CheckedWheel(wheel, "steered", 0.0)
            for name in drive.steered_wheels.values()
            if (wheel := model.joints[name]).child in self.poses
        ]
        self.turning = {name for wheel in (*self.wheels, *self.steered) for name in model.below(wheel.joint.child)}

    def collisions(self, names: list[str]) -> list[Solid]:
        """The collision shapes of the links of these names, in base_link."""
        links = [self.model.links[n] for n in names if n in self.poses and n in self.model.links]
        return [placed(solid, self.poses[link.name]) for link in links for solid in link.collisions]

    @property
    def rest(self) -> list[str]:
        """The names of the links that are not part of a driven or steered wheel."""
        return [name for name in self.poses if name not in self.turning]


def body_faults(model: UrdfModel, file: VehicleFile, yaml: Path) -> list[str]:
    """Faults of a ground vehicle's wheels, outline, balance and sensors, a line each.

    None while a mesh cannot be read, for that is told already.
    """
    assert file.ground is not None
    body, ground = CheckedBody(model, file.ground), FileLocation(str(yaml), ("ground",))
    try:
        return [
            *_base_faults(body),
            *(line for wheel in (*body.wheels, *body.steered) for line in _wheel_faults(body, wheel, ground)),
            *(_omni_faults(body, file.ground.drive, ground) if isinstance(file.ground.drive, OmniFile) else _axle_faults(body, ground)),
            *(_steering_faults(body, file.ground.drive, ground) if isinstance(file.ground.drive, AckermannFile) else ()),
            *_speed_faults(file.ground, ground),
            *_outline_faults(body, ground),
            *_balance_faults(body),
            *size_faults(model, body.poses),
            *sensor_faults(model, file.sensors, body.poses, FileLocation(str(yaml), ("sensors",))),
        ]
    except BadInput as error:
        return [] if any("mesh" in fault.text for fault in model.faults) else [str(error)]


def body_notes(model: UrdfModel, file: VehicleFile) -> list[str]:
    """Remarks on what looks odd but may be meant so, a line each."""
    assert file.ground is not None
    body = CheckedBody(model, file.ground)
    try:
        return [*_margin_notes(body), *_castor_notes(body), *sensor_notes(model, file.sensors, body.poses, body.turning)]
    except BadInput:
        return []


def _at(model: UrdfModel, line: int) -> str:
    return f"{model.path}:{line}" if line else str(model.path)


def _base_faults(body: CheckedBody) -> Iterator[str]:
    base = body.poses.get("base_link")
    if base is not None and (np.linalg.norm(base.translation) > 1e-6 or abs(base.rotation[0]) < 1 - 1e-9):
        line = body.model.links["base_link"].line
        yield f"{_at(body.model, line)}: base_link is not at the root: it lies on the floor under the axle; use 'uvf vehicle import'"
    if not body.collisions(body.rest):
        root = body.model.links[body.model.roots[0]]
        yield f"{_at(body.model, root.line)}: the body has no <collision>: it would drive through everything; give link '{root.name}' one"
    for solid in body.collisions(body.rest):
        if (low := -float(reach(solid, DOWN)[0])) < -SINK:
            line = body.model.links[solid.name].line
            yield f"{_at(body.model, line)}: link '{solid.name}' reaches {-low * 1000:.0f} mm below the floor; lift its collision"


def _wheel_faults(body: CheckedBody, wheel: CheckedWheel, ground: FileLocation) -> Iterator[str]:
    drive, (joint, side, rolls_to) = body.ground.drive, wheel
    where, what = _at(body.model, joint.line), f"{side} wheel '{joint.name}'"
    solids = body.collisions(list(body.model.below(joint.child)))
    if not solids:
        yield f"{_at(body.model, body.model.links[joint.child].line)}: {what} has no <collision>: it touches nothing; give it one"
        return
    low = -max(float(reach(solid, DOWN)[0]) for solid in solids)
    if abs(low) > max(TOUCH, 0.02 * drive.wheel_radius):
        yield f"{where}: {what} does not touch the floor: its lowest point is at z = {low * 1000:.1f} mm; move its joint"
    pose = body.poses[joint.child]
    axis, forward = rotate(pose.rotation, joint.axis), np.array((np.cos(rolls_to), np.sin(rolls_to), 0.0))
    turned = f", turned by {rolls_to:.3g}" if rolls_to else ""
    leftward = float(axis @ (-forward[1], forward[0], 0.0))
    if abs(leftward) < ALONG:
        yield f"{where}: {what} turns about {_row(axis)} in base_link; a wheel turns about y{turned}"
    elif leftward < 0:
        yield f'{where}: {what} would turn backwards: its axis points to the right; turn the sign of <axis xyz="...">'
    forward = np.array((forward, -forward))
    radius = max(float(reach(solid, forward).sum()) for solid in solids) / 2
    told = [inertial.mass for name in body.model.below(joint.child) if (inertial := body.model.links[name].inertial) is not None]
    if told and body.mass is not None and sum(told) < LIGHTEST_WHEEL * body.mass.mass:
        weighs = f"weighs {1000 * sum(told):.3g} g, the vehicle {body.mass.mass:.3g} kg"
        yield f"{where}: {what} {weighs}: so light a wheel slips and hops; give its link a wheel's mass and inertia"
    if abs(radius - drive.wheel_radius) > SAME * drive.wheel_radius:
        yield f"{ground.at('drive', 'wheel_radius')}: {drive.wheel_radius:g} m, but the {what} of the URDF has a radius of {radius:.4g} m"


def _axle_faults(body: CheckedBody, ground: FileLocation) -> Iterator[str]:
    """Wheels on the other side, a wrong track, a base_link that does not lie under the middle of all wheels."""
    drive = body.ground.drive
    assert isinstance(drive, OneAxle | SkidSteerFile | MecanumFile)
    centres = {side: [body.poses[w.joint.child].translation for w in body.wheels if w.side == side] for side in ("left", "right")}
    if not all(centres.values()):
        return
    left, right = (np.mean(centres[side], axis=0) for side in ("left", "right"))
    if left[1] <= 0 <= right[1]:
        yield f"{ground.at('drive', 'left')}: left and right are mixed up: the left one is at y = {left[1]:.3f} m; exchange them"
        return
    wrong = [(side, c[1]) for side, sign in (("left", 1), ("right", -1)) for c in centres[side] if sign * c[1] <= 0]
    for side, y in wrong:
        yield f"{ground.at('drive', side)}: the {side} wheel is at y = {y:.3f} m in base_link; left is above zero, right below"
    track = float(left[1] - right[1])
    if abs(abs(track) - drive.track) > SAME * drive.track:
        yield f"{ground.at('drive', 'track')}: {drive.track:g} m, but the wheels of the URDF are {abs(track):.4g} m apart"
    if isinstance(drive, SkidSteerFile):
        yield from _scrubbing_faults(body, np.array(centres["left"] + centres["right"]))
    else:
        yield from _off_centre(body, (left + right) / 2, f"the middle of the {'axle' if isinstance(drive, OneAxle) else 'wheels'} is")
    if isinstance(drive, MecanumFile):
        yield from _wheelbase_faults(drive, centres, ground)


def _wheelbase_faults(drive: MecanumFile, centres: dict[str, list[Floats]], ground: FileLocation) -> Iterator[str]:
    for side, (front, rear) in centres.items():
        between = float(front[0] - rear[0])
        if between <= 0.0:
            yield f"{ground.at('drive', side)}: the first wheel is at x = {front[0]:.3f} m, behind the second; name the front wheel first"
        elif abs(between - drive.wheelbase) > SAME * drive.wheelbase:
            yield f"{ground.at('drive', 'wheelbase')}: {drive.wheelbase:g} m, but the {side} wheels are {between:.4g} m apart in the URDF"


def _steering_faults(body: CheckedBody, drive: AckermannFile, ground: FileLocation) -> Iterator[str]:
    """Steered wheels that do not hang in their steering, stand elsewhere, or whose steering is not upright or ends too soon."""
    for (name, wheel), checked in zip(drive.steered.items(), body.steered, strict=True):
        joint = body.model.joints[name]
        if checked.joint.child not in body.model.below(joint.child):
            yield f"{ground.at('drive', 'steered', name)}: the wheel '{wheel}' does not hang in it, so it would not be steered"
            continue
        where, axis = _at(body.model, joint.line), rotate(body.poses[joint.child].rotation, joint.axis)
        if abs(axis[2]) < ALONG:
            yield f"{where}: '{name}' turns about {_row(axis)} in base_link; a steering turns about z"
        x, y, _ = body.poses[checked.joint.child].translation.tolist()
        if abs(abs(x) - drive.wheelbase) > SAME * drive.wheelbase:
            there = f"the wheel '{wheel}' of the URDF is {abs(x):.4g} m from the axle"
            yield f"{ground.at('drive', 'wheelbase')}: {drive.wheelbase:g} m, but {there}"
        tightest = drive.kinematics.curvature(drive.max_steering)
        most, limits = max(abs(wheel_steering(way * tightest, x, y)) for way in (1.0, -1.0)), joint.limits
        if limits is not None and most > min(-limits[0], limits[1]) + LEVEL:
            at = ground.at("drive", "max_steering")
            yield f"{at}: {drive.max_steering:g} rad turns '{name}' by {most:.4g}, but its limits are {limits[0]:g} and {limits[1]:g} rad"


def _omni_faults(body: CheckedBody, drive: OmniFile, ground: FileLocation) -> Iterator[str]:
    """Wheels that stand elsewhere in the URDF."""
    for wheel in body.wheels:
        told, there = drive.wheels[wheel.joint.name], body.poses[wheel.joint.child].translation
        if np.hypot(told.x - there[0], told.y - there[1]) > max(OFF_CENTRE, SAME * float(np.hypot(told.x, told.y))):
            place = ground.at("drive", "wheels", wheel.joint.name)
            yield f"{place}: at ({told.x:.3f}, {told.y:.3f}) m, but in the URDF it stands at ({there[0]:.3f}, {there[1]:.3f}) m"


def _speed_faults(body: GroundBody, ground: FileLocation) -> Iterator[str]:
    """Limits that the motors do not reach, straight on or on the spot."""
    drive, top = body.drive.kinematics, body.motor.no_load_speed
    ahead = [Twist(1.0, 0.0), *([Twist(0.0, 0.0, 1.0)] if drive.goes_sideways else [])]
    fastest, turning = (
        top / max(abs(w) for twist in twists for w in drive.wheels(twist)) for twists in (ahead, [Twist(drive.turning_radius, 1.0)])
    )
    if body.max_linear > fastest:
        yield f"{ground.at('max_linear')}: {body.max_linear:g} m/s, but without load the motors reach {fastest:.3g} m/s"
    if body.max_angular > turning:
        yield f"{ground.at('max_angular')}: {body.max_angular:g} rad/s, but without load the motors reach {turning:.3g} rad/s"


def _off_centre(body: CheckedBody, place: Floats, what: str) -> Iterator[str]:
    if np.hypot(place[0], place[1]) > OFF_CENTRE:
        line = body.wheels[0].joint.line
        yield f"{_at(body.model, line)}: {what} at x = {place[0]:.3f}, y = {place[1]:.3f} m; base_link must lie under it"


def _scrubbing_faults(body: CheckedBody, centres: Floats) -> Iterator[str]:
    """The point about which wheels that scrub make the vehicle turn, by where they stand and what they carry."""
    if body.mass is None:
        return
    found = scrubbing(centres[:, :2], shared_loads(centres[:, :2], body.mass.com[:2]))
    yield from _off_centre(body, np.array(found.pivot), "with these masses and wheels it turns about a point")


def _outline_faults(body: CheckedBody, ground: FileLocation) -> Iterator[str]:
    """The circle that planning and collision checks take for the vehicle holds all of it."""
    solids = body.collisions([*body.rest, *body.turning])
    if solids:
        farthest = max(float(reach(solid, ROUND).max()) for solid in solids)
        if farthest > body.ground.radius + 1e-3:
            yield f"{ground.at('radius')}: {body.ground.radius:g} m, but the body reaches {farthest:.3f} m from base_link; enlarge it"


def _balance_faults(body: CheckedBody) -> Iterator[str]:
    supports = _supports(body)
    if body.mass is None or not supports:
        return
    com = body.mass.com
    margin = _margin(supports, com[:2])
    where = str(body.model.path)
    if margin is None:
        yield f"{where}: the vehicle stands on a line, its wheels alone; give it a castor that touches the floor (z = 0)"
    elif margin < 0:
        yield (
            f"{where}: unbalanced: the centre of mass is at x = {com[0]:.3f}, y = {com[1]:.3f} m, {-margin * 1000:.0f} mm outside "
            "of what it stands on; move the castor or the masses"
        )


def _margin_notes(body: CheckedBody) -> Iterator[str]:
    supports = _supports(body)
    margin = _margin(supports, body.mass.com[:2]) if supports and body.mass is not None else None
    if margin is not None and 0 <= margin < LOW_MARGIN * body.ground.drive.width:
        yield f"the centre of mass is only {margin * 1000:.0f} mm inside of the supports: it may tip when it accelerates"


def _castor_notes(body: CheckedBody) -> Iterator[str]:
    low = [s for s in body.collisions(body.rest) if -float(reach(s, DOWN)[0]) < LEVEL]
    along = [float(corners[np.argmin(corners[:, 2]), 0]) for corners in (triangles(s)[0] for s in low)]
    if along and min(along) < -LEVEL and max(along) > LEVEL:
        yield "castors before and behind the axle, as low as the wheels, take their weight off them: they slip; lift the castors by 0.5 mm"


def _supports(body: CheckedBody) -> list[Floats]:
    """(2,) m: the wheels, wherever they are, and what else touches the floor; of a shape's underside its corners."""
    points: list[Floats] = [body.poses[wheel.joint.child].translation[:2] for wheel in (*body.wheels, *body.steered)]
    for solid in body.collisions(body.rest):
        low = -float(reach(solid, DOWN)[0])
        if low <= TOUCH:
            corners = triangles(solid)[0]
            points += list(corners[corners[:, 2] <= corners[:, 2].min() + 1e-4][:, :2])
    return points


def _margin(points: list[Floats], com: Floats) -> float | None:
    """Distance [m] of the point from the edge of the points' hull, below zero outside; None where they lie on a line."""
    try:
        hull = ConvexHull(np.array(points))
    except (QhullError, ValueError):
        return None
    if hull.volume < 1e-6:  # m^2
        return None
    return float(-(hull.equations[:, :2] @ com + hull.equations[:, 2]).max())


def _row(values: Floats) -> str:
    return "(" + ", ".join(f"{v + 0.0:.2f}" for v in values) + ")"
