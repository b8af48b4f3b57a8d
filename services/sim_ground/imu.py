"""The inertial unit: specific force, angular rate and magnetic field at its mount, with white noise and a constant bias."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.body import BodyState
from uvf.maths.geodesy import GRAVITY
from uvf.maths.kinematics import spin_velocity
from uvf.maths.rotations import from_euler, inverse, multiply, rotate
from uvf.runtime.vehicle_file import ImuSensor

Floats = NDArray[np.float64]
UP = np.array((0.0, 0.0, GRAVITY))


class ImuReading(NamedTuple):
    """(3,) each, sensor frame: rad/s, m/s^2 (at rest +g upwards), T."""

    angular_velocity: Floats
    specific_force: Floats
    magnetic_field: Floats


class ImuModel:
    """One unit. The specific force is the mean over the time since the reading before: the change of velocity, less gravity."""

    def __init__(self, imu: ImuSensor, magnetic_field: Floats, rng: np.random.Generator) -> None:
        self._imu = imu
        self._field = magnetic_field
        self._rng = rng
        self._body_from_sensor = from_euler(*imu.mount.rpy)
        self._arm = np.array(imu.mount.xyz)
        self._gyro_bias = rng.normal(0.0, imu.gyro_bias, 3)
        self._accel_bias = rng.normal(0.0, imu.accel_bias, 3)
        self._velocity = np.zeros(3)

    def read(self, body: BodyState, dt: float) -> ImuReading:
        """The reading at the end of ``dt`` [s]. Biases are constant; the vehicle starts at rest."""
        imu, rng = self._imu, self._rng
        velocity = body.velocity + rotate(body.world_from_body, spin_velocity(body.angular_velocity, self._arm))
        acceleration, self._velocity = (velocity - self._velocity) / dt, velocity
        sensor_from_body = inverse(self._body_from_sensor)
        sensor_from_world = inverse(multiply(body.world_from_body, self._body_from_sensor))
        return ImuReading(
            rotate(sensor_from_body, body.angular_velocity) + self._gyro_bias + rng.normal(0.0, imu.gyro_noise, 3),
            rotate(sensor_from_world, acceleration + UP) + self._accel_bias + rng.normal(0.0, imu.accel_noise, 3),
            rotate(sensor_from_world, self._field) + rng.normal(0.0, imu.mag_noise, 3),
        )
