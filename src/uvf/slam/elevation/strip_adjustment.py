"""Sweeps of one pass raised and tilted onto the ground that earlier passes have drawn: strip adjustment.

An aircraft knows its height to some decimetres only, and that changes from pass to pass; where two passes overlap, they differ by a step
that no ground has. Height and tilt of the sweeps are estimated from what they have in common with the map, as in airborne laser scanning
(Kilian, Haala and Englich, "Capture and evaluation of airborne laser scanner data", ISPRS 1996), here a few sweeps at a time, by a
Kalman filter with Huber's weights.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LEAST = 20
"""Points in common, below which sweeps say nothing."""
ENOUGH = 30
"""Points that tell as much as any number of them: their errors are not independent."""
POINT_SIGMA, HUBER = 0.1, 0.15  # m, of one point, and from which on it counts less
ALIKE = 1.0  # m, beyond which a point has hit something else than what the map shows
ROUNDS = 4
SIGMA = np.array([0.3, 0.01])
"""m and m/m (rad of roll): of the height and the tilt, where nothing is known of them."""
RELAXATION = 10.0
"""s, after which they are others where nothing is known of them."""


class StripAdjustment:
    """Of one sensor: how far its sweeps are to be raised [m], and tilted about their middle [m/m]."""

    def __init__(self) -> None:
        self._state = np.zeros(2)
        self._covariance = np.diag(SIGMA**2)
        self._t: float | None = None

    def raises(self, t: float, origins: Sequence[Floats], sweeps: Sequence[Floats], surfaces: Sequence[Floats]) -> list[Floats]:
        """By how much (n,) [m] the points (n, 3) [m, world] of sweeps until ``t`` [s] are to be raised to fit the map.

        origins: (3,) of each; surfaces: (n,) height [m] of what earlier passes have drawn at each point; NaN where that is nothing.
        """
        self._predict(t)
        across = [_across(points, origin) for points, origin in zip(sweeps, origins, strict=True)]
        every = np.concatenate(across) if across else np.zeros(0)
        design = np.column_stack((np.ones(len(every)), every))
        apart = np.concatenate([surface - points[:, 2] for points, surface in zip(sweeps, surfaces, strict=True)]) if across else every
        common = np.abs(apart - design @ self._state) <= ALIKE  # not where one is NaN
        if common.sum() >= LEAST:
            self._correct(design[common], apart[common])
        return [self._state[0] + self._state[1] * side for side in across]

    def _predict(self, t: float) -> None:
        """Both wander about zero, as the errors of a position from satellites do: Ornstein-Uhlenbeck processes."""
        kept = np.exp(-max(t - self._t, 0.0) / RELAXATION) if self._t is not None else 1.0
        self._t = t
        self._state = kept * self._state
        self._covariance = kept**2 * self._covariance + (1.0 - kept**2) * np.diag(SIGMA**2)

    def _correct(self, design: Floats, apart: Floats) -> None:
        """design: (n, 2); apart: (n,) [m]."""
        prior = np.linalg.inv(self._covariance)
        share = min(1.0, ENOUGH / len(apart)) / POINT_SIGMA**2
        state = np.array([np.median(apart - design[:, 1] * self._state[1]), self._state[1]])
        for _ in range(ROUNDS):
            off = np.abs(apart - design @ state)
            weights = share * HUBER / np.maximum(off, HUBER)
            information = prior + (design * weights[:, None]).T @ design
            state = np.linalg.solve(information, prior @ self._state + design.T @ (weights * apart))
        self._state, self._covariance = state, np.linalg.inv(information)


def _across(points: Floats, origin: Floats) -> Floats:
    """(n,) [m] of each point from the sensor, along the sweep's line over the ground; NaN for what is not finite."""
    finite = points[np.isfinite(points).all(axis=1), :2]
    line = finite[-1] - finite[0] if len(finite) else np.zeros(2)
    return np.asarray((points[:, :2] - origin[:2]) @ (line / max(float(np.hypot(*line)), 1e-9)), dtype=np.float64)
