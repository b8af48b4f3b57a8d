"""Stability margins of a loop from its frequency response."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import sici

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

STARTS_ON = 0.05  # rad from the negative axis, at the lowest frequency


@dataclass(frozen=True)
class Margins:
    """How far a loop is from instability; nan where it has no such crossing.

    Whether it is stable is not told by one loop's response alone: see ``SignalFlow.unstable``.
    """

    phase: float  # rad, the one nearest to 0 of all crossings of gain 1; below 0 the loop lags by more than pi there
    crossover: float  # rad/s, where that is
    gain: float  # factor nearest to 1 that brings a crossing of the negative axis to -1; below 1: by which it may fall, or must
    delay: float  # s, that it stands besides
    peak: float  # of the sensitivity 1 / |1 + L|, at any frequency

    @property
    def gain_db(self) -> float:
        """dB, of ``gain``: above 0 what the gain may grow by, below 0 what it may fall by."""
        return 20 * math.log10(self.gain)


def margins(omega: Floats, loop: Complex) -> Margins:
    """Margins of a loop from its frequency response.

    omega: (k,) [rad/s], rising; loop: (k,) open-loop response L with the feedback's minus left out (the loop closes as 1 + L).
    """
    size, angle = np.log(np.abs(loop)), np.unwrap(np.angle(loop))
    crossings = [(math.remainder(math.pi + a, math.tau), w) for w, a in _crossings(omega, size, angle)]
    phase, crossover = min(crossings, key=lambda found: abs(found[0]), default=(math.nan, math.nan))
    # Where the angle is an odd multiple of pi the loop meets the negative axis.
    turned = _crossings(omega, np.sin(angle), np.stack((size, np.cos(angle))))
    meets = [-s for _, (s, c) in turned if c < 0]
    if abs(math.remainder(math.pi + angle[0], math.tau)) < STARTS_ON:
        meets.append(-float(size[0]))  # it begins on the axis, as with one unstable pole
    gain = min(meets, key=abs, default=math.nan)
    return Margins(phase, crossover, math.exp(gain), phase / crossover, float(np.max(1 / np.abs(1 + loop))))


def _crossings(omega: Floats, value: NDArray[np.floating[Any]], at: NDArray[np.floating[Any]]) -> list[tuple[float, Any]]:
    """(omega, ``at`` there) where ``value`` changes its sign, in between by straight lines."""
    k = np.flatnonzero(value[:-1] * value[1:] < 0)
    part = value[k] / (value[k] - value[k + 1])
    found = at[..., k] + part * (at[..., k + 1] - at[..., k])
    return list(zip((omega[k] + part * (omega[k + 1] - omega[k])).tolist(), found.T.tolist(), strict=True))


def step_response(omega: Floats, closed: Complex, t: Floats) -> Floats:
    """Response (n,) at times ``t`` (n,) [s] after a unit step, of a stable closed loop's frequency response ``closed`` (k,)."""
    kernel = closed.real * np.sin(np.outer(t, omega)) / omega
    slower = closed.real[0] * sici(omega[0] * t)[0]  # what lies below the lowest frequency
    return np.asarray(2 / np.pi * (np.trapezoid(kernel, omega, axis=1) + slower))
