"""The Jackal's odometry: the project's filter over wheel encoders and a gyroscope that err, in the frame of the start.

The gyroscope is that of the Jackal's Gazebo model (jackal.gazebo): 0.005 rad/s of noise per sample at 50 Hz and 0.005 rad/s of bias,
which a standstill before the start tells the filter but for the noise. Wheel radii are off by 0.5 %, 1 sigma each, drawn once a run.
"""

import numpy as np

from benchmarks.planning.barn.jackal import TRACK, TRACK_FACTOR, WHEEL_RADIUS
from uvf.estimation.odometry.filter import DriveFilter
from uvf.estimation.odometry.states import Noise, Step
from uvf.maths.kinematics import Twist, WheelTravel
from uvf.maths.se2 import Pose2

GYRO_NOISE = 0.005 * np.sqrt(0.02)  # rad/s per root of Hz
GYRO_BIAS = 0.005  # rad/s, 1 sigma
RADIUS_ERROR = 0.005  # 1 sigma, of each side
TICK = 1.0 / 78000  # m, from one tick of the encoders to the next
STANDSTILL = 10.0  # s before the start
SKID = 0.3  # part of a turn by which four wheels may tell it wrong


class Odometry:
    """Where the robot believes it is, and how fast it goes."""

    def __init__(self, dt: float, rng: np.random.Generator) -> None:
        """dt: s, from one reading to the next. It stands still first."""
        self._dt, self._rng = dt, rng
        self._metres_per_radian = WHEEL_RADIUS / (1.0 + RADIUS_ERROR * rng.standard_normal(2))
        self._bias = GYRO_BIAS * float(rng.standard_normal())
        self._ticks, self._yaw = np.zeros(2), 0.0
        noise = Noise(resolution=TICK, gyro=GYRO_NOISE, skid=SKID, scale_start=RADIUS_ERROR)
        self._filter = DriveFilter("ekf", noise, TRACK_FACTOR * TRACK)
        for _ in range(round(STANDSTILL / dt)):
            self.read((0.0, 0.0), 0.0)
        self._filter.place(Pose2(0.0, 0.0, 0.0), (0.0, 0.0))

    @property
    def pose(self) -> Pose2:
        """odom_from_base: x, y [m], yaw [rad]."""
        return self._filter.pose

    @property
    def twist(self) -> Twist:
        """Velocity forward [m/s] and turn rate [rad/s]."""
        return self._filter.velocity

    def read(self, rolled: tuple[float, float], yaw: float) -> None:
        """Takes the next reading: angles [rad] of the wheels since the start, and the true yaw [rad, not wrapped] since then."""
        ticks = np.floor(np.array(rolled) * self._metres_per_radian / TICK)
        left, right = ((ticks - self._ticks) * TICK).tolist()
        noise = GYRO_NOISE / np.sqrt(self._dt) * float(self._rng.standard_normal())
        rate = (yaw - self._yaw) / self._dt + self._bias + noise
        self._ticks, self._yaw = ticks, yaw
        self._filter.step(Step(self._dt, WheelTravel(left, right), float(rate)))
