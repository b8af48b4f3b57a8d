"""Extended Kalman filter of a differential-drive vehicle: wheels drive it, the gyroscope turns it."""

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter
from numpy.typing import NDArray

from uvf.maths.planar import Pose2
from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]

POSITION = slice(0, 2)  # m, odom frame
HEADING = 2  # rad
BIAS = 3  # rad/s, of the gyroscope

AT_REST = 0.2  # s without a tick after which the wheels count as standing: a change of direction is shorter

BIAS_FROM_STATE = np.array(((0.0, 0.0, 0.0, 1.0),))


@dataclass(frozen=True)
class Noise:
    """How much each source is trusted."""

    distance: float  # m per square root of m driven, 1 sigma
    gyro: float  # rad/s, 1 sigma of one step's mean rate
    bias_walk: float  # rad/s per square root of s
    bias_start: float  # rad/s, 1 sigma before anything is known
    slip: float  # rad/s, 1 sigma of the turn rate told by the wheels while they turn
    rest: float  # rad/s, the same while they stand still


class OdometryFilter:
    """State (x, y, heading, gyro bias). Inputs: distance from the wheels and the gyroscope's turn rate (predict);
    measurement: gyroscope minus wheels, which shows the bias (update; sharp at rest, weak while wheels may slip).
    """

    def __init__(self, noise: Noise) -> None:
        self.noise = noise
        self._kf = ExtendedKalmanFilter(dim_x=4, dim_z=1)
        self._kf.x = np.zeros(4)
        self._kf.P = np.diag((0.0, 0.0, 0.0, noise.bias_start**2))
        self._still_for = 0.0
        self.speeds = (0.0, 0.0)
        """(m/s, rad/s) of the last step, bias taken off."""

    def resume(self, pose: Pose2, bias: float) -> None:
        """Goes on from where a filter before this one has come to."""
        self._kf.x = np.array((*pose, bias))

    @property
    def pose(self) -> Pose2:
        """odom_from_base."""
        x, y, heading, _ = self._kf.x
        return Pose2(float(x), float(y), wrap(float(heading)))

    @property
    def bias(self) -> float:
        """Estimated bias of the gyroscope [rad/s]."""
        return float(self._kf.x[BIAS])

    @property
    def covariance(self) -> Floats:
        """(4, 4) of (x, y, heading, bias)."""
        p: Floats = self._kf.P
        return p

    def step(self, distance: float, wheel_turn: float, gyro: float | None, dt: float) -> None:
        """Moves on by ``dt`` [s]: distance [m] and turn [rad] told by the wheels, gyro: mean rate [rad/s] or None."""
        wheel_rate = wheel_turn / dt
        self._still_for = self._still_for + dt if distance == 0.0 and wheel_turn == 0.0 else 0.0
        if gyro is not None:
            sigma = self.noise.rest if self._still_for > AT_REST else self.noise.slip
            # A better bias shall not move the poses of the past: odometry drifts, but it never jumps.
            self._kf.P[:BIAS, BIAS] = self._kf.P[BIAS, :BIAS] = 0.0
            self._kf.update(np.array((gyro - wheel_rate,)), lambda x: BIAS_FROM_STATE, lambda x: x[BIAS:], R=sigma**2)
        rate = wheel_rate if gyro is None else gyro - self.bias
        self._predict(distance, rate, dt)
        self.speeds = (distance / dt, rate)

    def _predict(self, distance: float, rate: float, dt: float) -> None:
        """Chord of the arc at the mean heading; F and Q are the derivatives of that motion."""
        kf, noise = self._kf, self.noise
        heading = float(kf.x[HEADING]) + rate * dt / 2
        c, s = cos(heading), sin(heading)
        f = np.eye(4)
        f[0, HEADING], f[1, HEADING] = -distance * s, distance * c
        f[HEADING, BIAS] = -dt
        along = noise.distance**2 * abs(distance)
        q = np.zeros((4, 4))
        q[POSITION, POSITION] = along * np.array(((c * c, c * s), (c * s, s * s)))
        q[HEADING, HEADING] = (noise.gyro * dt) ** 2
        q[BIAS, BIAS] = noise.bias_walk**2 * dt
        kf.x = kf.x + np.array((distance * c, distance * s, rate * dt, 0.0))
        kf.P = f @ kf.P @ f.T + q
