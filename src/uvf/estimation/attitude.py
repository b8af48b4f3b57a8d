"""Roll and pitch from gyroscopes, held to the vertical by the accelerometers.

Extended Kalman filter of two states after Beard & McLain 8.6. The accelerometers measure f = v' + w x v - g (8.5); with v
along the relative wind (angle of attack alpha, no sideslip) and v' small in the mean, g = w x v - f gives roll and pitch.
"""

import math
from dataclasses import dataclass

PROCESS = 1.0e-6  # rad^2/s: gyroscope noise and scale
TILT_SIGMA = 0.06  # rad: 0.6 m/s^2 of acceleration along the path, unknown in a single sample
BIAS_RATE = 0.02  # 1/s: how much of a correction goes into the gyroscopes' bias
BIAS_STEP = 2e-4  # rad: larger corrections come of a wrong start or an acceleration along the path, not of a bias


@dataclass(slots=True)
class AttitudeFilter:
    """Roll and pitch [rad], their covariance p00, p01, p11 [rad^2], and the bias [rad/s] of the roll and pitch gyroscopes."""

    roll: float = 0.0
    pitch: float = 0.0
    p00: float = 0.001
    p01: float = 0.0
    p11: float = 0.001
    bias_p: float = 0.0
    bias_q: float = 0.0

    def start(self, force: tuple[float, float, float]) -> None:
        """Starts from level flight without acceleration, where the specific force [m/s^2, FRD] is minus gravity."""
        fx, fy, fz = force
        self.roll, self.pitch = math.atan2(-fy, -fz), math.atan2(fx, math.hypot(fy, fz))

    def predict(self, rates: tuple[float, float, float], dt: float) -> None:
        """Propagates the Euler angles (3.3) over ``dt`` [s] with body rates [rad/s, FRD]."""
        p, q, r = rates[0] - self.bias_p, rates[1] - self.bias_q, rates[2]
        s, c, tan = math.sin(self.roll), math.cos(self.roll), math.tan(self.pitch)
        a00, a01 = (q * c - r * s) * tan, (q * s + r * c) * (1 + tan * tan)
        a10 = -(q * s + r * c)
        self.roll += dt * (p + (q * s + r * c) * tan)
        self.pitch += dt * (q * c - r * s)
        p00, p01, p11 = self.p00, self.p01, self.p11
        self.p00 += dt * (2 * (a00 * p00 + a01 * p01) + PROCESS)
        self.p01 += dt * (a00 * p01 + a01 * p11 + a10 * p00)
        self.p11 += dt * (2 * a10 * p01 + PROCESS)

    def ahead(self, rates: tuple[float, float, float], age: float) -> tuple[float, float]:
        """Roll and pitch [rad] now, ``age`` [s] after the last sample, turning on at ``rates``."""
        p, q, r = rates[0] - self.bias_p, rates[1] - self.bias_q, rates[2]
        s, c = math.sin(self.roll), math.cos(self.roll)
        return self.roll + age * (p + (q * s + r * c) * math.tan(self.pitch)), self.pitch + age * (q * c - r * s)

    def correct(self, gravity: tuple[float, float, float], dt: float) -> None:
        """Corrects roll and pitch by gravity [m/s^2, FRD] as the accelerometers show it: two scalar updates; ``dt`` [s] is not used."""
        gx, gy, gz = gravity
        roll_error = math.remainder(math.atan2(gy, gz) - self.roll, math.tau)
        k0, k1 = self._gains(self.p00, self.p01)
        self._add(k0 * roll_error, k1 * roll_error, dt)
        self.p00, self.p01, self.p11 = (1 - k0) * self.p00, (1 - k0) * self.p01, self.p11 - k1 * self.p01
        pitch_error = math.atan2(-gx, math.hypot(gy, gz)) - self.pitch
        k1, k0 = self._gains(self.p11, self.p01)
        self._add(k0 * pitch_error, k1 * pitch_error, dt)
        self.p00, self.p01, self.p11 = self.p00 - k0 * self.p01, (1 - k1) * self.p01, (1 - k1) * self.p11

    @staticmethod
    def _gains(own: float, cross: float) -> tuple[float, float]:
        s = own + TILT_SIGMA * TILT_SIGMA
        return own / s, cross / s

    def _add(self, roll: float, pitch: float, dt: float) -> None:
        self.roll += roll
        self.pitch += pitch
        self.bias_p -= BIAS_RATE * min(max(roll, -BIAS_STEP), BIAS_STEP)
        self.bias_q -= BIAS_RATE * min(max(pitch, -BIAS_STEP), BIAS_STEP)
