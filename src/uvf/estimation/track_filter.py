"""Position, ground speed, course, wind and heading from satellite fixes, airspeed and turn rates.

Extended Kalman filter of seven states after Beard & McLain 8.7: x = (p_n, p_e, V_g, chi, w_n, w_e, psi), corrected by
fixes, by the wind triangle as a pseudo measurement and, where there is one, by a magnetic heading. Here psi is the azimuth of
the flight through the air, which the triangle needs; in a bank the nose points aside of it.
"""

import math

import numpy as np
from numpy.typing import NDArray

from uvf.estimation.kalman import Ekf, Measured
from uvf.maths.geodesy import GRAVITY

Floats = NDArray[np.float64]

N, E, V, CHI, WN, WE, PSI = range(7)
PROCESS = np.diag((0.01, 0.01, 0.005, 0.00003, 1e-4, 1e-4, 1e-4))  # units^2/s
TRIANGLE_SIGMA = 0.5  # m/s
HEADING_SIGMA = 0.05  # rad
RECKONING_SIGMA = 0.3  # m/s, of the ground velocity without fixes


class TrackFilter:
    """The seven-state filter, started by the first fix."""

    def __init__(self, north: float, east: float, v_north: float, v_east: float) -> None:
        course = math.atan2(v_east, v_north)
        x = np.array((north, east, math.hypot(v_north, v_east), course, 0.0, 0.0, course))
        self._ekf = Ekf(x, np.diag((4.0, 4.0, 1.0, 0.01, 25.0, 25.0, 0.1)))
        self._course_rate = 0.0

    @property
    def x(self) -> Floats:
        """State (7,): north, east [m], ground speed [m/s], course [rad], wind north, east [m/s], azimuth of the airspeed [rad]."""
        return self._ekf.x

    @property
    def position_sigma(self) -> float:
        """1 sigma [m] of the horizontal position, of the worse axis."""
        return math.sqrt(max(self._ekf.P[N, N], self._ekf.P[E, E]))

    def predict(self, airspeed: float, yaw_rate: float, roll: float, dt: float) -> None:
        """Propagates the equations of 8.7 over ``dt`` [s]: horizontal airspeed [m/s], psi' [rad/s], roll [rad]."""
        n, e, v, chi, wn, we, psi = self._ekf.x.tolist()
        v = max(v, 1.0)
        c, s, cp, sp = math.cos(chi), math.sin(chi), math.cos(psi), math.sin(psi)
        v_rate = airspeed * yaw_rate * (we * cp - wn * sp) / v
        lift = GRAVITY / v * math.tan(roll)
        chi_rate = lift * math.cos(chi - psi)
        f = np.eye(7)
        f[N, V], f[N, CHI], f[E, V], f[E, CHI] = dt * c, -dt * v * s, dt * s, dt * v * c
        f[V, V] -= dt * v_rate / v
        f[V, WN], f[V, WE] = -dt * airspeed * yaw_rate * sp / v, dt * airspeed * yaw_rate * cp / v
        f[V, PSI] = -dt * airspeed * yaw_rate * (wn * cp + we * sp) / v
        slope = lift * math.sin(chi - psi)
        f[CHI, V], f[CHI, CHI], f[CHI, PSI] = -dt * chi_rate / v, 1 - dt * slope, dt * slope
        self._course_rate = chi_rate
        mid = chi + 0.5 * dt * chi_rate
        then = np.array(
            (n + dt * v * math.cos(mid), e + dt * v * math.sin(mid), v + dt * v_rate, chi + dt * chi_rate, wn, we, psi + dt * yaw_rate)
        )
        self._ekf.move(lambda _: then, f, PROCESS * dt)

    def reckon(self, gnss_age: float, dt: float) -> None:
        """Adds to the position's variance over ``dt`` [s], ``gnss_age`` [s] after the last fix.

        Errors of wind and compass last: sigma grows with time, not with its root.
        """
        self._ekf.P[:2, :2] += np.eye(2) * 2 * RECKONING_SIGMA**2 * gnss_age * dt

    def correct_fix(self, fix: tuple[float, float, float, float], age: float, sigma: tuple[float, float]) -> None:
        """Corrects by (north, east [m], v_north, v_east [m/s]) valid ``age`` [s] ago; sigma: of position [m] and speed [m/s]."""
        north, east, v_north, v_east = fix
        speed, course = math.hypot(v_north, v_east), math.atan2(v_east, v_north) + self._course_rate * age
        mid = self._ekf.x[CHI] - 0.5 * self._course_rate * age
        ahead = self._ekf.x[V] * age
        z = np.array((north + ahead * math.cos(mid), east + ahead * math.sin(mid), speed, course))
        course_sigma = sigma[1] / max(speed, 1.0)
        self._update(z, np.eye(4, 7), self._ekf.x[:4], np.diag((sigma[0] ** 2, sigma[0] ** 2, sigma[1] ** 2, course_sigma**2)))

    def correct_triangle(self, airspeed: float) -> None:
        """Corrects by the wind triangle V_a (cos psi, sin psi) + w - V_g (cos chi, sin chi) = 0 (8.20); horizontal airspeed [m/s]."""
        _, _, v, chi, wn, we, psi = self._ekf.x.tolist()
        c, s, cp, sp = math.cos(chi), math.sin(chi), math.cos(psi), math.sin(psi)
        expected = np.array((airspeed * cp + wn - v * c, airspeed * sp + we - v * s))
        h = np.zeros((2, 7))
        h[0, V], h[0, CHI], h[0, WN], h[0, PSI] = -c, v * s, 1.0, -airspeed * sp
        h[1, V], h[1, CHI], h[1, WE], h[1, PSI] = -s, -v * c, 1.0, airspeed * cp
        self._update(np.zeros(2), h, expected, np.eye(2) * TRIANGLE_SIGMA**2)

    def correct_heading(self, heading: float) -> None:
        """Corrects psi by a heading [rad] from true north."""
        h = np.zeros((1, 7))
        h[0, PSI] = 1.0
        psi = self._ekf.x[PSI]
        self._update(np.array((psi + math.remainder(heading - psi, math.tau),)), h, self._ekf.x[PSI:], np.eye(1) * HEADING_SIGMA**2)

    def _update(self, z: Floats, h: Floats, expected: Floats, r: Floats) -> None:
        if len(z) == 4:
            z[CHI] = expected[CHI] + math.remainder(z[CHI] - expected[CHI], math.tau)
        self._ekf.take(Measured(z, lambda _: expected, h, r))
