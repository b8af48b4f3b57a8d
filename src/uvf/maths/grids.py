"""Mathematics on regular grids: the exact Euclidean distance field."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

FAR = 1e6
"""Distance [cells] where there is nothing to be far from."""


@compiled
def _lower_envelope(f: NDArray[np.float64], n: int, out: NDArray[np.float64], v: NDArray[np.int64], z: NDArray[np.float64]) -> None:
    """One dimension: out[q] = min over p of (q - p)^2 + f[p] by the lower envelope of parabolas (algorithm DT(f))."""
    k = 0
    v[0] = 0
    z[0], z[1] = -np.inf, np.inf
    for q in range(1, n):
        s = ((f[q] + q * q) - (f[v[k]] + v[k] * v[k])) / (2.0 * q - 2.0 * v[k])
        while s <= z[k]:
            k -= 1
            s = ((f[q] + q * q) - (f[v[k]] + v[k] * v[k])) / (2.0 * q - 2.0 * v[k])
        k += 1
        v[k] = q
        z[k], z[k + 1] = s, np.inf
    k = 0
    for q in range(n):
        while z[k + 1] < q:
            k += 1
        out[q] = (q - v[k]) * (q - v[k]) + f[v[k]]


@compiled
def distance_field(occupied: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Distance (rows, columns) [cells] from each cell's centre to that of the nearest cell that ``occupied`` (rows, columns) has.

    Exact, in linear time: Felzenszwalb & Huttenlocher, "Distance Transforms of Sampled Functions" (2012), columns
    and then rows. ``FAR`` everywhere when nothing is occupied.
    """
    rows, columns = occupied.shape
    squares = np.empty((rows, columns))
    longest = max(rows, columns)
    line, out = np.empty(longest), np.empty(longest)
    v, z = np.empty(longest, dtype=np.int64), np.empty(longest + 1)
    for c in range(columns):
        for r in range(rows):
            line[r] = 0.0 if occupied[r, c] else FAR * FAR
        _lower_envelope(line, rows, out, v, z)
        for r in range(rows):
            squares[r, c] = out[r]
    for r in range(rows):
        for c in range(columns):
            line[c] = squares[r, c]
        _lower_envelope(line, columns, out, v, z)
        for c in range(columns):
            squares[r, c] = np.sqrt(min(out[c], FAR * FAR))
    return squares
