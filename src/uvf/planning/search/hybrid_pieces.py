"""The way that Hybrid-A* has found, as pieces of constant curvature: cut short, and sampled.

The search turns by whole heading bins, so that its ways sway a little; a curve from one place of the way to a later one that costs less
takes the place of what lies between. (Dolgov et al. 2010 smooth by gradients instead, which does not keep to the turning radius.)
"""

from math import ceil, inf

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.dubins_words import dubins_segments
from uvf.maths.curves.reeds_shepp_words import reeds_shepp_segments
from uvf.maths.curves.segments import MOST, Triple, moved
from uvf.planning.search.hybrid_expansion import Question, curve_cost
from uvf.planning.search.motion_primitives import SPACING
from uvf.planning.search.pose_check import PoseCheck

Floats = NDArray[np.float64]

X, Y, YAW, LENGTH, CURVATURE = 0, 1, 2, 3, 4
GAIN = 1e-3
"""Cells, by which a curve costs less at least."""


@compiled
def _place(pieces: Floats, i: int, end: Triple) -> Triple:
    """Where piece ``i`` begins; after the last one, the end."""
    return end if i == pieces.shape[0] else (pieces[i, X], pieces[i, Y], pieces[i, YAW])


@compiled
def _append(out: Floats, n: int, here: Triple, steps: Floats) -> int:
    """Adds the steps (k, 2) from ``here`` as pieces; how many there are then."""
    for k in range(steps.shape[0]):
        if steps[k, 0] != 0.0:
            out[n, X], out[n, Y], out[n, YAW] = here
            out[n, LENGTH], out[n, CURVATURE] = steps[k, 0], steps[k, 1]
            here = moved(here[0], here[1], here[2], steps[k, 1], steps[k, 0])
            n += 1
    return n


@compiled
def cut_short(check: PoseCheck, ask: Question, pieces: Floats, end: Triple) -> tuple[Floats, float]:
    """The pieces (m, 5) of a cheaper way over some of the same places, and how much less it costs [cells].

    pieces: (n, 5) x, y [cells], yaw, signed length [cells], curvature [1/cell]. From each place the farthest places are tried first.
    """
    n = pieces.shape[0]
    costs = np.zeros(n + 1)
    for i in range(n):
        costs[i + 1] = costs[i] + curve_cost(check, ask, _place(pieces, i, end), pieces[i : i + 1, LENGTH:])
    out, curve, m, i, saved = np.empty((n * MOST, 5)), np.zeros((MOST, 2)), 0, 0, 0.0
    while i < n:
        here, j = _place(pieces, i, end), n
        while j > i + 1:
            there, before = _place(pieces, j, end), costs[j] - costs[i] - GAIN
            length = (
                reeds_shepp_segments(here, there, ask.radius, curve) if ask.reverses else dubins_segments(here, there, ask.radius, curve)
            )
            cost = curve_cost(check, ask, here, curve) if length < before else inf
            if cost < before:
                saved += costs[j] - costs[i] - cost
                break
            j = i + (j - i) // 2
        m = _append(out, m, here, curve if j > i + 1 else pieces[i : i + 1, LENGTH:])
        i = max(j, i + 1)
    return out[:m].copy(), saved


@compiled
def sampled(pieces: Floats, start: Triple) -> Floats:
    """(n, 4) x, y [cells], yaw [rad] in (-pi, pi], direction of travel, at most ``SPACING`` cells apart; the start alone without pieces."""
    n = 1
    for i in range(pieces.shape[0]):
        n += ceil(abs(pieces[i, LENGTH]) / SPACING)
    out = np.empty((n, 4))
    out[0, 0], out[0, 1], out[0, 2], out[0, 3] = start[0], start[1], start[2], 1.0
    n = 1
    for i in range(pieces.shape[0]):
        parts, sign = ceil(abs(pieces[i, LENGTH]) / SPACING), (1.0 if pieces[i, LENGTH] > 0.0 else -1.0)
        for k in range(1, parts + 1):
            s = pieces[i, LENGTH] * k / parts
            out[n, 0], out[n, 1], out[n, 2] = moved(pieces[i, X], pieces[i, Y], pieces[i, YAW], pieces[i, CURVATURE], s)
            out[n, 3] = sign
            n += 1
        if i == 0:
            out[0, 3] = sign
    for k in range(n):
        out[k, 2] -= 2.0 * np.pi * np.ceil(out[k, 2] / (2.0 * np.pi) - 0.5)
    return out
