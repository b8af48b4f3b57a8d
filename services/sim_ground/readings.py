"""Readings as messages."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.convert import quaternion, seconds, stamp, vector
from schemas.messages import Contact, FrameTransforms, JointState, JointStates, LaserScan, NavState, Range, WheelTicks
from services.sim_ground.body import BodyState, Touch
from services.sim_ground.encoders import radians_per_tick, ticks
from uvf.runtime.service import Value
from uvf.runtime.vehicle_file import Bumper, Encoders, GroundBody, Lidar, Sonar

Floats = NDArray[np.float64]


def scan_message(t: float, frame: str, lidar: Lidar, ranges: Floats) -> LaserScan:
    """Counter-clockwise from ``start_angle``; the beams share [start, end] evenly, both ends included."""
    end = lidar.angle_min + (lidar.beams - 1) * lidar.angle_increment
    scan = LaserScan(timestamp=stamp(t), frame_id=frame, start_angle=lidar.angle_min, end_angle=end, ranges=ranges.tolist())
    scan.pose.orientation.w = 1.0
    return scan


def wheels_message(t: float, encoders: Encoders, body: BodyState) -> WheelTicks:
    left, right = ticks(encoders, body.wheel_angles)
    return WheelTicks(timestamp=stamp(t), left=left, right=right, radians_per_tick=radians_per_tick(encoders))


def range_message(t: float, frame: str, sonar: Sonar, distance: float) -> Range:
    return Range(
        timestamp=stamp(t),
        frame_id=frame,
        range=distance,
        field_of_view=sonar.fov,
        range_min=sonar.range_min,
        range_max=sonar.range_max,
    )


def contact_message(t: float, bumpers: Sequence[Bumper], touches: Sequence[Touch]) -> Contact:
    """All that was touched since the message before; the first one gives its name."""
    sectors = [b.name for b in bumpers if any(b.feels(touch.bearing) for touch in touches)]
    return Contact(timestamp=stamp(t), touching=bool(touches), other=touches[0].other if touches else "", sectors=sectors)


def joints_message(t: float, ground: GroundBody, body: BodyState) -> JointStates:
    rows = zip((ground.left_joint, ground.right_joint), body.wheel_angles, body.wheel_speeds, strict=True)
    joints = [JointState(name=name, position=angle, velocity=speed) for name, angle, speed in rows]
    return JointStates(timestamp=stamp(t), joints=joints)


def truth_message(t: float, body: BodyState) -> NavState:
    return NavState(
        timestamp=stamp(t),
        position=vector(body.position),
        velocity=vector(body.velocity),
        orientation=quaternion(body.world_from_body),
        angular_velocity=vector(body.angular_velocity),
    )


def later(read: Value, seconds_later: float) -> Value:
    """The same readings with stamps ``seconds_later`` [s]."""
    for message in read if isinstance(read, Sequence) else (read,):
        for stamped in message.transforms if isinstance(message, FrameTransforms) else (message,):
            stamped.timestamp.CopyFrom(stamp(seconds(stamped.timestamp) + seconds_later))  # type: ignore[attr-defined]
    return read
