"""Stability margins of a loop from its frequency response."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Margins:
    """How far a loop is from instability; nan where it has no such crossing."""

    phase: float  # rad, the least at a crossing of gain 1
    crossover: float  # rad/s, where that is
    gain: float  # factor, by which it may grow
    delay: float  # s, that it stands besides


def margins(omega: Floats, loop: Complex) -> Margins:
    """Gain, phase and delay margin of a loop from its frequency response.

    omega: (k,) [rad/s], rising; loop: (k,) open-loop response L with the feedback's minus left out (the loop closes as 1 + L).
    """
    size, angle = np.log(np.abs(loop)), np.unwrap(np.angle(loop))
    crossings = [(abs(math.remainder(math.pi + a, math.tau)), w) for w, a in _crossings(omega, size, angle)]
    phase, crossover = min(crossings, default=(math.nan, math.nan))
    # Where the angle is an odd multiple of pi the loop meets the negative axis.
    turned = _crossings(omega, np.sin(angle), np.stack((size, np.cos(angle))))
    gains = [math.exp(-s) for _, (s, c) in turned if c < 0 and s < 0]
    return Margins(phase, crossover, min(gains, default=math.nan), phase / crossover)


def _crossings(omega: Floats, value: NDArray[np.floating[Any]], at: NDArray[np.floating[Any]]) -> list[tuple[float, Any]]:
    """(omega, ``at`` there) where ``value`` changes its sign, in between by straight lines."""
    k = np.flatnonzero(value[:-1] * value[1:] < 0)
    part = value[k] / (value[k] - value[k + 1])
    found = at[..., k] + part * (at[..., k + 1] - at[..., k])
    return list(zip((omega[k] + part * (omega[k + 1] - omega[k])).tolist(), found.T.tolist(), strict=True))
