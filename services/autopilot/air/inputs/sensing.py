"""From what the instruments say to an estimate: each fix once, none of a receiver that has frozen, pressures as far as believed."""

import math
from collections.abc import Callable, Sequence
from typing import Literal, NamedTuple

from schemas.messages import AirData, Gnss, NavState, Range
from services.autopilot.air.inputs import intake
from uvf.estimation.air_data_check import FlightState, Frozen
from uvf.estimation.estimators import Instruments, estimator
from uvf.estimation.mount import ImuMount
from uvf.estimation.sensor_inputs import GnssFix, InertialSample, Pressures, Sensed
from uvf.estimation.state import Estimate
from uvf.maths.filters import LowPass
from uvf.maths.geodesy import GRAVITY, LocalTangent
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.messages.convert import seconds

SAME_FIXES = 4  # that are the same to the last bit: the receiver has frozen
FIRST_FIX = 1.0  # s, waited for after a restart

Believe = Callable[[tuple[object, Pressures] | None, FlightState | None, AirParams, float], Pressures | None]
"""The pressures (with their stamp) as far as they can be believed in this flight, given the cycle's dt [s]."""


class SensorInputs(NamedTuple):
    """In one cycle."""

    imu: list[InertialSample]
    air_data: AirData | None
    gnss: Gnss | None
    airborne: bool


class StateEstimation:
    """``felt``: by the IMU in this cycle, in the body's axes; ``accuracy``: m, of the last fix; ``field``: T, of the magnetic field."""

    def __init__(self, instruments: Instruments, tangent: LocalTangent, kind: Literal["full", "book"], believe: Believe) -> None:
        """kind: of the estimator."""
        self.felt: list[InertialSample] = []
        self.accuracy = 0.0
        self.field = 0.0
        self._estimator = estimator(kind, instruments)
        self._mount = ImuMount(instruments.imu_xyz, instruments.imu_rpy)
        self._period = 1 / instruments.sheet.imu_hz
        self._tangent = tangent
        self._believe = believe
        self._fix_stamp = 0
        self._same_fix = Frozen()
        self._left: NavState | None = None
        self._waited = 0.0  # s, for the first fix
        self._estimated = 0.0  # s
        self._now: Estimate | None = None

    @property
    def gnss_age(self) -> float:
        """Time [s] since the last fix."""
        return self._estimator.gnss_age

    def begin_from(self, left: NavState) -> None:
        """What the instance before has estimated last."""
        self._left = left
        self._estimator.begin_at(*intake.attitude(left))

    def step(self, t: float, said: SensorInputs, params: AirParams, dt: float) -> Estimate | None:
        """The estimate of this cycle at ``t`` [s], ``dt`` [s] after the one before; None until the first fix."""
        fix = self._new_fix(t, said) if said.gnss is not None else None
        if fix is None and not self._estimator.started:
            fix = self._left_fix(t, dt)
            if fix is None:
                return None
        samples = self.felt = [self._mount.at_centre(sample, self._period) for sample in said.imu]
        passed = t - self._estimated if self._estimator.started else dt
        self._estimated = t
        flying = FlightState(self._now, self.gnss_age, said.airborne) if self._now is not None else None
        pressures = self._believe(_stamped(said.air_data, t), flying, params, dt)
        self.field = math.hypot(*samples[-1].field) if samples else self.field
        self._now = self._estimator.step(Sensed(samples, pressures, fix), params, passed)
        return self._now

    def _left_fix(self, t: float, dt: float) -> GnssFix | None:
        """After a restart without GNSS: where the instance before has been, once a fix has been waited for."""
        self._waited += dt
        return intake.left_fix(self._left, t) if self._left is not None and self._waited > FIRST_FIX else None

    def _new_fix(self, t: float, said: SensorInputs) -> GnssFix | None:
        gnss = said.gnss
        assert gnss is not None
        stamp_ns = gnss.timestamp.ToNanoseconds()
        is_new, self._fix_stamp = stamp_ns != self._fix_stamp, stamp_ns
        if not is_new:
            return None
        self.accuracy = gnss.horizontal_accuracy
        frozen = self._same_fix.same((gnss.latitude, gnss.longitude, gnss.altitude), SAME_FIXES)
        return intake.fix(gnss, self._tangent, t) if not (frozen and said.airborne) else None


def _stamped(air_data: AirData | None, t: float) -> tuple[object, Pressures] | None:
    if air_data is None or (read := intake.pressures(air_data, t)) is None:
        return None
    return air_data.timestamp.ToNanoseconds(), read


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
        """Takes the range finders' readings and the IMU's samples of this cycle of ``dt`` [s]."""
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
