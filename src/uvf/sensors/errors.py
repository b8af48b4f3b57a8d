"""What is wrong with a sensor's readings: constant, slowly changing and white errors, saturation and quantisation.

Terms after IEEE Std 952 (annexes B and C) and Beard & McLain (2012), chapter 7. Each term draws from a generator of its own, a
child of the channel's, so that switching one on changes no other one's stream.
"""

from dataclasses import dataclass
from math import exp, sqrt

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Amount = float | Floats
"""One number for all components of a channel, or (size,) one for each."""


@dataclass(frozen=True, eq=False)
class Errors:
    """The error budget of a channel, in the unit of what it measures."""

    noise: Amount = 0.0
    """1 sigma of the white noise on a sample."""
    bias: Amount = 0.0
    """1 sigma of the constant drawn at turn-on."""
    scale: Amount = 0.0
    """1 sigma of the scale factor's error, drawn at turn-on."""
    drift: Amount = 0.0
    """1 sigma of a first-order Gauss-Markov bias: a gyroscope's bias instability, a receiver's wandering."""
    drift_time: float = 100.0
    """s, its correlation time."""
    random_walk: Amount = 0.0
    """unit/sqrt(s), growth of a bias that walks at random: rate random walk, K of IEEE Std 952."""
    limit: Amount = np.inf
    """Readings saturate at plus and minus this."""
    resolution: float = 0.0
    """Readings are whole multiples of this; 0 = not quantised."""


def sample_sigma(density: float, hz: float) -> float:
    """1 sigma [unit] of a sample at ``hz`` [Hz] of white noise of a ``density`` [unit/sqrt(Hz)]: angle random walk, N of IEEE Std 952."""
    return density * float(np.sqrt(hz))


class GaussMarkov:
    """First-order Gauss-Markov process, exact for any step (Beard & McLain, eq. 7.17); begins in its steady state.

    dx/dt = -x / time_constant + white noise.
    """

    def __init__(self, sigma: Floats, time_constant: float, rng: np.random.Generator) -> None:
        """sigma: (n,) standard deviations in the steady state; time_constant: s."""
        self._sigma = sigma
        self._time_constant = time_constant
        self._rng = rng
        self.value: Floats = sigma * rng.standard_normal(sigma.shape)

    def step(self, dt: float) -> Floats:
        """Value (n,) ``dt`` [s] after the last step, in the unit of sigma."""
        keep = exp(-dt / self._time_constant)
        new = self._rng.standard_normal(self._sigma.shape)
        self.value = keep * self.value + self._sigma * sqrt(1 - keep * keep) * new
        return self.value


class RandomWalk:
    """The integral of white noise; begins at zero."""

    def __init__(self, density: Floats, rng: np.random.Generator) -> None:
        """density: (n,) unit/sqrt(s)."""
        self._density = density
        self._rng = rng
        self.value: Floats = np.zeros(density.shape)

    def step(self, dt: float) -> Floats:
        """Value (n,) ``dt`` [s] after the last step, in the density's unit times sqrt(s)."""
        self.value = self.value + self._density * sqrt(dt) * self._rng.standard_normal(self._density.shape)
        return self.value


class Channel:
    """One measured quantity of ``size`` components with its errors."""

    def __init__(self, errors: Errors, size: int, rng: np.random.Generator) -> None:
        noise, bias, scale, drift, walk = rng.spawn(5)
        self._errors = errors
        self._rng = noise
        self._noise = np.broadcast_to(np.asarray(errors.noise, dtype=np.float64), size)
        self._bias: Floats = errors.bias * bias.standard_normal(size)
        self._scale: Floats = 1.0 + errors.scale * scale.standard_normal(size)
        self._limit = np.asarray(errors.limit, dtype=np.float64) if np.isfinite(errors.limit).any() else None
        self._slow: list[GaussMarkov | RandomWalk] = []  # those that there are: most channels have none
        if np.any(errors.drift):
            self._slow.append(GaussMarkov(np.ones(size) * errors.drift, errors.drift_time, drift))
        if np.any(errors.random_walk):
            self._slow.append(RandomWalk(np.ones(size) * errors.random_walk, walk))

    def read(self, true: Floats, dt: float) -> Floats:
        """Reading (size,) of the ``true`` value (size,), ``dt`` [s] after the last one."""
        errors = self._errors
        value: Floats = self._scale * true + self._bias + self._noise * self._rng.standard_normal(self._noise.shape)
        for process in self._slow:
            value += process.step(dt)
        if self._limit is not None:
            value = np.minimum(np.maximum(value, -self._limit), self._limit)
        return np.round(value / errors.resolution) * errors.resolution if errors.resolution else value
