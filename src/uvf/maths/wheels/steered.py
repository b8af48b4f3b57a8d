"""Kinematics of cars: an axle of two wheels that stay straight, and wheels before or behind it that turn to where they roll.

The centre of the turn lies on the line of the straight axle, and each steered wheel stands across the line to it (Ackermann's steering;
Jazar, Vehicle Dynamics, 7.1; Siegwart & Nourbakhsh, Introduction to Autonomous Mobile Robots, 3.2). base_link is the axle's middle.
"""

from dataclasses import dataclass
from math import atan, atan2, tan

from uvf.maths.kinematics import DifferentialDrive


@dataclass(frozen=True)
class AckermannDrive(DifferentialDrive):
    """The straight axle turns as a differential drive does, within what the steering allows.

    wheelbase: from the straight axle to the steered one [m]; max_steering: of a wheel in the middle of the steered axle [rad].
    """

    wheelbase: float
    max_steering: float

    @property
    def turning_radius(self) -> float:
        """Of the tightest circle that the axle's middle can drive [m]."""
        return self.wheelbase / tan(self.max_steering)

    def steering(self, curvature: float) -> float:
        """Angle [rad, left positive] of a wheel in the middle of the steered axle on a path of this curvature [1/m]."""
        return atan(self.wheelbase * curvature)

    def curvature(self, steering: float) -> float:
        """Of the path [1/m, left positive] of the axle's middle, by the angle of a wheel in the middle of the steered axle [rad]."""
        return tan(steering) / self.wheelbase


def wheel_steering(curvature: float, x: float, y: float) -> float:
    """Angle [rad, left positive] of a wheel at (x, y) [m, base_link] while the axle's middle drives a curve [1/m]; |curvature y| < 1."""
    return atan2(curvature * x, 1.0 - curvature * y)
