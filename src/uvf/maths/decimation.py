"""Fewer points that draw the same curve."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def min_max(t: Floats, values: Floats, most: int) -> tuple[Floats, Floats]:
    """At most ``most`` (about) of the points (t, values) (n,), rising t: of each stretch of time the lowest and the highest.

    A curve drawn through them covers the same pixels, spikes included, which every k-th point would miss. NaN values, which break
    the curve, are kept as one per stretch.
    """
    n = len(t)
    if n <= most or most < 4:
        return t, values
    edges = np.linspace(t[0], t[-1], most // 2 + 1)
    stretch = np.clip(np.searchsorted(edges, t, side="right") - 1, 0, most // 2 - 1)
    keep: list[int] = []
    for first, last in _runs(stretch):
        part = values[first:last]
        if np.isnan(part).all():
            keep.append(first)
            continue
        found = {first + int(np.nanargmin(part)), first + int(np.nanargmax(part))}
        if np.isnan(part).any():
            found.add(first + int(np.argmax(np.isnan(part))))
        keep.extend(sorted(found))
    return t[keep], values[keep]


def _runs(labels: NDArray[np.int64]) -> list[tuple[int, int]]:
    """(first, beyond) of each run of equal labels."""
    cuts = np.flatnonzero(np.diff(labels)) + 1
    begins, ends = [0, *cuts.tolist()], [*cuts.tolist(), len(labels)]
    return list(zip(begins, ends, strict=True))


def round_ticks(low: float, high: float, most: int) -> list[float]:
    """Multiples of 1, 2 or 5 times a power of ten within ``low`` to ``high``, at most ``most`` of them; one where they are equal."""
    span = high - low
    if span <= 0 or most < 2:
        return [low]
    rough = span / most
    power = 10.0 ** np.floor(np.log10(rough))
    step = next(power * k for k in (1, 2, 5, 10) if power * k >= rough * (1 - 1e-9))
    first = int(np.ceil(low / step - 1e-9))
    last = int(np.floor(high / step + 1e-9))
    return [float(k * step) for k in range(first, last + 1)]
