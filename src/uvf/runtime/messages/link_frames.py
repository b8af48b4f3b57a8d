"""The links of a URDF as frames: where they sit on the vehicle, and how its joints turn them.

REP-105 wants ``base_footprint`` on the floor, REP-103 axes; the file's own root hangs below it.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path

from schemas.messages import FrameTransform, FrameTransforms, JointStates
from uvf.maths.se3 import inverse
from uvf.models.urdf.model import read_urdf
from uvf.models.urdf.robot import Joint, UrdfModel
from uvf.models.vehicle.sensors import Sensors
from uvf.runtime.messages.convert import quaternion, seconds, stamp, vector
from uvf.runtime.messages.sensor_frames import sensor_frames

FOOTPRINT, BASE = "base_footprint", "base_link"


class Links:
    """Frames of all links below ``base_footprint``; joints that nobody reads stand at zero."""

    def __init__(self, urdf: Path, turning: Sequence[str]) -> None:
        """urdf: one that ``check_urdf`` lets pass; turning: the joints whose angles are measured."""
        model = read_urdf(urdf)
        joints, poses = [*_joints(model)], model.link_poses()
        self._carriers = {link: inverse(poses[link]) for link in model.carried_by(turning)}
        self._turning = {j.name: j for j in joints if j.name in turning}
        self._resting = [j for j in joints if j.name not in turning]

    def resting(self, vehicle: str, sensors: Sensors, t: float) -> FrameTransforms:
        """Transforms at ``t`` [s] of the links that do not move, and of the sensors; a sensor's mount holds before a link of its name."""
        mounted = sensor_frames(vehicle, sensors, t, self._carriers).transforms
        names = {frame.child_frame_id for frame in mounted}
        links = [frame for joint in self._resting if (frame := _frame(joint, vehicle, t)).child_frame_id not in names]
        return FrameTransforms(transforms=[*links, *mounted])

    def turned(self, vehicle: str, states: JointStates) -> FrameTransforms:
        """Transforms of the links that joints move, at the measured angles, stamped like these."""
        t = seconds(states.timestamp)
        read = [(self._turning[s.name], s.position) for s in states.joints if s.name in self._turning]
        return FrameTransforms(transforms=[_frame(joint, vehicle, t, angle) for joint, angle in read])


def _joints(model: UrdfModel) -> Iterator[Joint]:
    """The file's joints, and before them what ties its root to ``base_footprint``, at the same place."""
    chain = dict.fromkeys((FOOTPRINT, *(() if BASE in model.links else (BASE,)), model.roots[0]))
    for above, below in pairwise(chain):
        yield Joint("", "fixed", above, below)
    yield from model.joints.values()


def _frame(joint: Joint, vehicle: str, t: float, angle: float = 0.0) -> FrameTransform:
    parent_from_child = joint.at(angle)
    return FrameTransform(
        timestamp=stamp(t),
        parent_frame_id=f"{vehicle}/{joint.parent}",
        child_frame_id=f"{vehicle}/{joint.child}",
        translation=vector(parent_from_child.translation),
        rotation=quaternion(parent_from_child.rotation),
    )
