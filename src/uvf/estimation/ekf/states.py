"""The states of the error-state filter: what is estimated, and how a small error of it is added.

Error-state Kalman filter after Sola (2017), "Quaternion kinematics for the error-state Kalman filter", with the error of attitude in
the navigation frame (his chapter 7): R_true = Exp(dtheta) R. Axes: north, east, down; forward, right, down.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

TILT = slice(0, 3)  # rad, about north, east and down
VELOCITY = slice(3, 6)  # m/s
POSITION = slice(6, 9)  # m
GYRO_BIAS = slice(9, 12)  # rad/s
ACCEL_BIAS = slice(12, 15)  # m/s^2
IRON = slice(15, 18)  # uT, hard iron: the magnetometer's bias
WIND = slice(18, 20)  # m/s north and east, the way it blows to
BARO = 20  # m, barometric altitude above height
PITOT = 21  # Pa, bias of the differential pressure: considered, not estimated
DRIFT = slice(22, 25)  # m, the slow error of satellite positions
SIZE = 25
DOWN = 8
YAW = 2

MAGNETIC = 1e-6
"""T in a unit of the filter's magnetic states: in tesla their variances would be near the rounding of the others."""


class NominalAttitude(NamedTuple):
    """Unit quaternion ned_from_frd (Hamilton)."""

    w: float
    x: float
    y: float
    z: float

    def times(self, o: "NominalAttitude") -> "NominalAttitude":
        """Product a_from_b times b_from_c, normalised."""
        w = self.w * o.w - self.x * o.x - self.y * o.y - self.z * o.z
        x = self.w * o.x + self.x * o.w + self.y * o.z - self.z * o.y
        y = self.w * o.y - self.x * o.z + self.y * o.w + self.z * o.x
        z = self.w * o.z + self.x * o.y - self.y * o.x + self.z * o.w
        n = 1 / math.sqrt(w * w + x * x + y * y + z * z)
        return NominalAttitude(w * n, x * n, y * n, z * n)

    def matrix(self) -> Floats:
        """Rotation matrix (3, 3) ned_from_frd."""
        w, x, y, z = self
        return np.array(
            (
                (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
            )
        )

    def euler(self) -> tuple[float, float, float]:
        """Euler angles (roll, pitch, yaw) [rad]."""
        w, x, y, z = self
        pitch = math.asin(min(max(2 * (w * y - z * x), -1.0), 1.0))
        return math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), pitch, math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def turned(vector: Floats) -> NominalAttitude:
    """Quaternion of a rotation vector (3,) [rad]."""
    x, y, z = vector.tolist()
    angle = math.sqrt(x * x + y * y + z * z)
    k = 0.5 - angle * angle / 48 if angle < 1e-3 else math.sin(angle / 2) / angle
    return NominalAttitude(math.cos(angle / 2), k * x, k * y, k * z)


def cross_matrix(v: Floats) -> Floats:
    """Skew-symmetric matrix (3, 3) of ``v`` (3,): ``cross_matrix(v) @ u`` is v x u."""
    x, y, z = v.tolist()
    return np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))


class FilterState:
    """Nominal state. ``x``: (25,) by the slices above, but for the attitude, which is ``attitude`` and ``rotation``."""

    def __init__(self, attitude: NominalAttitude) -> None:
        self.x: Floats = np.zeros(SIZE)
        self.turn_to(attitude)

    def turn_to(self, attitude: NominalAttitude) -> None:
        """Sets the attitude, and the rotation matrix with it."""
        self.attitude = attitude
        self.rotation = attitude.matrix()
        """(3, 3) ned_from_frd."""

    def add(self, error: Floats) -> None:
        """Injects the estimated error (25,) into the state."""
        self.x[3:] += error[3:]
        self.turn_to(turned(error[TILT]).times(self.attitude))

    def copy(self) -> "FilterState":
        """A state of its own with the same values."""
        twin = FilterState(self.attitude)
        twin.x = self.x.copy()
        return twin

    @property
    def through_air(self) -> Floats:
        """Velocity through the air (3,) [m/s], NED: velocity less the wind, which is horizontal."""
        relative: Floats = self.x[VELOCITY].copy()
        relative[:2] -= self.x[WIND]
        return relative
