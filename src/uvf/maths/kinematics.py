"""Kinematics of rigid bodies and of the differential drive: wheel speeds, body velocity, motion along an arc.

Siegwart & Nourbakhsh, Introduction to Autonomous Mobile Robots, 3.2; the pose is that of the middle of the axle.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]


class Twist(NamedTuple):
    """Velocity of the body: ``linear`` forward [m/s], ``angular`` counter-clockwise [rad/s]."""

    linear: float
    angular: float


class WheelSpeeds(NamedTuple):
    """Speeds of the left and the right wheel [rad/s]; positive drives forward."""

    left: float
    right: float


@dataclass(frozen=True)
class DifferentialDrive:
    """Geometry of a differential drive. wheel_radius: r [m]; track: l [m], between the wheels' contact points."""

    wheel_radius: float
    track: float

    def twist(self, wheels: WheelSpeeds) -> Twist:
        """Forward kinematics: v = r (w_r + w_l) / 2, omega = r (w_r - w_l) / l."""
        r, left, right = self.wheel_radius, wheels.left, wheels.right
        return Twist(r * (right + left) / 2, r * (right - left) / self.track)

    def wheels(self, twist: Twist) -> WheelSpeeds:
        """Inverse kinematics: the wheel speeds for a commanded body velocity."""
        half_difference = twist.angular * self.track / 2
        return WheelSpeeds((twist.linear - half_difference) / self.wheel_radius, (twist.linear + half_difference) / self.wheel_radius)


def move(pose: Pose2, twist: Twist, dt: float) -> Pose2:
    """Pose after ``dt`` [s] at constant velocity: the exact arc about the instantaneous centre of curvature.

    Written by the arc's chord, v dt sinc(omega dt / 2) along the mean heading, which equals the rotation about
    ICC = (x - R sin yaw, y + R cos yaw), R = v / omega, and has no special case for straight lines.
    """
    turn = twist.angular * dt
    chord = twist.linear * dt * float(np.sinc(turn / (2 * np.pi)))
    x, y, yaw = pose
    heading = yaw + turn / 2
    return Pose2(x + chord * float(np.cos(heading)), y + chord * float(np.sin(heading)), wrap(yaw + turn))


def twist_between(start: Pose2, end: Pose2, dt: float) -> Twist:
    """Constant velocity whose arc leads from one pose to the other in ``dt`` [s]: the inverse of ``move`` for turns below pi.

    Where no arc does, because of a step sideways, the one of the same turn whose chord reaches as far along its heading.
    """
    turn = wrap(end.yaw - start.yaw)
    heading = start.yaw + turn / 2
    chord = (end.x - start.x) * float(np.cos(heading)) + (end.y - start.y) * float(np.sin(heading))
    return Twist(chord / (dt * float(np.sinc(turn / (2 * np.pi)))), turn / dt)


def spin_velocity(angular_velocity: Floats, arm: Floats) -> Floats:
    """Velocity omega x r (3,) [m/s] of a body's point at ``arm`` (3,) [m] against its origin; rates (3,) [rad/s], all in one frame.

    Written out: ``np.cross`` takes ten times as long on one pair.
    """
    (p, q, r), (x, y, z) = angular_velocity.tolist(), arm.tolist()
    return np.array((q * z - r * y, r * x - p * z, p * y - q * x))
