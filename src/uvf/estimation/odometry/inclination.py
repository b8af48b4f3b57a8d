"""The slope under a ground vehicle: what it changes in what the accelerometer feels, as the vehicle pitches and as it turns on the slope.

A Kalman filter of gravity's forward and left parts and of the accelerometer's biases there. What turns with the ground as the vehicle
yaws is gravity, and what stays with the vehicle is bias: they are told apart in the first turns, and not before.
"""

from math import asin, cos, hypot, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.geodesy import GRAVITY
from uvf.maths.kinematics import WheelTravel

Floats = NDArray[np.float64]

STEEP, BIAS = 2.0, 0.1  # m/s^2, 1 sigma at the start of gravity's parts, and of the biases
SHAKEN, BIAS_WALK = 0.03, 1e-3  # m/s^2 per square root of s, by which they change beside what the gyroscope says
FELT = 0.3  # m/s^2, 1 sigma of what is felt beside gravity and bias: skidding, bumps, the speed's changes
STRUCK, BLOW = 1.5, 0.2  # m/s^2 of difference, from which on it is a blow; s after which it is none, but ground that was not felt before
LEVEL, KNOWN = 0.05, 0.4  # sine of a slope, below which it may be all bias; m/s^2, 1 sigma of gravity's parts from which on it is told
STEEPEST = 0.6  # sine of a slope: more is a vehicle that is spun about, or falls
SETTLED, KEPT = 0.5, 20.0  # s at rest after which a vehicle has rocked to its end, and s of rest whose mean is the gyroscope's bias
FAST, SLOW, STEADY = 0.1, 0.5, 0.1  # s, of two means of what is felt at rest; m/s^2 by which they differ where it is being tilted


class Tilting(NamedTuple):
    """Change of gravity's forward part: m/s^3, and m/s^2 per square root of s by which it may be wrong."""

    rate: float
    noise: float


class Inclination:
    """Follows gravity's part of the specific force in the base frame (forward, left, upward)."""

    def __init__(self) -> None:
        self.state = np.zeros(4)
        """Gravity's parts forward and left, and the biases of the accelerometer there [m/s^2]."""
        self._p = np.diag((STEEP, STEEP, BIAS, BIAS)) ** 2
        self._velocity, self._struck_for = np.zeros(2), 0.0
        self._gyro_bias, self._rested, self._stood_for = np.zeros(2), 0.0, 0.0
        self._means: tuple[Floats, Floats] | None = None

    def step(self, dt: float, rate: Floats, force: Floats, ways: WheelTravel) -> Tilting:
        """How gravity's forward part has changed in the last ``dt`` [s].

        rate: (3,) rad/s, force: (3,) m/s^2 in the middle of the axle, both in the base frame; ways: what the wheels have rolled.
        """
        self._rest(dt, rate, force, not any(ways))
        tilting = self._turn(dt, rate)
        velocity = np.array(((ways.left + ways.right) / (2.0 * dt), ways.aside / dt))
        accelerated = (velocity - self._velocity) / dt + rate[2] * np.array((-velocity[1], velocity[0]))
        self._velocity = velocity
        self._feel(dt, force[:2] - accelerated)
        return tilting

    @property
    def vertical(self) -> tuple[float, float]:
        """Forward and left parts of the unit vector upward, base frame; zero on ground that may be level, and while it is not known."""
        ahead, aside = np.clip(self.state[:2] / GRAVITY, -STEEPEST, STEEPEST).tolist()
        known = float(self._p[0, 0] + self._p[1, 1]) < KNOWN**2
        return (ahead, aside) if known and hypot(ahead, aside) > LEVEL else (0.0, 0.0)

    @property
    def tilt(self) -> tuple[float, float]:
        """Roll and pitch [rad] about the forward and left axes: pitch is positive nose down."""
        ahead, aside = self.vertical
        return asin(aside / sqrt(1.0 - ahead * ahead)), -asin(ahead)

    def climbed(self, ways: WheelTravel) -> float:
        """Height [m] gained on what the wheels have rolled."""
        ahead, aside = self.vertical
        return ahead * (ways.left + ways.right) / 2 + aside * ways.aside

    def seen_from_above(self, ways: WheelTravel, rate: Floats) -> tuple[WheelTravel, float]:
        """Travel of the wheels and turning [rad/s] as they are from above, where the vehicle drives on a slope.

        rate: (3,) rad/s, base frame. With the vertical (a, b, c) in the base frame a way is shorter by sqrt(1 - a^2), and the heading
        turns at (q b + r c) / (1 - a^2) (Beard and McLain, Small Unmanned Aircraft, eq. 3.3).
        """
        ahead, aside = np.clip(self.state[:2] / GRAVITY, -STEEPEST, STEEPEST).tolist()
        level = 1.0 - ahead * ahead
        upward = sqrt(max(level - aside * aside, 0.0))
        shorter = sqrt(level)
        turning = (float(rate[1]) * aside + float(rate[2]) * upward) / level
        return WheelTravel(ways.left * shorter, ways.right * shorter, ways.aside * sqrt(1.0 - aside * aside)), turning

    def _rest(self, dt: float, rate: Floats, force: Floats, stands: bool) -> None:
        """Learns the gyroscope's biases while the vehicle stands and is not tilted: what is felt stays the same.

        A vehicle that stops rocks on its castors for a moment, which a short stop must not take for a bias.
        """
        self._stood_for = self._stood_for + dt if stands else 0.0
        if not stands:
            self._means = None
            return
        fast, slow = self._means or (force[:2], force[:2])
        fast, slow = fast + (force[:2] - fast) * min(dt / FAST, 1.0), slow + (force[:2] - slow) * min(dt / SLOW, 1.0)
        self._means = fast, slow
        if self._stood_for >= SETTLED and np.abs(fast - slow).max() < STEADY:
            self._rested = min(self._rested + dt, KEPT)
            self._gyro_bias += (rate[:2] - self._gyro_bias) * min(dt / self._rested, 1.0)

    def _begin_anew(self) -> None:
        """Nothing is known of the slope."""
        self.state[:2] = 0.0
        self._p[:2, :] = self._p[:, :2] = 0.0
        self._p[0, 0] = self._p[1, 1] = STEEP**2
        self._struck_for = 0.0

    def _turn(self, dt: float, rate: Floats) -> Tilting:
        """Gravity turns against the vehicle: by yaw, and by roll and pitch, which are small."""
        rolling, pitching = (rate[:2] - self._gyro_bias).tolist()
        yaw, before, left = float(rate[2]) * dt, float(self.state[0]), float(self._p[1, 1])
        f = np.eye(4)
        f[:2, :2] = ((cos(yaw), sin(yaw)), (-sin(yaw), cos(yaw)))
        self.state = f @ self.state + GRAVITY * dt * np.array((-pitching, rolling, 0.0, 0.0))
        self._p = f @ self._p @ f.T + np.diag((SHAKEN, SHAKEN, BIAS_WALK, BIAS_WALK)) ** 2 * dt
        return Tilting((float(self.state[0]) - before) / dt, sqrt(left * abs(float(rate[2]))))

    def _feel(self, dt: float, felt: Floats) -> None:
        h = np.hstack((np.eye(2), np.eye(2)))
        if float(np.hypot(self.state[0], self.state[1])) > GRAVITY or self._struck_for > BLOW:
            self._begin_anew()
        off = felt - h @ self.state
        s = h @ self._p @ h.T + FELT**2 * np.eye(2)
        if np.abs(off).max() > STRUCK and np.abs(off).max() > 3.0 * sqrt(float(s[0, 0])):
            self._struck_for += dt
            return
        self._struck_for = 0.0
        gain = np.linalg.solve(s, h @ self._p).T
        self.state = self.state + gain @ off
        self._p = self._p - gain @ h @ self._p
        self._p = (self._p + self._p.T) / 2
