"""Where a vehicle's sensors sit, as the transforms that go out once on ``tf/static``."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from schemas.messages import FrameTransform, FrameTransforms
from uvf.maths.rotations import from_euler
from uvf.maths.se3 import Transform, compose
from uvf.models.vehicle.sensors import Camera, Mount, Sensors
from uvf.runtime.messages.convert import quaternion, stamp, vector

Floats = NDArray[np.float64]

BASE = "base_link"
BASE_ALONE: Mapping[str, Transform] = {}
OPTICAL = Mount(rpy=(-np.pi / 2, 0.0, -np.pi / 2))
"""From a camera's mount (x along the view, z up) to its picture's axes (x right, y down, z along the view; REP-103)."""


def sensor_frames(vehicle: str, sensors: Sensors, t: float, carriers: Mapping[str, Transform] = BASE_ALONE) -> FrameTransforms:
    """Transforms at ``t`` [s] from ``base_link`` to each sensor, and from each camera to ``<camera>_optical``, the frame of its pictures.

    carriers: links that joints move, with link_from_base of each when these are at zero: what sits on them hangs there.
    A gimbal's own frame is not among them, for it moves.
    """
    fitted = [
        *sensors.lidars,
        *(s for s in (sensors.imu, sensors.camera, sensors.chase) if s is not None),
        *sensors.sonars,
        *sensors.rangefinders,
    ]
    transforms = []
    for sensor in fitted:
        link = sensor.mount.link if sensor.mount.link in carriers else None
        pose = Transform(from_euler(*sensor.mount.rpy), np.array(sensor.mount.xyz))
        pose = pose if link is None else compose(carriers[link], pose)
        transforms.append(_placed(f"{vehicle}/{link or BASE}", f"{vehicle}/{sensor.frame}", (pose.translation, pose.rotation), t))
    for camera in (c for c in (sensors.camera, sensors.chase, sensors.gimbal) if c is not None):
        frame = f"{vehicle}/{camera.frame}"
        transforms.append(_transform(frame, f"{frame}_optical", OPTICAL, t))
    return FrameTransforms(transforms=transforms)


def _transform(parent: str, child: str, mount: Mount, t: float) -> FrameTransform:
    return _placed(parent, child, (np.array(mount.xyz), from_euler(*mount.rpy)), t)


def _placed(parent: str, child: str, pose: tuple[Floats, Floats], t: float) -> FrameTransform:
    return FrameTransform(
        timestamp=stamp(t), parent_frame_id=parent, child_frame_id=child, translation=vector(pose[0]), rotation=quaternion(pose[1])
    )


def mounted(vehicle: str, camera: Camera, body_from_camera: Floats, t: float) -> FrameTransform:
    """Transform at ``t`` [s] from ``base_link`` to a camera that moves. body_from_camera: its attitude wxyz (4,)."""
    return _placed(f"{vehicle}/{BASE}", f"{vehicle}/{camera.frame}", (np.array(camera.mount.xyz), body_from_camera), t)
