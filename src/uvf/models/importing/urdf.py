"""URDF and xacro of others: ROS packages, SolidWorks' exporter, Gazebo's tags."""

from pathlib import Path
from typing import Any

from uvf.models.importing.moved_joints import commanded_joints
from uvf.models.importing.notes import Notes
from uvf.models.importing.robot import Foreign, ForeignSensor
from uvf.models.importing.sdf.poses import FILE, transform
from uvf.models.urdf.reader import read_model
from uvf.models.urdf.robot import UrdfModel
from uvf.models.urdf.source import XacroValues, read_xml
from uvf.models.yaml_data import BadInput

GIVEN = {"material", "mu1", "mu2", "mu", "kp", "kd", "selfCollide", "turnGravityOff", "gravity", "minDepth", "maxVel", "static", "fdir1"}


def read_foreign_urdf(path: Path, values: XacroValues) -> Foreign:
    """The robot that a URDF or xacro file describes. Raises BadInput where it is no URDF or xacro cannot expand it."""
    notes = Notes()
    robot = read_xml(path, values, note=notes.add)
    if robot.tag != "robot":
        raise BadInput(f"{path}: the outermost tag is <{robot.tag}>; a URDF begins with <robot>, an SDF ends in .sdf")
    model = read_model(path, robot)
    if not model.links:
        raise BadInput(f"{path}: no links in it; when they are in a macro, import the file that calls it")
    for fault in model.faults:
        if "no mesh file" not in fault.text:
            notes.add(f"faulty in the file: {fault}")
    _tell_structure(path, model, notes)
    found = Foreign(model, notes=notes, commanded=commanded_joints(robot))
    robot.set(FILE, str(path))
    for tag in robot.findall("transmission"):
        notes.add("transmissions dropped, UVF's motor model drives the wheels", tag.get("name", ""))
    for tag in robot.findall("ros2_control"):
        notes.add("ros2_control dropped, UVF's motor model drives the wheels", tag.get("name", ""))
    for tag in robot.findall("gazebo"):
        _take(tag, found)
    return found


def _tell_structure(path: Path, model: UrdfModel, notes: Notes) -> None:
    """What hangs on nothing, or on two things. Raises BadInput where joints form a ring."""
    links, joints = model.links, model.joints.values()
    for joint in joints:
        for end in (joint.parent, joint.child):
            if end not in links:
                notes.add("joints to links that are not there, left out with what hangs on them", f"{joint.name} ({end})")
    parents = [joint.child for joint in joints]
    for name in links:
        if parents.count(name) > 1:
            named = ", ".join(joint.name for joint in joints if joint.child == name)
            notes.add("links that hang in several joints: the last one counts", f"{name} ({named})")
    found = set(model.link_poses())
    ring = [name for name in links if name not in found and name in parents and not _hangs_below(model, name)]
    if ring:
        raise BadInput(f"{path}: joints form a ring about {', '.join(ring[:4])}; cut it where one of them closes it")
    roots = [name for name in model.roots[1:] if links[name].visuals or links[name].collisions or links[name].inertial]
    for name in roots:
        notes.add(f"links that hang in no joint of {model.roots[0]}, left out", name)


def _hangs_below(model: UrdfModel, name: str) -> bool:
    """Whether the way up from a link ends."""
    parents, seen = model.parents, set()
    while name in parents and name not in seen:
        seen.add(name)
        name = parents[name].parent
    return name not in seen


def _take(gazebo: Any, found: Foreign) -> None:
    """Drive and sensors of a <gazebo> tag; the rest is dropped with a note."""
    found.take_plugins(gazebo)
    link = gazebo.get("reference", "")
    for sensor in gazebo.findall("sensor"):
        try:
            found.sensors.append(ForeignSensor(sensor.get("type", ""), link, sensor, transform(sensor.find("pose"))))
        except BadInput as error:
            found.notes.add(f"sensor dropped: {error}")
    for tag in gazebo:
        if isinstance(tag.tag, str) and tag.tag not in ("plugin", "sensor") and tag.tag not in GIVEN:
            found.notes.add("tags of Gazebo dropped", str(tag.tag))
        elif isinstance(tag.tag, str) and tag.tag in ("mu1", "mu2", "mu"):
            found.notes.add("friction of single links not taken over; it stands in vehicle.yaml for the whole vehicle")
