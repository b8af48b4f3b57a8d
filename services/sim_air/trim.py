"""Trim: the attitude and controls for which level flight does not accelerate."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

Floats = NDArray[np.float64]

TOLERANCE = 1e-4  # m/s^2 and rad/s^2


@dataclass(frozen=True)
class Trim:
    """Angles [rad], deflections [rad], throttle 0..1, and what acceleration is left over."""

    alpha: float
    roll: float
    aileron: float
    elevator: float
    rudder: float
    throttle: float
    residual: float = np.inf

    @property
    def converged(self) -> bool:
        return self.residual < TOLERANCE and 0 <= self.throttle <= 1


def solve(accelerations: Callable[[Trim], Floats]) -> Trim:
    """Finds the six unknowns for which the six body accelerations (3 m/s^2, 3 rad/s^2) vanish."""
    guess = np.array((0.05, 0.0, 0.0, -0.1, 0.0, 0.5))
    found = root(lambda x: accelerations(Trim(*x)), guess, method="hybr", options={"eps": 1e-6, "xtol": 1e-10})
    return replace(Trim(*found.x.tolist()), residual=float(np.abs(found.fun).max()))
