"""From the velocity asked for to the velocity given: limits of speed and acceleration."""

from dataclasses import dataclass
from math import hypot

from uvf.maths.kinematics import Twist


@dataclass(frozen=True)
class DriveLimits:
    """Limits of velocity and acceleration of a ground vehicle, in the base frame."""

    linear: float  # m/s, of the velocity in whatever direction
    angular: float  # rad/s
    linear_acceleration: float  # m/s^2
    angular_acceleration: float  # rad/s^2


def within_limits(asked: Twist, limits: DriveLimits, top_speed: float) -> Twist:
    """Velocity scaled down as a whole to the limits, so that the requested path is kept. top_speed: m/s."""
    fastest = min(limits.linear, top_speed)
    excess = max(hypot(asked.linear, asked.lateral) / fastest, abs(asked.angular) / limits.angular, 1.0)
    return Twist(asked.linear / excess, asked.angular / excess, asked.lateral / excess)


def approach(current: float, wanted: float, most: float) -> float:
    """``current`` moved towards ``wanted`` by at most ``most``, all three in one unit, e.g. [m/s] or [rad/s]."""
    return current + min(max(wanted - current, -most), most)


class VelocityRamp:
    """The commanded velocity, moved towards the requested one within the acceleration limits."""

    steering = 0.0
    """rad; nothing is steered."""

    def __init__(self, limits: DriveLimits) -> None:
        self.limits = limits
        self.velocity = Twist(0.0, 0.0)

    def lead(self, wanted: Twist, dt: float) -> Twist:
        """The next commanded velocity, ``dt`` [s] later."""
        most, now = self.limits.linear_acceleration * dt, self.velocity
        self.velocity = Twist(
            approach(now.linear, wanted.linear, most),
            approach(now.angular, wanted.angular, self.limits.angular_acceleration * dt),
            approach(now.lateral, wanted.lateral, most),
        )
        return self.velocity

    def stand(self) -> None:
        """Brakes at once, as fast as the wheels can; a turn goes on."""
        self.velocity = Twist(0.0, self.velocity.angular)
