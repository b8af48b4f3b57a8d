"""A ground vehicle's URDF against its vehicle.yaml and against the floor it is to stand on."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from uvf.maths.kinematics import WheelSpeeds
from uvf.maths.rotations import rotate
from uvf.maths.wheels.scrubbing import scrubbing, shared_loads
from uvf.models.checks.sensor_rules import sensor_faults, sensor_notes
from uvf.models.shapes.mesh import placed, reach, triangles
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.inertia import whole
from uvf.models.urdf.robot import Joint, UrdfModel
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


class CheckedBody:
    """A ground vehicle's links and collision shapes, where they are in base_link at rest."""

    def __init__(self, model: UrdfModel, ground: GroundBody) -> None:
        self.model, self.ground = model, ground
        self.poses = model.link_poses()
        self.mass = whole(model, self.poses)
        sides = {"left": ground.drive.left_joints, "right": ground.drive.right_joints}
        found = {side: [model.joints[name] for name in names] for side, names in sides.items()}
        self.wheels = {side: [j for j in joints if j.child in self.poses and j.parent in self.poses] for side, joints in found.items()}
        self.turning = {name for joints in self.wheels.values() for j in joints for name in model.below(j.child)}

    def collisions(self, names: list[str]) -> list[Solid]:
        """The collision shapes of the links of these names, in base_link."""
        links = [self.model.links[n] for n in names if n in self.poses and n in self.model.links]
        return [placed(solid, self.poses[link.name]) for link in links for solid in link.collisions]

    @property
    def rest(self) -> list[str]:
        """The names of the links that are not part of a driven wheel."""
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
            *(line for side, joints in body.wheels.items() for joint in joints for line in _wheel_faults(body, side, joint, ground)),
            *_axle_faults(body, ground),
            *_speed_faults(file.ground, ground),
            *_outline_faults(body, ground),
            *_balance_faults(body),
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


def _wheel_faults(body: CheckedBody, side: str, joint: Joint, ground: FileLocation) -> Iterator[str]:
    drive = body.ground.drive
    where, what = _at(body.model, joint.line), f"{side} wheel '{joint.name}'"
    solids = body.collisions(list(body.model.below(joint.child)))
    if not solids:
        yield f"{_at(body.model, body.model.links[joint.child].line)}: {what} has no <collision>: it touches nothing; give it one"
        return
    low = -max(float(reach(solid, DOWN)[0]) for solid in solids)
    if abs(low) > max(TOUCH, 0.02 * drive.wheel_radius):
        yield f"{where}: {what} does not touch the floor: its lowest point is at z = {low * 1000:.1f} mm; move its joint"
    pose = body.poses[joint.child]
    axis = rotate(pose.rotation, joint.axis)
    if abs(axis[1]) < ALONG:
        yield f"{where}: {what} turns about {_row(axis)} in base_link; a wheel turns about y"
    elif axis[1] < 0:
        yield f'{where}: {what} would turn backwards: its axis points to the right; turn the sign of <axis xyz="...">'
    forward = np.array(((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)))
    radius = max(float(reach(solid, forward).sum()) for solid in solids) / 2
    if abs(radius - drive.wheel_radius) > SAME * drive.wheel_radius:
        yield f"{ground.at('drive', 'wheel_radius')}: {drive.wheel_radius:g} m, but the {what} of the URDF has a radius of {radius:.4g} m"


def _axle_faults(body: CheckedBody, ground: FileLocation) -> Iterator[str]:
    """Wheels on the other side, a wrong track, a base_link that does not lie under the middle of all wheels."""
    centres = {side: [body.poses[joint.child].translation for joint in joints] for side, joints in body.wheels.items()}
    if not all(centres.values()):
        return
    left, right = (np.mean(centres[side], axis=0) for side in ("left", "right"))
    if left[1] <= 0 <= right[1]:
        yield f"{ground.at('drive', 'left')}: left and right are mixed up: the left one is at y = {left[1]:.3f} m; exchange them"
        return
    wrong = [(side, c[1]) for side, sign in (("left", 1), ("right", -1)) for c in centres[side] if sign * c[1] <= 0]
    for side, y in wrong:
        yield f"{ground.at('drive', side)}: the {side} wheel is at y = {y:.3f} m in base_link; left is above zero, right below"
    drive, track = body.ground.drive, float(left[1] - right[1])
    if abs(abs(track) - drive.track) > SAME * drive.track:
        yield f"{ground.at('drive', 'track')}: {drive.track:g} m, but the wheels of the URDF are {abs(track):.4g} m apart"
    if drive.effective_track is None:
        yield from _off_centre(body, (left + right) / 2, "the middle of the axle is")
    else:
        yield from _scrubbing_faults(body, np.array(centres["left"] + centres["right"]), ground)


def _speed_faults(body: GroundBody, ground: FileLocation) -> Iterator[str]:
    """Limits that the motors do not reach, straight on or on the spot."""
    fastest, drive = body.motor.no_load_speed * body.drive.wheel_radius, body.drive.kinematics
    if body.max_linear > fastest:
        yield f"{ground.at('max_linear')}: {body.max_linear:g} m/s, but without load the motors reach {fastest:.3g} m/s"
    if body.max_angular > (turning := drive.twist(WheelSpeeds(-body.motor.no_load_speed, body.motor.no_load_speed)).angular):
        yield f"{ground.at('max_angular')}: {body.max_angular:g} rad/s, but without load the motors reach {turning:.3g} rad/s"


def _off_centre(body: CheckedBody, place: Floats, what: str) -> Iterator[str]:
    if np.hypot(place[0], place[1]) > OFF_CENTRE:
        line = body.wheels["left"][0].line
        yield f"{_at(body.model, line)}: {what} at x = {place[0]:.3f}, y = {place[1]:.3f} m; base_link must lie under it"


def _scrubbing_faults(body: CheckedBody, centres: Floats, ground: FileLocation) -> Iterator[str]:
    """How wheels that scrub make the vehicle turn, by where they stand and what they carry."""
    if body.mass is None:
        return
    found = scrubbing(centres[:, :2], shared_loads(centres[:, :2], body.mass.com[:2]))
    yield from _off_centre(body, np.array(found.pivot), "with these masses and wheels it turns about a point")
    told = body.ground.drive.effective_track
    if told is not None and abs(told - found.track) > SAME * found.track:
        yield f"{ground.at('drive', 'effective_track')}: {told:g} m, but with these masses and wheels it is {found.track:.4g} m"


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
    if margin is not None and 0 <= margin < LOW_MARGIN * body.ground.drive.track:
        yield f"the centre of mass is only {margin * 1000:.0f} mm inside of the supports: it may tip when it accelerates"


def _castor_notes(body: CheckedBody) -> Iterator[str]:
    low = [s for s in body.collisions(body.rest) if -float(reach(s, DOWN)[0]) < LEVEL]
    along = [float(corners[np.argmin(corners[:, 2]), 0]) for corners in (triangles(s)[0] for s in low)]
    if along and min(along) < -LEVEL and max(along) > LEVEL:
        yield "castors before and behind the axle, as low as the wheels, take their weight off them: they slip; lift the castors by 0.5 mm"


def _supports(body: CheckedBody) -> list[Floats]:
    """(2,) m: the wheels, wherever they are, and what else touches the floor; of a shape's underside its corners."""
    points: list[Floats] = [body.poses[joint.child].translation[:2] for joints in body.wheels.values() for joint in joints]
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
