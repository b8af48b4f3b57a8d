"""Allan deviation: how far the means over neighbouring intervals of a sensor's output differ, by the intervals' length.

Estimator: Riley, Handbook of Frequency Stability Analysis, NIST SP 1065 (2008), overlapping Allan variance.
Analytic forms: IEEE Std 952-1997, annex C.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uvf.sensors.errors import Errors

Floats = NDArray[np.float64]


def allan_deviation(samples: ArrayLike, hz: float, factors: ArrayLike) -> tuple[Floats, Floats]:
    """Averaging times (k,) [s] and overlapping Allan deviations (k,) [unit of the samples].

    samples: (n,) at ``hz`` [Hz]; factors: (k,) interval lengths in samples, each at most n / 2. Raises ValueError.
    """
    rate = np.asarray(samples, dtype=np.float64)
    lengths = np.asarray(factors, dtype=np.int64)
    if lengths.size and not (lengths.min() >= 1 and 2 * lengths.max() <= rate.size):
        raise ValueError(f"interval lengths must lie in 1..{rate.size // 2} samples, got {lengths.min()}..{lengths.max()}")
    phase = np.concatenate(((0.0,), np.cumsum(rate - rate.mean()))) / hz
    taus = lengths / hz
    second = [phase[2 * m :] - 2 * phase[m:-m] + phase[: -2 * m] for m in lengths]
    return taus, np.array([np.sqrt(np.mean(d * d) / 2) for d in second]) / taus


def octaves(count: int, least: int = 9) -> NDArray[np.int64]:
    """Interval lengths (k,) 1, 2, 4, ... [samples] of which at least ``least`` fit into ``count`` samples one after another."""
    return 2 ** np.arange(int(np.log2(count // least)) + 1)


def expected(errors: Errors, hz: float, taus: ArrayLike) -> Floats:
    """Analytic deviations (k,) of one component with these errors at averaging times (k,) [s], sampled at ``hz`` [Hz], in its own unit.

    White noise N / sqrt(tau), exponentially correlated (Markov) noise, rate random walk K sqrt(tau / 3); for taus well above 1 / hz.
    """
    tau = np.asarray(taus, dtype=np.float64)
    ratio = errors.drift_time / tau
    correlated = 1 - ratio / 2 * (3 - 4 * np.exp(-1 / ratio) + np.exp(-2 / ratio))
    variance: Floats = (
        np.square(errors.noise) / hz / tau + 2 * np.square(errors.drift) * ratio * correlated + np.square(errors.random_walk) * tau / 3
    )
    return np.asarray(np.sqrt(variance))
