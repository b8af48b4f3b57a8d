"""Instruments that every vehicle may carry: what they make of the truth. When and whether a reading gets out is ``sampling``'s part."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.geodesy import LocalTangent
from uvf.sensors.errors import Channel, Errors
from uvf.sensors.sampling import Due

Floats = NDArray[np.float64]


class ImuReading(NamedTuple):
    """A reading valid for ``t`` [s], (3,) each, sensor frame.

    Angular velocity [rad/s], specific force [m/s^2] (at rest +g upwards), magnetic field [T].
    """

    t: float
    angular_velocity: Floats
    specific_force: Floats
    magnetic_field: Floats


class InertialUnit:
    """Gyroscopes, accelerometers and a magnetometer that may be slower: between its readings the last one is repeated."""

    def __init__(self, gyro: Errors, accel: Errors, mag: Errors, mag_hz: float, rng: np.random.Generator) -> None:
        self._gyro, self._accel, self._mag = (Channel(e, 3, r) for e, r in zip((gyro, accel, mag), rng.spawn(3), strict=True))
        self._mag_due = Due(mag_hz)
        self._field = np.zeros(3)
        self.t = 0.0
        """s, of the newest reading."""

    def read(self, t: float, angular_velocity: Floats, specific_force: Floats, magnetic_field: Floats) -> ImuReading:
        """Reading at ``t`` [s] of true angular velocity [rad/s], specific force [m/s^2], magnetic field [T]: (3,) each, sensor frame."""
        dt, self.t = t - self.t, t
        if self._mag_due.at(t):
            self._field = self._mag.read(magnetic_field, dt)
        return ImuReading(t, self._gyro.read(angular_velocity, dt), self._accel.read(specific_force, dt), self._field)


class ReceiverFix(NamedTuple):
    """A fix valid for ``t`` [s]: latitude, longitude [rad], altitude [m AMSL], and velocity (3,) [m/s, ENU]."""

    t: float
    latitude: float
    longitude: float
    altitude: float
    velocity: Floats


class Receiver:
    """A satellite receiver (Beard & McLain 2012, section 7.5)."""

    def __init__(self, position: Errors, velocity: Errors, tangent: LocalTangent, rng: np.random.Generator) -> None:
        """Errors in m and m/s, ENU; tangent: the plane of the world's origin."""
        self._position, self._velocity = (Channel(e, 3, r) for e, r in zip((position, velocity), rng.spawn(2), strict=True))
        self._tangent = tangent
        self._t = 0.0

    def read(self, t: float, position: Floats, velocity: Floats) -> ReceiverFix:
        """Fix at ``t`` [s] of the true position (3,) [m, ENU] and velocity (3,) [m/s, ENU]."""
        dt, self._t = t - self._t, t
        measured = self._position.read(position, dt)
        return ReceiverFix(t, *self._tangent.geodetic(measured), self._velocity.read(velocity, dt))
