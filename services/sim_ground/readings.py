"""Readings as messages."""

import numpy as np
from numpy.typing import NDArray

from schemas.convert import quaternion, stamp, vector
from schemas.messages import Contact, Imu, JointState, JointStates, LaserScan, NavState, WheelTicks
from services.sim_ground.body import BodyState
from services.sim_ground.encoders import radians_per_tick, ticks
from services.sim_ground.imu import ImuReading
from uvf.runtime.vehicle_file import Encoders, GroundBody, Lidar

Floats = NDArray[np.float64]


def imu_message(t: float, frame: str, reading: ImuReading) -> Imu:
    return Imu(
        timestamp=stamp(t),
        frame_id=frame,
        angular_velocity=vector(reading.angular_velocity),
        specific_force=vector(reading.specific_force),
        magnetic_field=vector(reading.magnetic_field),
    )


def scan_message(t: float, frame: str, lidar: Lidar, ranges: Floats) -> LaserScan:
    """Counter-clockwise from ``start_angle``; the beams share [start, end] evenly, both ends included."""
    end = lidar.angle_min + (lidar.beams - 1) * lidar.angle_increment
    scan = LaserScan(timestamp=stamp(t), frame_id=frame, start_angle=lidar.angle_min, end_angle=end, ranges=ranges.tolist())
    scan.pose.orientation.w = 1.0
    return scan


def wheels_message(t: float, encoders: Encoders, body: BodyState) -> WheelTicks:
    left, right = ticks(encoders, body.wheel_angles)
    return WheelTicks(timestamp=stamp(t), left=left, right=right, radians_per_tick=radians_per_tick(encoders))


def contact_message(t: float, other: str | None) -> Contact:
    return Contact(timestamp=stamp(t), touching=other is not None, other=other or "")


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
