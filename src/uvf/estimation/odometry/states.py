"""What the filters estimate, what a step is told, and how much each source is trusted."""

from dataclasses import dataclass
from typing import NamedTuple

from uvf.maths.kinematics import WheelTravel

X, Y, HEADING, SPEED, GYRO_BIAS, ACCEL_OFFSET, LEFT, RIGHT, GNSS_X, GNSS_Y = range(10)
"""m, m, rad (not wrapped: a mean of headings is a plain mean), m/s forward, rad/s, m/s^2, and the errors of the wheels' radii as parts
of them: a wheel has rolled (1 + error) times what its radius says. The last two are the slow errors of satellite positions [m], where
there are any.
"""

POSE = slice(0, 3)
STATES = 8
STATES_WITH_GNSS = 10


class Step(NamedTuple):
    """Wheel and inertial readings of the last ``dt`` [s]."""

    dt: float
    travel: WheelTravel  # by the nominal radii of the wheels
    rate: float | None = None  # rad/s, mean of the gyroscope about the upward axis
    force: float | None = None  # m/s^2, mean of the accelerometer's forward axis at the middle of the axle
    tilting: float = 0.0  # m/s^3, by which gravity's part of that force changes as the vehicle pitches, and turns on a slope
    tilting_noise: float = 0.0  # m/s^2 per square root of s, 1 sigma of it
    jolt: float = 0.0  # m/s^2, by which the force differs from that of the step before

    @property
    def left(self) -> float:
        """Way of the left wheel [m]."""
        return self.travel.left

    @property
    def right(self) -> float:
        """Way of the right wheel [m]."""
        return self.travel.right


@dataclass(frozen=True)
class Noise:
    """Noise model of the filter, 1 sigma each."""

    distance: float = 0.005  # m per square root of m that a wheel rolls
    resolution: float = 1e-4  # m, way of a wheel from one tick to the next
    give: float = 5e-4  # m per m/s^2 of jolt, by which tyres give and swing
    skid: float = 0.05  # part of a turn by which the wheels may tell it wrong
    turn: float = 0.003  # rad per square root of rad turned, of the gyroscope
    gyro: float = 3e-4  # rad per square root of s
    bias_walk: float = 3e-5  # rad/s per square root of s
    bias_start: float = 0.05  # rad/s
    accel: float = 0.01  # m/s per square root of s
    offset_walk: float = 0.005  # m/s^2 per square root of s
    offset_start: float = 0.5  # m/s^2
    scale_start: float = 0.01  # of each wheel's radius
    scale_walk: float = 1e-5  # per square root of m
    rest: float = 0.001  # rad/s, of the gyroscope's mean over a step while standing, beside its noise
