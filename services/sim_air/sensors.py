"""What an aircraft's sensors would read: truth, their own errors, rate, losses and latency."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from services.sim_air.engine.states import Air, AircraftMotion
from uvf.maths import rotations
from uvf.maths.geodesy import LocalTangent
from uvf.models.vehicle.sensors import AirDataSensor, GnssSensor, ImuSensor
from uvf.sensors.errors import Channel, Errors
from uvf.sensors.fitted import inertial_unit, line_of, receiver
from uvf.sensors.instruments import ImuReading, ReceiverFix
from uvf.sensors.sampling import DelayLine

Floats = rotations.Floats


class Imu:
    """An IMU at its mount; away from the centre of gravity it measures the rotation's accelerations too."""

    def __init__(self, data: ImuSensor, field: Floats, rng: np.random.Generator) -> None:
        """``field`` is the magnetic field, (3,) T, ENU."""
        self.frame = data.frame
        self._line: DelayLine[ImuReading] = line_of(data, rng.spawn(1)[0])
        self._unit = inertial_unit(data, rng)
        self._arm = np.array(data.mount.xyz)
        self._is_off_centre = bool(self._arm.any())
        self._sensor_from_body = rotations.matrix(rotations.from_euler(*data.mount.rpy)).T
        self._field_enu = field

    def read(self, t: float, motion: AircraftMotion) -> ImuReading | None:
        """The reading that arrives at ``t`` [s], if any."""
        return self._line.step(t, lambda: self._take(t, motion))

    def _take(self, t: float, motion: AircraftMotion) -> ImuReading:
        field_body = rotations.matrix(motion.world_from_body).T @ self._field_enu
        turning = motion.angular_velocity
        force = motion.specific_force
        if self._is_off_centre:
            force = force + np.cross(motion.angular_acceleration, self._arm) + np.cross(turning, np.cross(turning, self._arm))
        return self._unit.read(t, *(self._sensor_from_body @ v for v in (turning, force, field_body)))


class Gnss:
    """A fix arrives ``latency`` after the moment it is valid for."""

    def __init__(self, data: GnssSensor, tangent: LocalTangent, rng: np.random.Generator) -> None:
        self.data = data
        self._line: DelayLine[ReceiverFix] = line_of(data, rng.spawn(1)[0])
        self._receiver = receiver(data, tangent, rng)

    def read(self, t: float, motion: AircraftMotion) -> ReceiverFix | None:
        """The fix that arrives at ``t`` [s], if any."""
        return self._line.step(t, lambda: self._receiver.read(t, motion.position, motion.velocity))


class AirSample(NamedTuple):
    """A reading valid for ``t`` [s]."""

    t: float
    air: Air


class PressureSensors:
    """Static and pitot pressure with constant biases and white noise."""

    def __init__(self, data: AirDataSensor, rng: np.random.Generator) -> None:
        self._line: DelayLine[AirSample] = line_of(data, rng.spawn(1)[0])
        bias = np.array((data.static_bias, data.differential_bias))
        self._channel = Channel(Errors(noise=np.array((data.static_noise, data.differential_noise)), bias=bias), 2, rng)

    def read(self, t: float, air: Callable[[], Air]) -> AirSample | None:
        """The reading that arrives at ``t`` [s], if any; ``air`` is asked when one is due."""
        return self._line.step(t, lambda: self._take(t, air()))

    def _take(self, t: float, air: Air) -> AirSample:
        static, differential = self._channel.read(np.array((air.static_pressure, air.differential_pressure)), 0.0)
        return AirSample(t, Air(float(static), float(differential), air.temperature))
