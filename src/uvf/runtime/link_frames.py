"""The links of a URDF as frames: where they sit on the vehicle, and how its joints turn them.

REP-105 wants ``base_footprint`` on the floor and level, REP-103 axes; the file's own root hangs below it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from schemas.convert import quaternion, seconds, stamp, vector
from schemas.messages import FrameTransform, FrameTransforms, JointStates
from uvf.maths.rotations import IDENTITY, from_axis, from_euler, multiply
from uvf.runtime.sensor_frames import sensor_frames
from uvf.runtime.vehicle_file import Sensors

Floats = NDArray[np.float64]

FOOTPRINT, BASE = "base_footprint", "base_link"


@dataclass(frozen=True)
class Joint:
    """parent_from_child at rest: xyz (3,) m, rotation (4,) wxyz; axis (3,) unit, in the child's frame."""

    name: str
    parent: str
    child: str
    xyz: Floats
    rotation: Floats
    axis: Floats

    def at(self, vehicle: str, t: float, angle: float = 0.0) -> FrameTransform:
        return FrameTransform(
            timestamp=stamp(t),
            parent_frame_id=f"{vehicle}/{self.parent}",
            child_frame_id=f"{vehicle}/{self.child}",
            translation=vector(self.xyz),
            rotation=quaternion(multiply(self.rotation, from_axis(self.axis, angle))),
        )


class Links:
    """All links below ``base_footprint``; joints that nobody reads stand at zero."""

    def __init__(self, urdf: Path, turning: Sequence[str]) -> None:
        """urdf: one that ``check_urdf`` lets pass; turning: the joints whose angles are measured."""
        joints = [*_joints(ElementTree.parse(urdf).getroot())]
        self._turning = {j.name: j for j in joints if j.name in turning}
        self._resting = [j for j in joints if j.name not in turning]

    def resting(self, vehicle: str, sensors: Sensors, t: float) -> FrameTransforms:
        """Those that do not move, and the sensors; where a link has a sensor's name, the sensor's mount holds."""
        mounted = sensor_frames(vehicle, sensors, t).transforms
        names = {frame.child_frame_id for frame in mounted}
        links = [frame for joint in self._resting if (frame := joint.at(vehicle, t)).child_frame_id not in names]
        return FrameTransforms(transforms=[*links, *mounted])

    def turned(self, vehicle: str, states: JointStates) -> FrameTransforms:
        """Those that do, at the angles measured, stamped like these."""
        t = seconds(states.timestamp)
        read = [(self._turning[s.name], s.position) for s in states.joints if s.name in self._turning]
        return FrameTransforms(transforms=[joint.at(vehicle, t, angle) for joint, angle in read])


def _joints(robot: ElementTree.Element) -> Iterator[Joint]:
    """The file's joints, and before them what ties its root to ``base_footprint``, at the same place."""
    joints = [_joint(tag) for tag in robot.findall("joint")]
    links = [tag.attrib["name"] for tag in robot.findall("link")]
    root = next(link for link in links if link not in {j.child for j in joints})
    chain = dict.fromkeys((FOOTPRINT, *(() if BASE in links else (BASE,)), root))
    for above, below in pairwise(chain):
        yield Joint("", above, below, np.zeros(3), IDENTITY, np.array((1.0, 0.0, 0.0)))
    yield from joints


def _joint(tag: ElementTree.Element) -> Joint:
    origin, axis = tag.find("origin"), _numbers(tag.find("axis"), "xyz", (1.0, 0.0, 0.0))
    return Joint(
        name=tag.attrib["name"],
        parent=_link(tag, "parent"),
        child=_link(tag, "child"),
        xyz=_numbers(origin, "xyz", (0.0, 0.0, 0.0)),
        rotation=from_euler(*_numbers(origin, "rpy", (0.0, 0.0, 0.0))),
        axis=axis / np.linalg.norm(axis),
    )


def _link(tag: ElementTree.Element, end: str) -> str:
    found = tag.find(end)
    return found.attrib["link"] if found is not None else ""


def _numbers(tag: ElementTree.Element | None, attribute: str, default: tuple[float, float, float]) -> Floats:
    text = tag.get(attribute) if tag is not None else None
    return np.array([float(part) for part in text.split()] if text is not None else default)
