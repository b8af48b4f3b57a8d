"""Covariance of the errors, and what a measurement changes in state and covariance."""

from dataclasses import dataclass

import numpy as np

from uvf.estimation.ekf.states import PITOT, SIZE, FilterState, Floats

GATE = 5.0  # sigmas
CONSIDERED = PITOT
"""Kept at what it is: its uncertainty counts, but nothing is learnt of it (Schmidt 1966). A filter that is linear at each moment would
otherwise find in gusts what a bias of airspeed would do."""


@dataclass(frozen=True, slots=True, eq=False)
class Observation:
    """A measurement against what the state predicts.

    residual: (m,), measured less predicted; jacobian: (m, 25); variance: (m,), of independent noise.
    """

    residual: Floats
    jacobian: Floats
    variance: Floats


class Filter:
    """State and covariance (25, 25) together."""

    def __init__(self, state: FilterState, sigma: Floats) -> None:
        """sigma: (25,)."""
        self.state = state
        self.p: Floats = np.diag(sigma**2)

    def predict(self, transition: Floats, gained: Floats) -> None:
        """Propagates the covariance by ``transition`` (25, 25) and adds ``gained`` (25,) to its diagonal."""
        self.p = transition @ self.p @ transition.T
        self.p.flat[:: SIZE + 1] += gained

    def update(self, seen: Observation) -> float:
        """Corrects by a measurement; returns its test ratio [-], the normalised innovation squared over the square of the gate.

        Beyond 1 nothing is changed.
        """
        across: Floats = self.p @ seen.jacobian.T
        spread: Floats = seen.jacobian @ across
        spread.flat[:: len(seen.variance) + 1] += seen.variance
        inverse = np.linalg.inv(spread)
        ratio = float(seen.residual @ inverse @ seen.residual) / (GATE * GATE)
        if ratio > 1.0:
            return ratio
        gain = across @ inverse
        gain[CONSIDERED] = 0.0
        # Joseph's form (I - KH) P (I - KH)' + K R K' multiplied out, which is right for any gain
        known = gain @ across.T
        p: Floats = self.p + gain @ (spread @ gain.T) - known - known.T
        self.p = 0.5 * (p + p.T)
        self.state.add(gain @ seen.residual)
        return ratio

    def forget(self, part: slice | int, sigma: float | Floats) -> None:
        """Resets the covariance of some states to 1 ``sigma`` each, without correlation with any other.

        sigma: one for all, or (k,) for k states, in the states' units [m, m/s, rad, ...].
        """
        k = np.arange(SIZE)[part]
        self.p[k, :] = 0.0
        self.p[:, k] = 0.0
        self.p[k, k] = np.square(sigma)

    def sigma(self, part: slice | int) -> float:
        """1 sigma of a state, or the largest among several, in their unit [m, m/s, rad, ...]."""
        return float(np.sqrt(self.p.diagonal()[part].max()))
