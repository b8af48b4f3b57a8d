"""Where a vehicle's sensors sit, as the transforms that go out once on ``tf/static``."""

import numpy as np

from schemas.convert import quaternion, stamp, vector
from schemas.messages import FrameTransform, FrameTransforms
from uvf.maths.rotations import from_euler
from uvf.runtime.vehicle_file import Mount, Sensors

OPTICAL = Mount(rpy=(-np.pi / 2, 0.0, -np.pi / 2))
"""From a camera's mount (x along the view, z up) to its picture's axes (x right, y down, z along the view; REP-103)."""


def sensor_frames(vehicle: str, sensors: Sensors, t: float) -> FrameTransforms:
    """``base_link`` to each sensor, and for a camera on to ``<camera>_optical``, the frame of its pictures."""
    fitted = [s for s in (sensors.lidar, sensors.imu, sensors.camera, *sensors.sonars) if s is not None]
    transforms = [_transform(f"{vehicle}/base_link", f"{vehicle}/{s.frame}", s.mount, t) for s in fitted]
    if sensors.camera is not None:
        frame = f"{vehicle}/{sensors.camera.frame}"
        transforms.append(_transform(frame, f"{frame}_optical", OPTICAL, t))
    return FrameTransforms(transforms=transforms)


def _transform(parent: str, child: str, mount: Mount, t: float) -> FrameTransform:
    return FrameTransform(
        timestamp=stamp(t),
        parent_frame_id=parent,
        child_frame_id=child,
        translation=vector(np.array(mount.xyz)),
        rotation=quaternion(from_euler(*mount.rpy)),
    )
