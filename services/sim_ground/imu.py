"""The inertial unit: specific force, angular rate and magnetic field at its mount."""

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.body import BodyState
from uvf.maths.geodesy import GRAVITY
from uvf.maths.instruments import ImuReading
from uvf.maths.kinematics import spin_velocity
from uvf.maths.rotations import from_euler, inverse, multiply, rotate
from uvf.runtime.vehicle_file import ImuSensor

Floats = NDArray[np.float64]
UP = np.array((0.0, 0.0, GRAVITY))


class ImuModel:
    """One unit. The specific force is the mean over the time since the reading before: the change of velocity, less gravity."""

    def __init__(self, imu: ImuSensor, magnetic_field: Floats, rng: np.random.Generator) -> None:
        """magnetic_field: (3,) T, ENU."""
        self._field = magnetic_field
        self._body_from_sensor = from_euler(*imu.mount.rpy)
        self._arm = np.array(imu.mount.xyz)
        self._unit = imu.unit(rng)
        self._velocity = np.zeros(3)

    def read(self, t: float, body: BodyState) -> ImuReading:
        """The reading at ``t`` [s], later than the one before; at 0 the vehicle is at rest."""
        velocity = body.velocity + rotate(body.world_from_body, spin_velocity(body.angular_velocity, self._arm))
        acceleration, self._velocity = (velocity - self._velocity) / (t - self._unit.t), velocity
        sensor_from_world = inverse(multiply(body.world_from_body, self._body_from_sensor))
        return self._unit.read(
            t,
            rotate(inverse(self._body_from_sensor), body.angular_velocity),
            rotate(sensor_from_world, acceleration + UP),
            rotate(sensor_from_world, self._field),
        )
