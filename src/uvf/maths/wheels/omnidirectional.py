"""Kinematics of vehicles on wheels with rollers, mecanum and omni wheels: any velocity in the plane, any turn rate.

A wheel holds along the axes of the rollers that touch the floor, and gives way across them; so its speed follows from the motion of the
point where it stands (Muir and Neuman, Kinematic modeling for feedback control of an omnidirectional wheeled mobile robot, 1987;
Siegwart and Nourbakhsh, Introduction to Autonomous Mobile Robots, 3.2.3).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sin, tan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.kinematics import Twist, WheelTravel

Floats = NDArray[np.float64]

WORST = 50.0
"""Ratio of the strongest to the weakest motion per wheel speed, turning measured at the wheels, from which on one of them is none."""


class RollerWheel(NamedTuple):
    """Where a wheel stands and rolls, in base_link.

    x, y: m; heading: rad, in which it rolls; roller: rad, from there to the axes of the rollers on the floor, 0 of omni wheels.
    """

    x: float
    y: float
    heading: float = 0.0
    roller: float = 0.0


def mecanum_wheels(track: float, wheelbase: float) -> tuple[RollerWheel, ...]:
    """Front left, rear left, front right, rear right; track and wheelbase [m]. From above the upper rollers' axes form an X."""
    x, y = wheelbase / 2, track / 2
    return (
        RollerWheel(x, y, 0.0, -pi / 4),
        RollerWheel(-x, y, 0.0, pi / 4),
        RollerWheel(x, -y, 0.0, pi / 4),
        RollerWheel(-x, -y, 0.0, -pi / 4),
    )


@dataclass(frozen=True)
class OmnidirectionalDrive:
    """Geometry of such a drive. wheel_radius: m."""

    wheel_radius: float
    placed: tuple[RollerWheel, ...]

    @cached_property
    def _wheels_from_twist(self) -> Floats:
        """(n, 3): the wheels' speeds [rad/s] are its product with (v_x, v_y [m/s], omega [rad/s])."""
        return np.array([_row(wheel) for wheel in self.placed]) / self.wheel_radius

    @cached_property
    def _twist_from_wheels(self) -> Floats:
        return np.asarray(np.linalg.pinv(self._wheels_from_twist), dtype=np.float64)

    @property
    def is_complete(self) -> bool:
        """Whether the wheels drive it in all three ways."""
        arm = max(1e-9, *(float(np.hypot(wheel.x, wheel.y)) for wheel in self.placed))
        strengths = np.linalg.svd(self._wheels_from_twist / np.array((1.0, 1.0, arm)), compute_uv=False)
        return len(self.placed) >= 3 and bool(strengths[0] < WORST * strengths[-1])

    @property
    def channels(self) -> int:
        """One a wheel."""
        return len(self.placed)

    @property
    def goes_sideways(self) -> bool:
        """Yes."""
        return True

    @property
    def turning_radius(self) -> float:
        """None."""
        return 0.0

    @property
    def track(self) -> float:
        """Of the differential drive whose wheels turn as fast when both turn on the spot [m]."""
        return 2.0 * self.wheel_radius * float(np.abs(self._wheels_from_twist[:, 2]).mean())

    def twist(self, wheels: Sequence[float]) -> Twist:
        """Velocity of the body at these speeds [rad/s]; wheels that contradict one another count alike (least squares)."""
        v_x, v_y, turn = (self._twist_from_wheels @ np.asarray(wheels)).tolist()
        return Twist(v_x, turn, v_y)

    def travel(self, turned: Sequence[float]) -> WheelTravel:
        """Of the two wheels of ``track`` that would turn it as much, and sideways, by wheels that have turned so far [rad]."""
        ahead, turn, aside = self.twist(turned)
        return WheelTravel(ahead - turn * self.track / 2, ahead + turn * self.track / 2, aside)

    def wheels(self, twist: Twist) -> tuple[float, ...]:
        """Speeds [rad/s] for a commanded velocity of the body."""
        speeds = self._wheels_from_twist @ np.array((twist.linear, twist.lateral, twist.angular))
        return tuple(speeds.tolist())


def _row(wheel: RollerWheel) -> tuple[float, float, float]:
    """Of the tread's speed [m/s]: the point where the wheel stands moves along the rollers' axes as the tread does."""
    c, s, slant = cos(wheel.heading), sin(wheel.heading), tan(wheel.roller)
    ahead, aside = c - s * slant, s + c * slant
    return ahead, aside, wheel.x * aside - wheel.y * ahead
