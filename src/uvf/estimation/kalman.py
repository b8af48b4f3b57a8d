"""The two filters of filterpy behind one face: the same models, derivatives (``ekf``) or sigma points (``ukf``).

What filterpy lacks and is here: a gate before a measurement is taken, and states that measurements do not change (Schmidt 1966).
"""

from collections.abc import Callable
from typing import Literal, NamedTuple, Protocol

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter, MerweScaledSigmaPoints, UnscentedKalmanFilter, predict
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Kind = Literal["ekf", "ukf"]
Motion = Callable[[Floats], Floats]


class Measured(NamedTuple):
    """A measurement: values (m,), what the state (n,) says they should be, the derivative (m, n) of that, and its covariance (m, m)."""

    z: Floats
    expected: Callable[[Floats], Floats]
    jacobian: Floats
    noise: Floats


class Kalman(Protocol):
    """A Kalman filter with mean x (n,) and covariance P (n, n), as filterpy calls them."""

    x: Floats
    P: Floats

    def move(self, motion: Motion, jacobian: Floats, noise: Floats) -> None:
        """Predicts: x (n,) becomes motion(x); ``jacobian`` (n, n) is the derivative of ``motion``, ``noise`` (n, n) the process noise."""

    def take(self, measured: Measured) -> None:
        """Corrects x and P by a measurement."""


class Ekf(ExtendedKalmanFilter):  # type: ignore[misc]  # filterpy has no types
    """Extended Kalman filter of filterpy with mean ``x`` (n,) and covariance ``p`` (n, n)."""

    x: Floats
    P: Floats

    def __init__(self, x: Floats, p: Floats) -> None:
        super().__init__(dim_x=len(x), dim_z=1)
        self.x, self.P = x, p
        self._motion: Motion = lambda x: x

    def predict_x(self, u: float = 0) -> None:
        """Applies the motion given to ``move``: filterpy calls this with its control input ``u`` [-], which is not used."""
        self.x = self._motion(self.x)

    def move(self, motion: Motion, jacobian: Floats, noise: Floats) -> None:
        """Predicts: x (n,) becomes motion(x), P follows with ``jacobian`` (n, n) and process noise ``noise`` (n, n)."""
        self._motion, self.F, self.Q = motion, jacobian, noise
        self.predict()

    def take(self, measured: Measured) -> None:
        """Corrects x and P with the measurement's derivative at x."""
        self.update(measured.z, lambda x: measured.jacobian, measured.expected, R=measured.noise)


class Ukf(UnscentedKalmanFilter):  # type: ignore[misc]  # filterpy has no types
    """Unscented Kalman filter of filterpy; all weights are positive, so that the covariance stays positive semi-definite."""

    x: Floats
    P: Floats

    def __init__(self, x: Floats, p: Floats) -> None:
        points = MerweScaledSigmaPoints(len(x), alpha=1.0, beta=2.0, kappa=0.0, sqrt_method=_root)
        super().__init__(len(x), 1, 1.0, hx=None, fx=None, points=points)
        self.x, self.P = x, p

    def move(self, motion: Motion, jacobian: Floats, noise: Floats) -> None:
        """Predicts by sigma points: x (n,) becomes motion(x); ``noise`` (n, n) is the process noise, ``jacobian`` (n, n) is not used."""
        self.Q = noise
        self.predict(fx=lambda x, dt: motion(x))

    def take(self, measured: Measured) -> None:
        """Corrects x and P with new sigma points of the present mean and covariance."""
        # Those of the last motion are none of this state any more where another measurement has come between.
        self.sigmas_f = self.points_fn.sigma_points(self.x, self.P)
        self.update(measured.z, R=measured.noise, hx=measured.expected)


FILTERS: dict[Kind, type[Ekf] | type[Ukf]] = {"ekf": Ekf, "ukf": Ukf}


def move_linearly(kalman: Kalman, transition: Floats, shift: Floats, noise: Floats) -> None:
    """Predicts: x (n,) becomes ``transition`` (n, n) x + ``shift`` (n,), with process noise ``noise`` (n, n).

    Exact for both kinds of filter, and faster than sigma points.
    """
    kalman.x, kalman.P = predict(kalman.x, kalman.P, F=transition, Q=noise, u=shift)


def correct(kalman: Kalman, measured: Measured, held: slice) -> None:
    """Corrects by a measurement; the states ``held`` keep their mean and covariance, their correlation with the others follows.

    With the rows of the gain that belong to them zero, Joseph's form gives for the others what the whole gain gives.
    """
    x, p = kalman.x[held], kalman.P[held, held]
    kalman.take(measured)
    kalman.x[held], kalman.P[held, held] = x, p
    kalman.P = (kalman.P + kalman.P.T) / 2


def misfit(kalman: Kalman, measured: Measured) -> float:
    """Normalised innovation squared [-]: chi-square distributed, with as many degrees of freedom as the measurement has values."""
    y = measured.z - measured.expected(kalman.x)
    s = measured.jacobian @ kalman.P @ measured.jacobian.T + measured.noise
    return float(y @ np.linalg.solve(s, y))


def _root(p: Floats) -> Floats:
    """U with U' U = p. By eigenvalues: a covariance that rounding has made indefinite has one, too."""
    values, vectors = np.linalg.eigh(p)
    return np.asarray(np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T, dtype=np.float64)
