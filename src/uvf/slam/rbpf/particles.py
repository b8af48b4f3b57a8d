"""The particles: a pose, a weight and a past each. Which of them live on is drawn in proportion to their weights."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2_arrays import wrapped

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Particles:
    """The particles; ``poses`` (n, 3) are map_from_base of now [m, m, rad]."""

    def __init__(self, number: int) -> None:
        self.poses = np.zeros((number, 3))
        self.log_weights = np.zeros(number)
        """Since the last resampling."""
        self._ever = np.zeros(number)
        self._places: list[Floats] = []
        self._parents: list[Ints] = []
        self._next = np.arange(number)

    def __len__(self) -> int:
        return len(self.poses)

    @property
    def steps(self) -> int:
        """Number of poses that are kept of each particle."""
        return len(self._places)

    @property
    def weights(self) -> Floats:
        """Weights (n,), of sum 1."""
        parts = np.exp(self.log_weights - self.log_weights.max())
        weights: Floats = parts / parts.sum()
        return weights

    @property
    def effective(self) -> float:
        """Effective number of particles [-]: N_eff = 1 / sum of the squared weights (equation 20)."""
        return float(1.0 / np.square(self.weights).sum())

    @property
    def best(self) -> int:
        """Number of the particle whose whole past has been the likeliest."""
        return int(np.argmax(self._ever))

    def reweigh(self, log_weights: Floats) -> None:
        """Multiplies the weights by exp of ``log_weights`` (n,)."""
        self.log_weights = self.log_weights + log_weights
        self._ever = self._ever + log_weights

    def keep(self) -> None:
        """Makes the poses of now part of the past."""
        self._places.append(self.poses.copy())
        self._parents.append(self._next)
        self._next = np.arange(len(self))

    def resample(self, rng: np.random.Generator) -> Ints:
        """Low-variance resampling (Thrun et al. 2005, table 4.4); returns which particle (n,) each has been until now."""
        n = len(self)
        ladder = np.cumsum(self.weights)
        chosen: Ints = np.searchsorted(ladder, (rng.random() + np.arange(n)) / n * ladder[-1], side="left").clip(0, n - 1)
        self.poses, self._ever, self._next = self.poses[chosen], self._ever[chosen], self._next[chosen]
        self.log_weights = np.zeros(n)
        return chosen

    def path(self, k: int) -> Floats:
        """Kept poses (steps, 3) [m, m, rad] of particle k's past."""
        found = np.empty((len(self._places), 3))
        k = int(self._next[k])
        for i in range(len(self._places) - 1, -1, -1):
            found[i] = self._places[i][k]
            k = int(self._parents[i][k])
        return found

    def spread(self) -> Floats:
        """Covariance (3, 3) of the poses by their weights [m, rad]."""
        away = self.poses - self.poses[self.best]
        away[:, 2] = wrapped(away[:, 2])
        weights = self.weights
        away = away - weights @ away
        covariance: Floats = (away * weights[:, None]).T @ away
        return covariance
