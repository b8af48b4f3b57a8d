"""``uvf vehicle import``: a vehicle's folder from a URDF, xacro, SDF or JSBSim model of others, with notes."""

import shutil
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from math import floor, tan
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from launch.vehicles.creation import check_new
from launch.vehicles.importing_air import import_aircraft
from launch.vehicles.trial_drive import turned_share
from uvf.maths.geodesy import GRAVITY
from uvf.maths.se3 import apply, compose
from uvf.models.importing.driving.controllers import drive_of_controllers, with_controllers
from uvf.models.importing.driving.drive_wheels import DriveWheels, find_wheels
from uvf.models.importing.driving.omni_wheels import heading_of
from uvf.models.importing.driving.steered_wheels import middle_steering
from uvf.models.importing.driving.wheel_guess import WheelGuess
from uvf.models.importing.jsbsim import jsbsim_model
from uvf.models.importing.meshes import with_own_meshes
from uvf.models.importing.rebuilt import rebuilt, wheel_names
from uvf.models.importing.robot import Foreign, StatedLimits
from uvf.models.importing.sdf.robot import read_foreign_sdf
from uvf.models.importing.sensors import sensors_section
from uvf.models.importing.urdf import read_foreign_urdf
from uvf.models.shapes.mesh import placed, reach
from uvf.models.urdf.robot import UrdfModel
from uvf.models.urdf.source import NO_VALUES, XacroValues
from uvf.models.urdf.writer import urdf_text
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput

NOTES = "import.txt"
KINDS = (".urdf", ".xacro", ".sdf", ".world", ".xml")
SPEED, ACCELERATION = 0.5, 0.5  # m/s and m/s^2, where nothing is stated
TRACTION = 2.5  # m/s^2
CALIBRATED = 0.015  # of a turn, from which on the effective track is measured
STEERING_RATE = 2.0  # rad/s
CAR_HZ = 400.0  # Hz of physics: with 200 the light wheels of cars hop when they brake in a curve
MARGIN = 3.0  # of a motor's speed without load over the largest that is asked for
ROUND = np.column_stack([f(np.linspace(0, 2 * np.pi, 180, endpoint=False)) for f in (np.cos, np.sin, np.zeros_like)])


def import_vehicle(source: Path, folder: Path, values: XacroValues = NO_VALUES, joints: Sequence[str] = ()) -> list[str]:
    """Imports a third-party model into ``folder``; returns the notes, also written to its import.txt. Raises BadInput.

    joints: to be moved on command, beside those of which the files say so.
    """
    check_new(folder)
    if (aircraft := jsbsim_model(source)) is not None:
        return import_aircraft(aircraft, folder)
    with tempfile.TemporaryDirectory() as scratch:
        made = Path(scratch) / folder.name
        made.mkdir()
        foreign = _read(source, values)
        foreign.command(joints)
        foreign.drive = with_controllers(foreign.drive, drive_of_controllers(source, list(foreign.model.joints)))
        foreign.model = with_own_meshes(foreign, made)
        wheels = find_wheels(foreign)
        model = replace(rebuilt(foreign, wheels), name=folder.name)
        notes = _write(made, source, foreign, (wheels, model))
        if wheels.kind == "skid_steer":
            notes += _calibrated(made)
        folder.parent.mkdir(parents=True, exist_ok=True)
        shutil.copytree(made, folder)
    return notes


def _calibrated(folder: Path) -> list[str]:
    """Measures the effective track of skid steer by turning it in the simulator, where what bears the wheels tells it too roughly."""
    path = folder / "vehicle.yaml"
    try:
        body = load_vehicle(folder.parent, folder.name).ground
    except BadInput:
        return []  # the check tells
    share = turned_share(folder, body) if body is not None else 1.0
    if not CALIBRATED < abs(share - 1.0) < 0.9:
        return []
    data = yaml.safe_load(path.read_text(encoding="utf-8"))
    before = data["ground"]["drive"]["effective_track"]
    data["ground"]["drive"]["effective_track"] = round(before / share, 4)
    path.write_text(yaml.safe_dump(data, sort_keys=False, width=140), encoding="utf-8")
    line = f"effective track measured by turning it in the simulator: {before / share:.3g} m instead of {before:.3g} m"
    with (folder / NOTES).open("a", encoding="utf-8") as notes:
        notes.write(f"- {line}\n")
    return [line]


def _read(source: Path, values: XacroValues) -> Foreign:
    if not source.is_file():
        raise BadInput(f"{source}: no such file; give a .urdf, .xacro or .sdf, or the .xml of a JSBSim aircraft")
    if source.suffix.lower() not in KINDS and not source.read_bytes()[:200].lstrip().startswith(b"<"):
        raise BadInput(f"{source}: files of this kind are not taken over; give a .urdf, .xacro or .sdf, or the .xml of a JSBSim aircraft")
    return read_foreign_sdf(source) if _is_sdf(source) else read_foreign_urdf(source, values)


def _is_sdf(source: Path) -> bool:
    if source.suffix in (".sdf", ".world"):
        return True
    return "<sdf" in source.read_text(encoding="utf-8", errors="replace")[:2000]


def _write(folder: Path, source: Path, foreign: Foreign, made: tuple[DriveWheels, UrdfModel]) -> list[str]:
    wheels, model = made
    sides = _named(wheels.around) if wheels.around else f"{_named(wheels.left)} (left) and {_named(wheels.right)} (right)"
    foreign.notes.add(f"guessed: {sides} drive; wheel radius {wheels.radius:.4g} m, track {wheels.track:.4g} m")
    _compare(foreign, wheels)
    base_from_link = {name: compose(wheels.base_from_root, pose) for name, pose in foreign.model.link_poses().items()}
    data = {
        "about": f"{foreign.model.name}, imported from {source.name}.",
        "kind": "ground",
        "ground": _ground(folder.name, wheels, model, _limits(foreign)) | _moved(foreign, model),
        "sensors": sensors_section(foreign, base_from_link, model.carried_by(foreign.commanded)),
    }
    foreign.notes.add(f"guessed: motors{' and the rate of the steering' if wheels.steered else ''}; set them in vehicle.yaml")
    used = {s.mesh.stem for link in model.links.values() for s in (*link.visuals, *link.collisions) if s.mesh is not None}
    for file in (folder / "meshes").glob("*"):
        if file.stem not in used:
            file.unlink()
    comment = f"Imported from {source.name}; {NOTES} says what was changed. base_link lies on the floor under the axle."
    text = urdf_text(model, lambda mesh: str(mesh.relative_to(folder)), comment.replace("--", "-"))
    (folder / f"{folder.name}.urdf").write_text(text, encoding="utf-8")
    (folder / "vehicle.yaml").write_text(yaml.safe_dump(data, sort_keys=False, width=140), encoding="utf-8")
    lines = foreign.notes.lines()
    (folder / NOTES).write_text("\n".join([f"Imported from {source.name}:", *(f"- {line}" for line in lines)]) + "\n", encoding="utf-8")
    return lines


def _named(wheels: Sequence[WheelGuess]) -> str:
    return ", ".join(wheel.joint.name for wheel in wheels)


def _compare(foreign: Foreign, wheels: DriveWheels) -> None:
    """The shapes count; a plugin that says otherwise is told of."""
    for name, told, found in (("track", foreign.drive.track, wheels.track), ("wheel radius", foreign.drive.wheel_radius, wheels.radius)):
        if told is not None and abs(told - found) > 0.03 * found:
            foreign.notes.add(f"the plugin's {name} of {told:g} m is not that of the shapes, which counts: {found:.4g} m")


def _limits(foreign: Foreign) -> StatedLimits:
    """What plugin and controllers state; what neither says stays None."""
    stated = foreign.drive.limits
    if stated.source:
        foreign.notes.add("limits of speed and acceleration taken from", stated.source)
    if stated.missing:
        foreign.notes.add("guessed, for no file states it; set it in vehicle.yaml", ", ".join(stated.missing))
    if stated.linear_acceleration is not None and stated.linear_acceleration > TRACTION:
        foreign.notes.add(f"an acceleration lowered to {TRACTION:g} m/s^2: wheels hold no more", f"{stated.linear_acceleration:g} m/s^2")
        return replace(stated, linear_acceleration=TRACTION)
    return stated


def _ground(name: str, wheels: DriveWheels, model: UrdfModel, limits: StatedLimits) -> dict[str, Any]:
    poses = model.link_poses()
    solids = [placed(s, poses[n]) for n, link in model.links.items() for s in link.collisions]
    outline = max(float(reach(s, ROUND).max()) for s in solids)
    fastest = limits.linear or SPEED
    acceleration = limits.linear_acceleration or ACCELERATION
    spin = min(4.0, 4 * acceleration / wheels.turning_track)
    mass = sum(link.inertial.mass for link in model.links.values() if link.inertial is not None)
    turning = limits.angular or float(f"{min(2.0, 2 * fastest / wheels.turning_track):.3g}")
    if wheels.steered is not None:
        turning = float(f"{fastest * tan(_max_steering(wheels, model)) / wheels.wheelbase:.3g}")
    return {
        "urdf": f"{name}.urdf",
        "drive": _drive(wheels, model),
        "radius": round(outline + 0.002, 4),
        "max_linear": fastest,
        "max_angular": turning,
        "max_linear_acceleration": acceleration,
        "max_angular_acceleration": float(f"{min(limits.angular_acceleration or spin, 2 * TRACTION / wheels.turning_track):.3g}"),
        "motor": {
            "stall_torque": float(f"{0.4 * mass * GRAVITY * wheels.radius:.3g}"),
            "no_load_speed": float(f"{MARGIN * _fastest_wheel(fastest, limits, wheels) / wheels.radius:.3g}"),
            "lag": 0.03,
        },
        **({"physics_hz": CAR_HZ} if wheels.steered is not None else {}),
    }


def _moved(foreign: Foreign, model: UrdfModel) -> dict[str, Any]:
    """The key of the joints that are moved on command, if there are any."""
    names = [name for name, joint in model.joints.items() if name in foreign.commanded and joint.kind != "fixed"]
    return {"joints": names} if names else {}


def _max_steering(wheels: DriveWheels, model: UrdfModel) -> float:
    """Largest steering of a car [rad], of a wheel in the middle between the steered ones."""
    limits = model.joints["steering_left_joint"].limits
    assert limits is not None
    return middle_steering(limits[1], wheels.wheelbase, wheels.steered_track)


def _drive(wheels: DriveWheels, model: UrdfModel) -> dict[str, Any]:
    if wheels.kind == "omni":
        return {"kind": "omni", "wheel_radius": round(wheels.radius, 6), "wheels": _ring(wheels)}
    joints = {side: [f"{name}_joint" for name in wheel_names(side, len(wheels.left))] for side in ("left", "right")}
    sizes = {"wheel_radius": round(wheels.radius, 6), "track": round(wheels.track, 6)}
    if wheels.kind == "differential":
        return {side: names[0] for side, names in joints.items()} | sizes
    if wheels.kind == "ackermann":
        steered = {f"steering_{side}_joint": f"steered_{side}_joint" for side in ("left", "right")}
        return {
            "kind": "ackermann",
            **{side: names[0] for side, names in joints.items()},
            **sizes,
            "wheelbase": round(wheels.wheelbase, 6),
            "steered": steered,
            "max_steering": floor(100 * _max_steering(wheels, model)) / 100,
            "steering_rate": STEERING_RATE,
        }
    if wheels.kind == "mecanum":
        return {"kind": "mecanum", **joints, **sizes, "wheelbase": round(wheels.wheelbase, 6)}
    return {"kind": "skid_steer", **joints, **sizes, "effective_track": round(wheels.turning_track, 4)}


def _ring(wheels: DriveWheels) -> dict[str, dict[str, float]]:
    """Where each omni wheel stands and rolls to, by its joint."""
    found = {}
    for name, wheel in zip(wheel_names("omni", len(wheels.around)), wheels.around, strict=True):
        x, y, _ = apply(wheels.base_from_root, wheel.centre[None])[0].tolist()
        found[f"{name}_joint"] = {"x": round(x, 5), "y": round(y, 5), "heading": round(heading_of(wheel.axis), 5)}
    return found


def _fastest_wheel(fastest: float, limits: StatedLimits, wheels: DriveWheels) -> float:
    """m/s of a wheel's tread, straight on or turning on the spot."""
    return max(fastest, (limits.angular or 0.0) * wheels.turning_track / 2)
