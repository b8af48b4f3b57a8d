"""Whether the aircraft stands: what it then knows without any sensor is that it neither moves nor turns."""

import math

import numpy as np

from uvf.estimation.ekf.states import Floats

TURNS = 0.05  # rad/s
SHAKES = 0.4  # m/s^2, off the mean
MOVES = 1.0  # m/s
MEAN_TIME = 1.0  # s
SETTLES = 0.5  # s


class Standstill:
    """Detects that the aircraft stands; the first acceleration of a take-off, a catapult's too, ends it at once."""

    def __init__(self) -> None:
        self._force: Floats | None = None
        self._quiet = 0.0  # s

    @property
    def stands(self) -> bool:
        """Whether it has been quiet without speed for ``SETTLES`` seconds."""
        return self._quiet >= SETTLES

    def step(self, rates: Floats, force: Floats, speed: float, dt: float) -> None:
        """Takes a sample, ``dt`` [s] after the last.

        rates: (3,) [rad/s] without bias, and force: (3,) [m/s^2], FRD; speed: [m/s], the greatest over ground or through the air.
        """
        mean = self._force = force if self._force is None else self._force + min(dt / MEAN_TIME, 1.0) * (force - self._force)
        off = force - mean
        moves = speed > MOVES or np.abs(rates).max() > TURNS or math.sqrt(float(off @ off)) > SHAKES
        self._quiet = 0.0 if moves else self._quiet + dt
