"""How much an accelerometer shakes, after ArduPilot's ``AP_InertialSensor::calc_vibration_and_clipping``."""

import math

import numpy as np

from schemas.messages import Imu
from uvf.maths.geodesy import Floats
from uvf.runtime.messages.convert import array, seconds

FLOOR = 1 / (2 * math.pi * 5.0)  # s, time constant of 5 Hz: what is slower is motion
MEAN = 1 / (2 * math.pi * 2.0)  # s, of 2 Hz, over which the rest is squared and averaged


class Vibration:
    """Vibration of the specific force and clipped samples. limit: range of the accelerometer [m/s^2]."""

    def __init__(self, limit: float = math.inf) -> None:
        self.clipped = 0
        self._limit = limit
        self._slow: Floats | None = None
        self._mean_square: Floats = np.zeros(3)
        self._at = 0.0

    @property
    def level(self) -> Floats:
        """Vibration (3,) [m/s^2, sensor axes], root mean square."""
        return np.sqrt(self._mean_square)

    def hear(self, imu: Imu) -> None:
        """Takes one sample; a repeated or non-finite one changes nothing."""
        at, force = seconds(imu.timestamp), array(imu.specific_force)
        dt = at - self._at
        if self._slow is None or dt < 0:
            self._slow, self._at = force, at
        if dt <= 0 or not np.isfinite(force).all():
            return
        self._at = at
        self._slow = self._slow + dt / (FLOOR + dt) * (force - self._slow)
        self._mean_square = self._mean_square + dt / (MEAN + dt) * ((force - self._slow) ** 2 - self._mean_square)
        self.clipped += int((np.abs(force) >= self._limit).any())
