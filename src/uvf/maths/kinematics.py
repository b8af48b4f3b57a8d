"""Kinematics of rigid bodies and of the differential drive: wheel speeds, body velocity, motion along an arc.

Siegwart & Nourbakhsh, Introduction to Autonomous Mobile Robots, 3.2; the pose is that of the middle of the axle.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]


class Twist(NamedTuple):
    """Velocity of the body: ``linear`` forward [m/s], ``angular`` counter-clockwise [rad/s], ``lateral`` to the left [m/s]."""

    linear: float
    angular: float
    lateral: float = 0.0


class WheelTravel(NamedTuple):
    """What a vehicle's wheels have rolled: left and right as a differential drive, and sideways to the left [m]."""

    left: float
    right: float
    aside: float = 0.0


class WheelSpeeds(NamedTuple):
    """Speeds of the left and the right wheel [rad/s]; positive drives forward."""

    left: float
    right: float


class DriveKinematics(Protocol):
    """How the speeds of a vehicle's wheels and its motion belong together: one speed a side, or one a wheel."""

    @property
    def wheel_radius(self) -> float:
        """m."""
        ...

    @property
    def track(self) -> float:
        """Of the two wheels that turn on the spot as this drive does [m]."""
        ...

    @property
    def channels(self) -> int:
        """How many speeds drive it."""
        ...

    @property
    def goes_sideways(self) -> bool:
        """Whether it can move to the side without turning."""
        ...

    @property
    def turning_radius(self) -> float:
        """Of the tightest circle that base_link can drive [m]; 0: it turns on the spot."""
        ...

    def twist(self, wheels: Sequence[float]) -> Twist:
        """Velocity of the body at these speeds [rad/s]."""
        ...

    def wheels(self, twist: Twist) -> tuple[float, ...]:
        """Speeds [rad/s] for a commanded velocity of the body."""
        ...

    def travel(self, turned: Sequence[float]) -> WheelTravel:
        """Of the two wheels of ``track`` that would turn it as much, and sideways, by wheels that have turned so far [rad]."""
        ...


@dataclass(frozen=True)
class DifferentialDrive:
    """Geometry of a differential drive. wheel_radius: r [m]; track: l [m], between the wheels' contact points."""

    wheel_radius: float
    track: float

    @property
    def channels(self) -> int:
        """One a side."""
        return 2

    @property
    def goes_sideways(self) -> bool:
        """No."""
        return False

    @property
    def turning_radius(self) -> float:
        """None."""
        return 0.0

    def twist(self, wheels: Sequence[float]) -> Twist:
        """Forward kinematics: v = r (w_r + w_l) / 2, omega = r (w_r - w_l) / l."""
        r, (left, right) = self.wheel_radius, wheels
        return Twist(r * (right + left) / 2, r * (right - left) / self.track)

    def travel(self, turned: Sequence[float]) -> WheelTravel:
        """Of the left and the right wheel, by wheels that have turned so far [rad]."""
        left, right = turned
        return WheelTravel(left * self.wheel_radius, right * self.wheel_radius)

    def wheels(self, twist: Twist) -> WheelSpeeds:
        """Inverse kinematics: the wheel speeds for a commanded body velocity."""
        half_difference = twist.angular * self.track / 2
        return WheelSpeeds((twist.linear - half_difference) / self.wheel_radius, (twist.linear + half_difference) / self.wheel_radius)


def move(pose: Pose2, twist: Twist, dt: float) -> Pose2:
    """Pose after ``dt`` [s] at constant velocity: the exact arc about the instantaneous centre of curvature.

    Written by the arc's chord, v dt sinc(omega dt / 2) along the mean heading and across it, which equals the rotation about
    ICC = (x - R sin yaw, y + R cos yaw), R = v / omega, and has no special case for straight lines.
    """
    turn = twist.angular * dt
    bend = dt * float(np.sinc(turn / (2 * np.pi)))
    ahead, aside = twist.linear * bend, twist.lateral * bend
    x, y, yaw = pose
    c, s = float(np.cos(yaw + turn / 2)), float(np.sin(yaw + turn / 2))
    return Pose2(x + ahead * c - aside * s, y + ahead * s + aside * c, wrap(yaw + turn))


def twist_between(start: Pose2, end: Pose2, dt: float) -> Twist:
    """Constant velocity whose arc leads from one pose to the other in ``dt`` [s]: the inverse of ``move`` for turns below pi."""
    turn = wrap(end.yaw - start.yaw)
    c, s = float(np.cos(start.yaw + turn / 2)), float(np.sin(start.yaw + turn / 2))
    x, y, bend = end.x - start.x, end.y - start.y, dt * float(np.sinc(turn / (2 * np.pi)))
    return Twist((x * c + y * s) / bend, turn / dt, (y * c - x * s) / bend)


def spin_velocity(angular_velocity: Floats, arm: Floats) -> Floats:
    """Velocity omega x r (3,) [m/s] of a body's point at ``arm`` (3,) [m] against its origin; rates (3,) [rad/s], all in one frame.

    Written out: ``np.cross`` takes ten times as long on one pair.
    """
    (p, q, r), (x, y, z) = angular_velocity.tolist(), arm.tolist()
    return np.array((q * z - r * y, r * x - p * z, p * y - q * x))
