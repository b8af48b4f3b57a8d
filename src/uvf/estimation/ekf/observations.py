"""What each sensor should read of a state, how that changes with the state's errors, and how noisy it is."""

import math

import numpy as np

from uvf.estimation.ekf.filter import Observation
from uvf.estimation.ekf.inertial import FALL
from uvf.estimation.ekf.states import (
    ACCEL_BIAS,
    BARO,
    DOWN,
    DRIFT,
    GYRO_BIAS,
    IRON,
    PITOT,
    SIZE,
    TILT,
    VELOCITY,
    WIND,
    FilterState,
    Floats,
    cross_matrix,
)


def _scalar(residual: float, row: Floats, variance: float) -> Observation:
    return Observation(np.array((residual,)), row[None, :], np.array((variance,)))


def place(residual: Floats, lag: float, sigma: float) -> Observation:
    """Horizontal satellite position. residual: (2,) [m], NED, at the fix, ``lag`` [s] before the state; sigma: [m]."""
    h = np.zeros((2, SIZE))
    h[0, 6] = h[1, 7] = 1.0
    h[0, 3] = h[1, 4] = -lag
    h[0, 22] = h[1, 23] = 1.0
    return Observation(residual, h, np.full(2, sigma**2))


def depth(residual: float, lag: float, sigma: float) -> Observation:
    """Satellite position, down. residual: [m], at the fix, ``lag`` [s] before the state; sigma: [m]."""
    h = np.zeros(SIZE)
    h[DOWN], h[5], h[DRIFT.stop - 1] = 1.0, -lag, 1.0
    return _scalar(residual, h, sigma**2)


def velocity(residual: Floats, state: FilterState, acceleration: Floats, lag: float, sigma: float) -> Observation:
    """Satellite velocity. residual: (3,) [m/s], NED, at the fix, ``lag`` [s] before the state; sigma: [m/s].

    acceleration: (3,) [m/s^2], NED; an error of tilt has meanwhile changed that of velocity.
    """
    h = np.zeros((3, SIZE))
    h[:, VELOCITY] = np.eye(3)
    h[:, TILT] = lag * cross_matrix(acceleration - FALL)
    h[:, ACCEL_BIAS] = lag * state.rotation
    return Observation(residual, h, np.full(3, sigma**2))


def height(residual: float, lag: float, sigma: float) -> Observation:
    """Barometric altitude. residual: [m], up, ``lag`` [s] before the state; sigma: [m]."""
    h = np.zeros(SIZE)
    h[DOWN], h[5], h[BARO] = -1.0, lag, 1.0
    return _scalar(residual, h, sigma**2)


def _airspeed_row(state: FilterState) -> tuple[float, Floats]:
    """m/s, and how it changes."""
    through = state.through_air
    speed = max(math.sqrt(float(through @ through)), 0.1)
    h = np.zeros(SIZE)
    h[VELOCITY] = through / speed
    h[WIND] = -through[:2] / speed
    return speed, h


def pitot(state: FilterState, pressure: float, density: float, variance: float) -> Observation:
    """Differential pressure [Pa] of air of ``density`` [kg/m^3]: half rho V squared plus the sensor's bias; variance: [Pa^2]."""
    speed, h = _airspeed_row(state)
    h *= density * speed
    h[PITOT] = 1.0
    return _scalar(pressure - 0.5 * density * speed**2 - state.x[PITOT], h, variance)


def airspeed(state: FilterState, speed: float, sigma: float) -> Observation:
    """True airspeed ``speed`` [m/s]; sigma: [m/s]."""
    known, h = _airspeed_row(state)
    return _scalar(speed - known, h, sigma**2)


def climb(state: FilterState, rate: float, sigma: float) -> Observation:
    """Climb rate [m/s], up; sigma: [m/s]."""
    h = np.zeros(SIZE)
    h[5] = -1.0
    return _scalar(rate + float(state.x[5]), h, sigma**2)


def slip(state: FilterState, aside: float, sigma: float) -> Observation:
    """Flow ``aside`` along the body's right axis [m/s], which is zero in coordinated flight; sigma: [m/s]."""
    through = state.through_air
    right = state.rotation[:, 1]
    h = np.zeros(SIZE)
    h[TILT] = np.cross(right, through)
    h[VELOCITY] = right
    h[WIND] = -right[:2]
    return _scalar(aside - float(right @ through), h, sigma**2)


def field(state: FilterState, read: Floats, earth: Floats, sigma: float) -> Observation:
    """Magnetic field ``read`` (3,), FRD; ``earth``: (3,), NED; both and sigma in the filter's unit [uT]."""
    h = np.zeros((3, SIZE))
    h[:, TILT] = state.rotation.T @ cross_matrix(earth)
    h[:, IRON] = np.eye(3)
    return Observation(read - state.rotation.T @ earth - state.x[IRON], h, np.full(3, sigma**2))


def rest(state: FilterState, sigma: float) -> Observation:
    """Standstill: no velocity; sigma: [m/s]."""
    h = np.zeros((3, SIZE))
    h[:, VELOCITY] = np.eye(3)
    return Observation(-state.x[VELOCITY], h, np.full(3, sigma**2))


def no_turning(state: FilterState, rates: Floats, sigma: float) -> Observation:
    """Standstill: the gyroscopes' rates (3,) [rad/s], FRD, are their bias; sigma: [rad/s]."""
    h = np.zeros((3, SIZE))
    h[:, GYRO_BIAS] = np.eye(3)
    return Observation(rates - state.x[GYRO_BIAS], h, np.full(3, sigma**2))
