"""What an aircraft's sensors would read: truth, their own errors, rate and latency."""

import math
from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from services.sim_air.airframe import Air, Motion
from uvf.maths import rotations
from uvf.maths.geodesy import LocalTangent
from uvf.runtime.vehicle_file import AirDataSensor, BatteryPack, GnssSensor, ImuSensor

Floats = rotations.Floats


class Due:
    """Whether a sensor of ``hz`` gives a new sample at time t."""

    def __init__(self, hz: float) -> None:
        self._hz = hz
        self._n = 0

    def at(self, t: float) -> bool:
        if t * self._hz < self._n + 1 - 1e-6:
            return False
        self._n = math.floor(t * self._hz + 1e-6)
        return True


class ImuSample(NamedTuple):
    """Sensor frame (FLU): rad/s, m/s^2, T."""

    angular_velocity: Floats
    specific_force: Floats
    magnetic_field: Floats


class Imu:
    """Constant biases drawn once, white noise on each sample; at the centre of gravity."""

    def __init__(self, data: ImuSensor, field: Floats, rng: np.random.Generator) -> None:
        """``field`` is the magnetic field, (3,) T, ENU."""
        self.frame = data.frame
        self.due = Due(data.hz)
        self._rng = rng
        self._sensor_from_body = rotations.matrix(rotations.from_euler(*data.mount.rpy)).T
        self._field_enu = field
        self._bias = np.concatenate((rng.normal(0.0, data.gyro_bias, 3), rng.normal(0.0, data.accel_bias, 3), np.zeros(3)))
        self._noise = np.repeat((data.gyro_noise, data.accel_noise, data.mag_noise), 3)

    def read(self, motion: Motion) -> ImuSample:
        field_body = rotations.matrix(motion.world_from_body).T @ self._field_enu
        true = self._sensor_from_body @ np.array((motion.angular_velocity, motion.specific_force, field_body)).T
        read = true.T.ravel() + self._bias + self._noise * self._rng.standard_normal(9)
        return ImuSample(read[:3], read[3:6], read[6:])


@dataclass(frozen=True)
class Fix:
    """One satellite fix: rad, rad, m AMSL, m/s ENU, valid at ``t`` [s]."""

    t: float
    latitude: float
    longitude: float
    altitude: float
    velocity: Floats


class Gnss:
    """White noise on position and velocity; a fix arrives ``latency`` after the moment it is valid for."""

    def __init__(self, data: GnssSensor, tangent: LocalTangent, rng: np.random.Generator) -> None:
        self.data = data
        self._due = Due(data.hz)
        self._tangent = tangent
        self._rng = rng
        self._on_the_way: deque[Fix] = deque()
        self._position_noise = np.array((data.horizontal_noise, data.horizontal_noise, data.vertical_noise))

    def read(self, t: float, motion: Motion) -> Fix | None:
        """The fix that arrives now, if any."""
        if self._due.at(t):
            position = motion.position + self._position_noise * self._rng.standard_normal(3)
            velocity = motion.velocity + self.data.speed_noise * self._rng.standard_normal(3)
            self._on_the_way.append(Fix(t, *self._tangent.geodetic(position), velocity))
        if self._on_the_way and t >= self._on_the_way[0].t + self.data.latency - 1e-6:
            return self._on_the_way.popleft()
        return None


class Pressures:
    """Static and pitot pressure with constant biases and white noise."""

    def __init__(self, data: AirDataSensor, rng: np.random.Generator) -> None:
        self.due = Due(data.hz)
        self._rng = rng
        self._bias = rng.standard_normal(2) * (data.static_bias, data.differential_bias)
        self._noise = np.array((data.static_noise, data.differential_noise))

    def read(self, air: Air) -> Air:
        static, differential = self._bias + self._noise * self._rng.standard_normal(2)
        return Air(air.static_pressure + float(static), air.differential_pressure + float(differential), air.temperature)


class Charge:
    """Counts the energy drawn; the voltage falls in a straight line with the charge."""

    EFFICIENCY = 0.85
    """Of motor and speed controller together, shaft over electric power."""

    def __init__(self, pack: BatteryPack) -> None:
        self._pack = pack
        self._left = pack.energy  # J
        self.current = 0.0  # A

    def draw(self, shaft_power: float, dt: float) -> None:
        """``shaft_power`` [W] over ``dt`` [s]."""
        power = shaft_power / self.EFFICIENCY + self._pack.avionics
        self._left = max(self._left - power * dt, 0.0)
        self.current = power / self.voltage

    @property
    def remaining(self) -> float:
        """0..1."""
        return self._left / self._pack.energy

    @property
    def voltage(self) -> float:
        """V."""
        return self._pack.empty + (self._pack.full - self._pack.empty) * self.remaining
