"""A fix corrects position and velocity at once; what guidance and control are told moves there softly.

Between fixes the motion is known by inertia, so nothing of it is late: only the correction is. Each fix otherwise is a step to the
course loop, and the surfaces would move with the noise of the receiver, some times a second. Heights are told as they are known: the
barometer keeps their steps small, and maps are drawn by them.
"""

import math

import numpy as np

from uvf.estimation.ekf.states import Floats

LOST = 1.0  # s without a fix, from where on a jump is expected
EACH = 0.5  # s, in which the correction of a fix is told
SOFTLY = 2.0  # s, after a loss
SETTLES = 3.0  # s
FARTHEST = 200.0  # m; beyond, it is somewhere else


class Fading:
    """What is held back of steps, forgotten with a time constant [s]."""

    def __init__(self, time_constant: float, size: int) -> None:
        self.value: Floats = np.zeros(size)
        self._time_constant = time_constant

    def step(self, dt: float) -> Floats:
        """What is still held back ``dt`` [s] later."""
        self.value = self.value * math.exp(-dt / self._time_constant)
        return self.value


class Handover:
    """Fades out the steps of position and velocity: what is still held back from guidance."""

    def __init__(self) -> None:
        self._lost = Fading(SOFTLY, 3)
        self._each = Fading(EACH, 4)  # north and east, of position and velocity
        self._settling = 0.0  # s, left in which fixes still change much

    @property
    def off(self) -> float:
        """Horizontal distance [m] that is still held back after a loss."""
        return math.hypot(self._lost.value[0], self._lost.value[1])

    def take(self, position: Floats, velocity: Floats, gnss_age: float) -> None:
        """Takes steps of position (3,) [m] and velocity (3,) [m/s], NED, each from the new one to the one before.

        gnss_age: [s] without a fix until this one; after a loss of satellites the position comes back more softly. Not held back
        beyond ``FARTHEST``.
        """
        if gnss_age > LOST:
            self._settling = SETTLES
        if math.hypot(position[0], position[1]) >= FARTHEST:
            return
        if self._settling > 0.0:
            self._lost.value = self._lost.value + position
        else:
            self._each.value = self._each.value + np.concatenate((position[:2], velocity[:2]))

    def step(self, dt: float) -> tuple[Floats, Floats]:
        """Offsets of position (3,) [m] and velocity (3,) [m/s], NED, to add ``dt`` [s] later."""
        self._settling -= dt
        north, east, v_north, v_east = self._each.step(dt).tolist()
        return self._lost.step(dt) + np.array((north, east, 0.0)), np.array((v_north, v_east, 0.0))
