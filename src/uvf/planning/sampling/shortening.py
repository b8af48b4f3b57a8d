"""Cuts a path short: curves between random places on it take the place of what they are shorter than.

Geraerts & Overmars, "Creating high-quality paths for motion planning", IJRR 26 (2007), section 4.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import MOST, Triple, moved
from uvf.planning.sampling.clearance import is_free_way
from uvf.planning.sampling.path import SamplingPath
from uvf.planning.sampling.pieces import pieces_of
from uvf.planning.sampling.problem import Ground
from uvf.planning.sampling.spaces import SteeringSpace, connect, leaving

Floats = NDArray[np.float64]

GAIN = 1e-6  # m, by which a curve is shorter at least


def shortened(ground: Ground, space: SteeringSpace, path: SamplingPath, tries: int, seed: int) -> SamplingPath:
    """The path after so many ``tries`` to cut it short, never longer, as free as it was; the same for the same ``seed``.

    Raises ValueError for a negative number of tries.
    """
    if tries < 0:
        raise ValueError(f"{tries} tries; there is no fewer than 0")
    draws = np.random.default_rng(seed).random((tries, 2))
    buffer = np.empty((len(path.pieces) + tries * (MOST + 2), 5))
    buffer[: len(path.pieces)] = path.pieces
    count = _shorten(ground, space, buffer, (len(path.pieces), path.end), draws)
    return SamplingPath(buffer[:count].copy(), path.end)


@compiled
def _place(pieces: Floats, count: int, s: float) -> tuple[int, float, Triple]:
    """Piece at ``s`` [m] of the way, distance [m] on it, and the configuration there."""
    k = 0
    while k < count - 1 and s > abs(pieces[k, 3]):
        s -= abs(pieces[k, 3])
        k += 1
    s = min(s, abs(pieces[k, 3]))
    along = s if pieces[k, 3] >= 0.0 else -s
    return k, s, moved(pieces[k, 0], pieces[k, 1], pieces[k, 2], pieces[k, 4], along)


@compiled
def _splice(pieces: Floats, count: int, cuts: tuple[int, float, int, float, Triple], curve: Floats) -> int:
    """Puts the pieces of ``curve`` (k, 5) between two places: (piece, m on it) twice, and the second's configuration; pieces then."""
    first, before, last, beyond, at = cuts
    rest = pieces[last + 1 : count].copy()
    left = abs(pieces[last, 3]) - beyond
    sign, curvature = (1.0 if pieces[last, 3] >= 0.0 else -1.0), pieces[last, 4]
    pieces[first, 3] = before if pieces[first, 3] >= 0.0 else -before
    n = first + 1 if before > 0.0 else first
    for k in range(curve.shape[0]):
        if curve[k, 3] != 0.0:
            pieces[n] = curve[k]
            n += 1
    if left > 0.0:
        pieces[n] = (at[0], at[1], at[2], sign * left, curvature)
        n += 1
    pieces[n : n + rest.shape[0]] = rest
    return n + len(rest)


@compiled
def _shorten(ground: Ground, space: SteeringSpace, pieces: Floats, whole: tuple[int, Triple], draws: Floats) -> int:
    """Works on the first pieces of ``pieces`` in place, which has room for more; how many there are in the end."""
    count = whole[0]
    curve = np.zeros((MOST, 2))
    for i in range(draws.shape[0]):
        length = np.abs(pieces[:count, 3]).sum()
        low, high = min(draws[i, 0], draws[i, 1]) * length, max(draws[i, 0], draws[i, 1]) * length
        if count == 0:
            return 0
        first, before, a = _place(pieces, count, low)
        last, beyond, b = _place(pieces, count, high)
        if connect(space, a, b, curve) > high - low - GAIN:
            continue
        begin = leaving(space, a, b)
        if is_free_way(ground.field, ground.body, begin, curve, 1.0):
            count = _splice(pieces, count, (first, before, last, beyond, b), pieces_of(begin, curve))
    return count
