"""An IMU that sits askew or away from the centre of gravity, read as if it sat straight in it."""

from dataclasses import replace

import numpy as np

from uvf.estimation.sensor_inputs import InertialSample, Triple
from uvf.maths.rotations import FLU_FROM_FRD, Floats, from_euler, matrix

DERIVATIVE_TIME = 0.03  # s, over which the turn rates are differentiated


class ImuMount:
    """Lever arm and orientation of one IMU, which is fed with its samples in order."""

    def __init__(self, xyz: Triple = (0.0, 0.0, 0.0), rpy: Triple = (0.0, 0.0, 0.0)) -> None:
        """Pose in base_link, FLU: m, rad."""
        self._body_from_sensor: Floats | None = FLU_FROM_FRD @ matrix(from_euler(*rpy)) @ FLU_FROM_FRD if any(rpy) else None
        self._arm: Floats | None = FLU_FROM_FRD @ np.array(xyz) if any(xyz) else None
        self._slow: Floats | None = None

    def at_centre(self, sample: InertialSample, dt: float) -> InertialSample:
        """The sample as at base_link's origin, in the body's axes (FRD), ``dt`` [s] after the last; a = a_sensor - w' x r - w x (w x r)."""
        if self._body_from_sensor is not None:
            rates, force, field = (_triple(self._body_from_sensor @ v) for v in (sample.rates, sample.force, sample.field))
            sample = replace(sample, rates=rates, force=force, field=field)
        if self._arm is None:
            return sample
        rates_now = np.array(sample.rates)
        slow = rates_now if self._slow is None else self._slow
        turning = (rates_now - slow) / DERIVATIVE_TIME
        self._slow = slow + min(dt / DERIVATIVE_TIME, 1.0) * (rates_now - slow)
        away = np.cross(turning, self._arm) + np.cross(rates_now, np.cross(rates_now, self._arm))
        return replace(sample, force=_triple(np.array(sample.force) - away))


def _triple(v: Floats) -> Triple:
    x, y, z = v.tolist()
    return x, y, z
