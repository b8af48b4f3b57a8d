"""What gyroscopes and accelerometers say of the motion, and what becomes of the errors meanwhile."""

import math
from dataclasses import dataclass, field

import numpy as np

from uvf.estimation.ekf.datasheet import Datasheet
from uvf.estimation.ekf.states import (
    ACCEL_BIAS,
    BARO,
    DRIFT,
    GYRO_BIAS,
    IRON,
    POSITION,
    SIZE,
    TILT,
    VELOCITY,
    FilterState,
    Floats,
    cross_matrix,
    turned,
)
from uvf.maths.geodesy import GRAVITY

FALL = np.array((0.0, 0.0, GRAVITY))


@dataclass(slots=True)
class Mechanisation:
    """Strapdown integration over flat ground by the trapezoidal rule; readings are of moments, not means.

    rates, force: (3,) FRD, the newest readings; rad/s, m/s^2. ``missed``: (25,) variance of what the trapezoids leave out, until it is
    taken: in gusts and in the first moment of a roll readings change between two samples by more than their noise.
    """

    rates: Floats
    force: Floats
    missed: Floats = field(default_factory=lambda: np.zeros(SIZE))

    def step(self, state: FilterState, rates: Floats, force: Floats, dt: float) -> Floats:
        """Moves the state on by ``dt`` [s] to the new readings; returns the mean acceleration (3,) [m/s^2], NED, with gravity.

        rates: (3,) [rad/s]; force: (3,) [m/s^2], specific force; FRD.
        """
        x = state.x
        turn = (0.5 * dt) * (self.rates + rates) - dt * x[GYRO_BIAS]
        before = state.rotation @ (self.force - x[ACCEL_BIAS])
        state.turn_to(state.attitude.times(turned(turn)))
        felt: Floats = 0.5 * (before + state.rotation @ (force - x[ACCEL_BIAS]))
        acceleration: Floats = felt + FALL
        x[POSITION] += dt * x[VELOCITY] + (0.5 * dt * dt) * acceleration
        x[VELOCITY] += dt * acceleration
        mixed = state.rotation**2 * (dt * dt / 12)
        self.missed[TILT] += mixed @ (rates - self.rates) ** 2
        self.missed[VELOCITY] += mixed @ (force - self.force) ** 2
        self.rates, self.force = rates, force
        return acceleration

    def take_missed(self) -> Floats:
        """Variance (25,) of what the trapezoids have left out since the last call.

        The integral of a Brownian motion between two values d apart, dt after each other, has a variance of d^2 dt^2 / 12 about the
        trapezoid.
        """
        missed, self.missed = self.missed, np.zeros(SIZE)
        return missed


def transition(state: FilterState, acceleration: Floats, drift_time: float, dt: float) -> Floats:
    """Transition matrix (25, 25) of the errors over ``dt`` [s].

    acceleration: (3,) [m/s^2], NED, of the motion; drift_time: [s], time constant of the satellites' drift.
    """
    f = np.eye(SIZE)
    force = cross_matrix(acceleration - FALL)
    rotation = state.rotation
    f[TILT, GYRO_BIAS] = -dt * rotation
    f[VELOCITY, TILT] = -dt * force
    f[VELOCITY, ACCEL_BIAS] = -dt * rotation
    f[POSITION, TILT] = (-0.5 * dt * dt) * force
    f[POSITION, ACCEL_BIAS] = (-0.5 * dt * dt) * rotation
    f[6, 3] = f[7, 4] = f[8, 5] = dt
    f[22, 22] = f[23, 23] = f[24, 24] = math.exp(-dt / drift_time)
    return f


def process_noise(sheet: Datasheet, imu_dt: float) -> Floats:
    """Variance (25,) that each state gains in a second; imu_dt: [s] between samples."""
    q = np.zeros(SIZE)
    q[TILT] = sheet.gyro_noise**2 * imu_dt
    q[VELOCITY] = sheet.accel_noise**2 * imu_dt
    q[GYRO_BIAS] = sheet.gyro_walk**2
    q[ACCEL_BIAS] = sheet.accel_walk**2
    q[IRON] = sheet.iron_walk**2
    q[BARO] = sheet.baro_walk**2
    q[DRIFT] = 2 * np.array((sheet.drift, sheet.drift, sheet.height_drift)) ** 2 / sheet.drift_time
    return q
