"""From the velocity asked for to the velocity given: limits of speed and acceleration."""

from dataclasses import dataclass


@dataclass(frozen=True)
class DriveLimits:
    """Limits of velocity and acceleration of a ground vehicle, in the base frame."""

    linear: float  # m/s
    angular: float  # rad/s
    linear_acceleration: float  # m/s^2
    angular_acceleration: float  # rad/s^2


def within_limits(linear: float, angular: float, limits: DriveLimits, top_speed: float) -> tuple[float, float]:
    """Velocity (linear [m/s], angular [rad/s]) scaled down as a whole to the limits, so that the requested curvature is kept."""
    fastest = min(limits.linear, top_speed)
    excess = max(abs(linear) / fastest, abs(angular) / limits.angular, 1.0)
    return linear / excess, angular / excess


def approach(current: float, wanted: float, most: float) -> float:
    """``current`` moved towards ``wanted`` by at most ``most``, all three in one unit, e.g. [m/s] or [rad/s]."""
    return current + min(max(wanted - current, -most), most)


class VelocityRamp:
    """The commanded velocity, moved towards the requested one within the acceleration limits."""

    def __init__(self, limits: DriveLimits) -> None:
        self.limits = limits
        self.linear = 0.0  # m/s
        self.angular = 0.0  # rad/s

    def lead(self, linear: float, angular: float, dt: float) -> tuple[float, float]:
        """The next commanded velocity (linear [m/s], angular [rad/s]), ``dt`` [s] later."""
        self.linear = approach(self.linear, linear, self.limits.linear_acceleration * dt)
        self.angular = approach(self.angular, angular, self.limits.angular_acceleration * dt)
        return self.linear, self.angular
