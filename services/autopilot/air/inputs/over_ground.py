"""What is sensed of ground and launch: height of the wheels by a range finder that looks down, push by the accelerometers."""

import math
from collections.abc import Sequence

from schemas.messages import Range
from uvf.estimation.sensor_inputs import InertialSample
from uvf.estimation.state import Estimate
from uvf.maths.filters import LowPass
from uvf.maths.geodesy import GRAVITY
from uvf.runtime.messages.convert import seconds

OLDEST = 0.3  # s
STEEPEST = 0.7  # rad of bank or pitch, beyond which the beam says nothing of the height
PUSH_TIME, HEAVE_TIME = 0.05, 0.03  # s


class GroundProximity:
    """Holds on to the newest reading. ``frame``: of the range finder that looks down, empty without one."""

    def __init__(self, frame: str) -> None:
        self._frame = frame
        self._reading: Range | None = None
        self._push = LowPass(PUSH_TIME)
        self._heave = LowPass(HEAVE_TIME)
        self.specific_force_x = 0.0
        """m/s^2, specific force forwards."""
        self.specific_force_up = GRAVITY
        """m/s^2, specific force upwards."""

    def hear(self, ranges: Sequence[Range], samples: Sequence[InertialSample], dt: float) -> None:
        for reading in ranges:
            if reading.frame_id == self._frame:
                self._reading = reading
        for sample in samples:
            self.specific_force_x = self._push.step(sample.force[0], dt / len(samples))
            self.specific_force_up = self._heave.step(-sample.force[2], dt / len(samples))

    def clearance(self, t: float, now: Estimate, gear_height: float) -> float | None:
        """m, of the wheels over the ground below at ``t`` [s]; None without a fresh echo or when the beam looks aside."""
        reading = self._reading
        if reading is None or not reading.range > 0 or max(abs(now.roll), abs(now.pitch)) > STEEPEST:
            return None
        age = t - seconds(reading.timestamp)
        if not 0 <= age <= OLDEST:
            return None
        return reading.range * math.cos(now.roll) * math.cos(now.pitch) + now.climb * age - gear_height
