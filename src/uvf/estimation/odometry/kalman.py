"""The two filters of filterpy behind one face: the same models, derivatives (``ekf``) or sigma points (``ukf``).

A filter may hold states back: a measurement then changes the others only, and the covariance says what this leaves uncertain
(Schmidt 1966; the gain's rows are zero, Joseph's form holds for any gain).
"""

from collections.abc import Callable
from typing import Literal, NamedTuple, Protocol

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter, MerweScaledSigmaPoints, UnscentedKalmanFilter
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Kind = Literal["ekf", "ukf"]


class Measured(NamedTuple):
    """A measurement: its values (m,), what the state says they should be, the derivative (m, n) of that, and its covariance (m, m)."""

    z: Floats
    expected: Callable[[Floats], Floats]
    jacobian: Floats
    noise: Floats


class Kalman(Protocol):
    """Mean x (n,) and covariance p (n, n)."""

    x: Floats
    p: Floats

    def move(self, motion: Callable[[Floats], Floats], jacobian: Floats, noise: Floats) -> None:
        """x becomes motion(x)."""

    def gain(self, measured: Measured) -> tuple[Floats, Floats, Floats]:
        """(K, S, y): the best gain, the innovation's covariance and the innovation; nothing is changed."""


class Ekf:
    def __init__(self, x: Floats, p: Floats) -> None:
        self.x, self.p = x, p
        self._kf = ExtendedKalmanFilter(dim_x=len(x), dim_z=1)

    def move(self, motion: Callable[[Floats], Floats], jacobian: Floats, noise: Floats) -> None:
        self._kf.x, self._kf.P, self._kf.F, self._kf.Q = self.x, self.p, jacobian, noise
        self._kf.predict()
        self.x, self.p = motion(self.x), self._kf.P

    def gain(self, measured: Measured) -> tuple[Floats, Floats, Floats]:
        kf = self._kf
        kf.x, kf.P = self.x, self.p
        kf.update(measured.z, lambda x: measured.jacobian, measured.expected, R=measured.noise)
        return kf.K, kf.S, kf.y


class Ukf:
    """Sigma points with weights that are all positive: the covariance stays one."""

    def __init__(self, x: Floats, p: Floats) -> None:
        self.x, self.p = x, p
        n = len(x)
        points = MerweScaledSigmaPoints(n, alpha=1.0, beta=2.0, kappa=0.0, sqrt_method=_root)
        self._kf = UnscentedKalmanFilter(n, 1, 1.0, hx=None, fx=None, points=points)

    def move(self, motion: Callable[[Floats], Floats], jacobian: Floats, noise: Floats) -> None:
        self._kf.x, self._kf.P, self._kf.Q = self.x, self.p, noise
        self._kf.predict(fx=lambda x, dt: motion(x))
        self.x, self.p = self._kf.x, self._kf.P

    def gain(self, measured: Measured) -> tuple[Floats, Floats, Floats]:
        kf = self._kf
        kf.x, kf.P = self.x, self.p
        kf.sigmas_f = kf.points_fn.sigma_points(self.x, self.p)
        kf.update(measured.z, R=measured.noise, hx=measured.expected)
        return kf.K, kf.S, kf.y


FILTERS: dict[Kind, type[Ekf] | type[Ukf]] = {"ekf": Ekf, "ukf": Ukf}


def correct(kalman: Kalman, measured: Measured, held: slice) -> None:
    """Takes a measurement in; the states ``held`` keep their mean."""
    best, s, y = kalman.gain(measured)
    gain = best.copy()
    gain[held] = 0.0
    cross = gain @ s @ best.T
    p = kalman.p - cross - cross.T + gain @ s @ gain.T
    kalman.x = kalman.x + gain @ y
    kalman.p = (p + p.T) / 2


def misfit(kalman: Kalman, measured: Measured) -> float:
    """The normalised innovation squared: chi-square distributed with as many degrees of freedom as the measurement has values."""
    y = measured.z - measured.expected(kalman.x)
    s = measured.jacobian @ kalman.p @ measured.jacobian.T + measured.noise
    return float(y @ np.linalg.solve(s, y))


def _root(p: Floats) -> Floats:
    """U with U' U = p. By eigenvalues: a covariance that rounding has made indefinite has one, too."""
    values, vectors = np.linalg.eigh(p)
    return np.asarray(np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T, dtype=np.float64)
