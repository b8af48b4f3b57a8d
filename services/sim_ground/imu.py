"""The inertial unit: specific force, angular rate and magnetic field at its mount."""

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.body import BodyState
from uvf.maths.compiled import compiled
from uvf.maths.geodesy import GRAVITY
from uvf.maths.rotations import from_euler
from uvf.models.vehicle.sensors import ImuSensor
from uvf.sensors.fitted import inertial_unit
from uvf.sensors.instruments import ImuReading

Floats = NDArray[np.float64]


@compiled
def _matrix(q: Floats) -> Floats:
    """As ``rotations.matrix``."""
    w, x, y, z = q
    return np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
    )


@compiled
def _times(m: Floats, v: Floats) -> Floats:
    """(3, 3) on (3,); without BLAS, which is slow on so small ones."""
    out = np.empty(3)
    for i in range(3):
        out[i] = m[i, 0] * v[0] + m[i, 1] * v[1] + m[i, 2] * v[2]
    return out


class ImuModel:
    """One IMU. The specific force is the mean since the reading before: change of velocity, less gravity."""

    def __init__(self, imu: ImuSensor, magnetic_field: Floats, rng: np.random.Generator) -> None:
        """magnetic_field: (3,) T, ENU."""
        self._field = magnetic_field
        self._body_from_sensor = from_euler(*imu.mount.rpy)
        self._arm = np.array(imu.mount.xyz)
        self._unit = inertial_unit(imu, rng)
        self._velocity = np.zeros(3)

    def read(self, t: float, body: BodyState) -> ImuReading:
        """The reading at ``t`` [s], later than the one before; at 0 the vehicle is at rest."""
        rate, force, field, self._velocity = felt(
            body.world_from_body,
            body.velocity,
            body.angular_velocity,
            self._arm,
            self._body_from_sensor,
            self._velocity,
            t - self._unit.t,
            self._field,
        )
        return self._unit.read(t, rate, force, field)


@compiled
def felt(
    world_from_body: Floats,
    body_velocity: Floats,
    turning: Floats,
    arm: Floats,
    body_from_sensor: Floats,
    velocity_before: Floats,
    dt: float,
    field: Floats,
) -> tuple[Floats, Floats, Floats, Floats]:
    """(3,) each: angular rate, specific force and magnetic field in the sensor's axes, and the mount's velocity, world.

    world_from_body, body_from_sensor: wxyz; body_velocity, velocity_before: m/s, world, of base_link and of the mount ``dt`` [s] ago;
    turning: rad/s, body; arm: m, mount in the body; field: T, world.
    """
    world_from, body_from = _matrix(world_from_body), _matrix(body_from_sensor)
    spin = np.array(
        (
            turning[1] * arm[2] - turning[2] * arm[1],
            turning[2] * arm[0] - turning[0] * arm[2],
            turning[0] * arm[1] - turning[1] * arm[0],
        )
    )
    velocity = body_velocity + _times(world_from, spin)
    force = (velocity - velocity_before) / dt
    force[2] += GRAVITY
    from_body = body_from.T
    from_world = world_from.T
    return _times(from_body, turning), _times(from_body, _times(from_world, force)), _times(from_body, _times(from_world, field)), velocity
