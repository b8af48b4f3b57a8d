"""The seam between the simulation and what drives in it: what a controller is told once, what it gets at 20 Hz, what it answers.

A navigation stack joins the benchmark by an entry in ``registry.CONTROLLERS``; the simulation knows it by that name alone, makes
one for each run, and never tells it the true pose or the world.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from benchmarks.planning.barn.worlds import World
from uvf.maths.kinematics import Twist
from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]

HZ = 20.0
"""Commands per second."""


@dataclass(frozen=True)
class Scanner:
    """A plane laser scanner ``forward`` [m] of base_link's origin, looking along its x axis."""

    forward: float  # m
    angle_min: float  # rad, direction of the first beam
    angle_increment: float  # rad, counter-clockwise
    beams: int
    range_min: float  # m
    range_max: float  # m
    noise: float  # m, 1 sigma of each beam


@dataclass(frozen=True)
class Robot:
    """What a controller may know of its vehicle. half_length, half_width: of the rectangle about base_link that holds the whole body."""

    half_length: float  # m
    half_width: float  # m
    max_linear: float  # m/s, forward and backward
    max_angular: float  # rad/s
    max_linear_acceleration: float  # m/s^2, what the tyres carry
    max_angular_acceleration: float  # rad/s^2
    scanner: Scanner

    @property
    def footprint(self) -> Floats:
        """Corners (4, 2) [m, base_link], counter-clockwise from the rear right."""
        a, b = self.half_length, self.half_width
        return np.array(((-a, -b), (a, -b), (a, b), (-a, b)))


class Controller(Protocol):
    """Drives the robot from its scans and its odometry. All poses are in the frame odom, which is base_link at the start."""

    def reset(self, goal_in_odom: Pose2) -> None:
        """Takes a new goal (x, y [m]; its yaw does not count) before the first command."""
        ...

    def command(self, t: float, ranges: Floats, odom_from_base: Pose2, velocity: Twist) -> tuple[float, float]:
        """Velocity to drive with: v [m/s], w [rad/s]; beyond the robot's limits it is clipped.

        t: s since the start; ranges: (beams,) [m] counter-clockwise from angle_min, taken at ``t``, 0 = no return; the array is the
        controller's own. odom_from_base and velocity (v, w): the odometry's at ``t``, with its errors.
        """
        ...


@dataclass(frozen=True)
class Briefing:
    """What a controller is made from. seed: for its random numbers; world: None but for ``registry.CHECKS``."""

    robot: Robot
    seed: int
    world: World | None = None
