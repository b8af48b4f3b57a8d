"""The steering gear of a car: one angle asked for, and how each of the steered wheels stands by it."""

from collections.abc import Sequence
from math import isfinite

from uvf.control.drive_limits import approach
from uvf.maths.wheels.steered import AckermannDrive, wheel_steering

Places = Sequence[tuple[float, float]]


class SteeringGear:
    """Turns as fast as it can to the angle asked for, up to its stop. Angles [rad] are left positive."""

    def __init__(self, joints: Sequence[int], places: Places, signs: Sequence[float], drive: AckermannDrive, rate: float) -> None:
        """joints: that steer; places: (x, y) [m, base_link] of their wheels; signs: -1 of joints whose axis points down; rate: rad/s."""
        self.joints = tuple(joints)
        self.angle = 0.0
        """Of a wheel in the middle between the steered ones."""
        self._wheels = list(zip(places, signs, strict=True))
        self._drive, self._rate = drive, rate

    def turn(self, wanted: float, dt: float) -> list[float]:
        """Positions of the joints ``dt`` [s] later; it stays where it is when the angle asked for is no number."""
        if isfinite(wanted):
            most = self._drive.max_steering
            self.angle = approach(self.angle, min(max(wanted, -most), most), self._rate * dt)
        curvature = self._drive.curvature(self.angle)
        return [sign * wheel_steering(curvature, x, y) for (x, y), sign in self._wheels]
