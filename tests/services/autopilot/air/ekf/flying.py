"""A fast kinematic flight with sensors as noisy as their data sheet says: the filter's own assumptions, made true."""

import math
from dataclasses import replace

import numpy as np

from uvf.estimation.ekf.alignment import attitude
from uvf.estimation.ekf.datasheet import Datasheet
from uvf.estimation.ekf.estimator import FullEstimator
from uvf.estimation.ekf.states import MAGNETIC
from uvf.estimation.sensor_inputs import GnssFix, InertialSample, Pressures, Sensed
from uvf.maths import atmosphere
from uvf.models.vehicle.flight_params import AirParams

EARTH = (25.2e-6, 1.8e-6, 38.9e-6)  # T, NED
G = np.array((0.0, 0.0, 9.80665))
DT = 0.02
SPEED = 25.0
STATIC_AT = 300.0  # m AMSL of the world's origin
SHEET = Datasheet(gyro_noise=0.0023, accel_noise=0.025, static_noise=0.3, pitot_noise=4.0, pitot_bias=1.0)
PARAMS = AirParams()
AGE = 0.1  # s, of a fix


class Flown:
    """Level flight with banks to both sides in a wind; attitude, velocity and position (NED) at any time are exact."""

    def __init__(self, wind=(3.0, -6.0), seed=0, sheet=SHEET):
        self.rng = np.random.default_rng(seed)
        self.wind = np.array((*wind, 0.0))
        self.sheet = sheet
        draw = self.rng.standard_normal
        self.gyro_bias, self.accel_bias = sheet.gyro_bias * draw(3), sheet.accel_bias * draw(3)
        self.iron, self.pitot_bias = sheet.iron * MAGNETIC * draw(3), sheet.pitot_bias * draw()
        self.k, self._yaw, self.position = 0, 0.3, np.array((10.0, -20.0, -60.0))
        self._rotation, self._velocity, self._matrix = self._at(0.0)
        self._past = []

    def bank(self, t):
        return 0.7 * math.sin(t / 7.0)

    def _at(self, t):
        """Attitude that has the nose along the flight through the air (no sideslip; no angle of attack), and velocity."""
        lies = attitude(self.bank(t), 0.0, self._yaw)
        m = lies.matrix()
        return lies, SPEED * np.array((math.cos(self._yaw), math.sin(self._yaw), 0.0)) + self.wind, m

    def imu(self, h=0.01):
        """The next sample."""
        t = (self.k + 1) * h
        v = self._velocity
        self._yaw += h * 9.80665 / SPEED * math.tan(self.bank(t - 0.5 * h))
        self._rotation, self._velocity, self._matrix = self._at(t)
        self.position = self.position + 0.5 * h * (v + self._velocity)
        self.k += 1
        self._past.append((t, self._velocity, self.position))
        yaw_rate = 9.80665 / SPEED * math.tan(self.bank(t))
        roll_rate = 0.1 * math.cos(t / 7.0)
        s, c = math.sin(self.bank(t)), math.cos(self.bank(t))
        rates = np.array((roll_rate, yaw_rate * s, yaw_rate * c))
        along = np.array((-math.sin(self._yaw), math.cos(self._yaw), 0.0))
        force = self._matrix.T @ (SPEED * yaw_rate * along - G)
        field = self._matrix.T @ np.array(EARTH)
        n, sheet = self.rng.standard_normal, self.sheet
        return InertialSample(
            tuple(rates + self.gyro_bias + sheet.gyro_noise * n(3)),
            tuple(force + self.accel_bias + sheet.accel_noise * n(3)),
            tuple(field + self.iron + sheet.mag_noise * MAGNETIC * n(3)),
        )

    def sensed(self, fixed=True, **without):
        samples = [replace(self.imu(), age=0.01), self.imu()]
        static = atmosphere.pressure(STATIC_AT - self.position[2])
        rho = atmosphere.density(static, 285.8)
        n, sheet = self.rng.standard_normal, self.sheet
        metre = 0.5 * (atmosphere.pressure(STATIC_AT - self.position[2] - 1) - atmosphere.pressure(STATIC_AT - self.position[2] + 1))
        pressures = Pressures(
            static + metre * sheet.static_noise * n(), 0.5 * rho * SPEED**2 + self.pitot_bias + sheet.pitot_noise * n(), 285.8
        )
        fix = self._fix() if fixed and self.k % 20 == 0 and len(self._past) > 12 else None
        return replace(Sensed(samples, pressures, fix), **without)

    def _fix(self):
        _, v, p = self._past[-11]
        n = self.rng.standard_normal
        (north, east, down), (vn, ve, vd) = p + (0.3, 0.3, 0.5) * n(3), v + 0.05 * n(3)
        return GnssFix(north, east, -down, vn, ve, -vd, AGE, 0.3, 0.5, 0.05)

    def errors(self, estimator):
        """(25,) state errors: true less estimated; attitude as a rotation vector in NED."""
        state = estimator._aiding.filter.state
        error = np.zeros(25)
        turn = self._matrix @ state.rotation.T
        error[:3] = 0.5 * np.array((turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]))
        error[3:6], error[6:9] = self._velocity - state.x[3:6], self.position - state.x[6:9]
        error[9:12], error[12:15] = self.gyro_bias - state.x[9:12], self.accel_bias - state.x[12:15]
        error[15:18], error[18:20] = self.iron / MAGNETIC - state.x[15:18], self.wind[:2] - state.x[18:20]
        return error


def fly(flown, seconds, each=None, estimator=None, **asked):
    """The estimator after ``seconds`` [s]; ``each(t, estimate)`` sees every cycle."""
    estimator = estimator or FullEstimator(EARTH, flown.sheet)
    for _ in range(round(seconds / DT)):
        sensed = flown.sensed(**asked)
        if estimator.started or sensed.fix is not None:
            now = estimator.step(sensed, PARAMS, DT)
            if each is not None:
                each(flown, now)
    return estimator
