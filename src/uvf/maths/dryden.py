"""Continuous turbulence in Dryden's form after MIL-F-8785C (1980), section 3.7: gusts along three axes and about them.

Axes: u along the flight, v to its right, w down; p, q, r is the rotation of the air about them, so that an aircraft's rates through
the air are its own less these. Spectra are one-sided: their integral over omega from 0 to infinity is the variance.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

FT = 0.3048  # m
LOWEST, LOW, HIGH = 10 * FT, 1000 * FT, 2000 * FT
"""m above the ground: the low-altitude model holds between the first two, that of medium and high altitude above the last."""
HIGH_LENGTH = 1750 * FT  # m, of all components (3.7.2.1, Dryden's form)
ALTITUDES = FT * np.array((500, 1750, 3750, 7500, 15000, 25000, 35000, 45000, 55000, 65000, 75000, 80000), dtype=np.float64)
INTENSITIES = {
    "light": FT * np.array((6.6, 6.9, 7.4, 6.7, 4.6, 2.7, 0.4, 0, 0, 0, 0, 0)),
    "moderate": FT * np.array((8.6, 9.6, 10.6, 10.1, 8.0, 6.6, 5.0, 4.2, 2.7, 0, 0, 0)),
    "severe": FT * np.array((15.6, 17.6, 23.0, 23.6, 22.1, 20.0, 16.0, 15.1, 12.1, 7.9, 6.2, 5.1)),
}
"""m/s at ``ALTITUDES``: figure 7, exceeded with probability 1e-2, 1e-3 and 1e-5."""
W20 = {"light": 7.72, "moderate": 15.43, "severe": 23.15}
"""m/s, wind at 20 ft: 15, 30 and 45 knots (figure 9)."""
BLOCK = 512  # steps whose white noise is drawn at once
SERIES = 0.02  # below this a difference of nearly equal terms is summed as a series
ROOT3 = math.sqrt(3.0)


class Strength(NamedTuple):
    """What the spectra are made of: standard deviations [m/s] and lengths [m] of u and v, and of w."""

    sigma_u: float
    sigma_w: float
    length_u: float
    length_w: float


def strength(height: float, w20: float, severity: str) -> Strength:
    """Strength of the turbulence at ``height`` [m] above the ground.

    ``w20`` [m/s], the wind at 20 ft, rules below 1000 ft, ``severity`` above 2000 ft; between them it changes linearly.
    """
    if height >= HIGH:
        sigma = float(np.interp(height, ALTITUDES, INTENSITIES[severity]))
        return Strength(sigma, sigma, HIGH_LENGTH, HIGH_LENGTH)
    if height <= LOW:
        return _low(max(height, LOWEST), w20)
    share, low = (height - LOW) / (HIGH - LOW), _low(LOW, w20)
    high = strength(HIGH, w20, severity)
    return Strength(*(a + share * (b - a) for a, b in zip(low, high, strict=True)))


def _low(height: float, w20: float) -> Strength:
    """Figures 10 and 11; the formula's height is in feet."""
    base = 0.177 + 0.000823 * height / FT
    return Strength(0.1 * w20 / base**0.4, 0.1 * w20, height / base**1.2, height)


def roll_sigma(air: Strength, span: float) -> float:
    """Standard deviation [rad/s] of the roll gust p for a wing of ``span`` [m]: the root of its spectrum's integral."""
    filled = float((math.pi * air.length_w / (4 * span)) ** (1 / 3))
    return air.sigma_w * math.pi * math.sqrt(0.1 * filled / (span * air.length_w))


def spectra(omega: ArrayLike, air: Strength, speed: float, span: float) -> dict[str, Floats]:
    """Analytic spectra of the gusts by name, each of the shape of ``omega`` (k,) [rad/s]: u, v, w [m^2/s] and p, q, r [1/s].

    For a wing of ``span`` [m] at an airspeed ``speed`` [m/s].
    """
    w = np.asarray(omega, dtype=np.float64)
    along = air.length_u * w / speed
    roll = 4 * span * w / (np.pi * speed)
    up = _lateral(w, air.sigma_w, air.length_w / speed)
    right = _lateral(w, air.sigma_u, air.length_u / speed)
    return {
        "u": air.sigma_u**2 * 2 * air.length_u / (np.pi * speed) / (1 + along**2),
        "v": right,
        "w": up,
        "p": air.sigma_w**2 / (speed * air.length_w) * 0.8 * (np.pi * air.length_w / (4 * span)) ** (1 / 3) / (1 + roll**2),
        "q": (w / speed) ** 2 / (1 + roll**2) * up,
        "r": (w / speed) ** 2 / (1 + (0.75 * roll) ** 2) * right,
    }


def _lateral(omega: Floats, sigma: float, tau: float) -> Floats:
    squared = (tau * omega) ** 2
    return sigma**2 * tau / np.pi * (1 + 3 * squared) / (1 + squared) ** 2


class GustVelocities(NamedTuple):
    """Gusts along the axes, u, v, w [m/s], and rotation of the air about them, p, q, r [rad/s]."""

    u: float
    v: float
    w: float
    p: float
    q: float
    r: float


class Turbulence:
    """Shaping filters between white noise and the gusts that one aircraft meets; it begins in the steady state.

    Each filter's state has unit variance and takes exact steps in its own time, flown distance over length, so that speed and
    height may change from step to step. q and r are gradients along the flight: exact for gusts that go straight between steps.
    """

    def __init__(self, span: float, rng: np.random.Generator) -> None:
        """span: of the wing, m."""
        self._span = span
        self._rng = rng
        self._noise: list[list[float]] = []
        start = rng.standard_normal(6)
        self._u, self._p = float(start[0]), float(start[1])
        self._v, self._w = _Lateral(float(start[2]), float(start[3])), _Lateral(float(start[4]), float(start[5]))
        self._yaw, self._pitch = _Gradient(), _Gradient()
        self._sigma_v = 0.0  # m/s, of the last step

    def turn(self, angle: float) -> None:
        """The flight has turned to the left by an angle [rad], and the gusts have not: one from ahead comes from the right then.

        Gusts that went round with a circling aircraft would work on it all the time, and give or take energy that no air has.
        """
        c, s, u, v = math.cos(angle), math.sin(angle), self._u, self._v.value
        self._u = c * u - s * v
        changed = c * v + s * u - v
        self._v.shift(changed)
        self._yaw.shift(self._sigma_v * changed)

    def step(self, flown: float, dt: float, air: Strength) -> GustVelocities:
        """Gusts that the aircraft meets ``flown`` [m] through the air and ``dt`` [s] after the last step."""
        n = self._draw()
        speed = max(flown / dt, 1e-3)
        self._u = _markov(self._u, flown / air.length_u, n[0])
        self._p = _markov(self._p, flown * math.pi / (4 * self._span), n[1])
        self._sigma_v = air.sigma_u
        v = air.sigma_u * self._v.step(flown / air.length_u, n[2], n[3])
        w = air.sigma_w * self._w.step(flown / air.length_w, n[4], n[5])
        p = roll_sigma(air, self._span) * self._p
        q = -self._pitch.step(w, dt, 4 * self._span / (math.pi * speed)) / speed
        r = self._yaw.step(v, dt, 3 * self._span / (math.pi * speed)) / speed
        return GustVelocities(air.sigma_u * self._u, v, w, p, q, r)

    def _draw(self) -> list[float]:
        if not self._noise:
            self._noise = self._rng.standard_normal((BLOCK, 6)).tolist()[::-1]
        return self._noise.pop()


def _markov(value: float, theta: float, noise: float) -> float:
    """First order, unit variance, over ``theta`` time constants."""
    keep = math.exp(-theta)
    return keep * value + math.sqrt(-math.expm1(-2 * theta)) * noise


class _Lateral:
    """(1 + sqrt(3) s) / (1 + s)^2 in units of its time constant, as two equal lags in a row, unit variance."""

    def __init__(self, a: float, b: float) -> None:
        """Two standard normal numbers, from which the steady state is drawn."""
        self._second, self._first = 0.5 * a, 0.5 * a + 0.5 * b

    def step(self, theta: float, a: float, b: float) -> float:
        """Over ``theta`` time constants with two standard normal numbers; covariance of the new noise by Cholesky."""
        keep = math.exp(-theta)
        c22, c12, c11 = _covariance(theta)
        l11 = math.sqrt(c22)
        l21 = c12 / l11 if l11 else 0.0
        self._second = keep * (self._second + theta * self._first) + l21 * a + math.sqrt(max(c11 - l21 * l21, 0.0)) * b
        self._first = keep * self._first + l11 * a
        return self.value

    @property
    def value(self) -> float:
        """Its output."""
        return ROOT3 * self._first + (1 - ROOT3) * self._second

    def shift(self, change: float) -> None:
        """Changes the output at once."""
        self._first, self._second = self._first + change, self._second + change


def _covariance(x: float) -> tuple[float, float, float]:
    """Integrals from 0 to ``x`` of exp(-2 s) times 1, s and s^2: the noise that the two lags have taken up."""
    gone = math.exp(-2 * x)
    first = -math.expm1(-2 * x) / 2
    if x < SERIES:
        return first, x**2 * (0.5 - x * (2 / 3 - x * (0.5 - x * 4 / 15))), x**3 * (1 / 3 - x * (0.5 - x * (0.4 - x * 2 / 9)))
    return first, (1 - gone * (1 + 2 * x)) / 4, (1 - gone * (1 + 2 * x + 2 * x * x)) / 4


class _Gradient:
    """s / (1 + T s): rate of change behind a lag, which stands for the size of the wing."""

    def __init__(self) -> None:
        self._smooth: float | None = None
        self._last = 0.0

    def step(self, value: float, dt: float, lag: float) -> float:
        """1/s times the unit of ``value``, which has gone straight from the one before within ``dt`` [s]; ``lag`` [s]."""
        if self._smooth is None:
            self._smooth = self._last = value
        slope, keep = (value - self._last) / dt, math.exp(-dt / lag)
        behind = (self._smooth - self._last + lag * slope) * keep
        self._smooth, self._last = value - lag * slope + behind, value
        return (value - self._smooth) / lag

    def shift(self, change: float) -> None:
        """What it follows is counted from elsewhere."""
        if self._smooth is not None:
            self._smooth, self._last = self._smooth + change, self._last + change
